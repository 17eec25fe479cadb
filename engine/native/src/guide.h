// SPDX-License-Identifier: GPL-3.0-or-later
// Importance from photons: directions to where light came from (Jensen 1995, "Importance driven path tracing using the
// photon map").
#pragma once

#include <array>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "closure.h"
#include "photon.h"
#include "scene.h"

namespace photon_maps {

/// Flux by where it came from, over the cells of the unit square that a cosine-weighted hemisphere is drawn from.
struct IncomingFlux {
    static constexpr size_t width = 8, cell_count = width * width;

    Vec3 normal;  ///< the hemisphere's
    std::array<float, cell_count> flux{};
    float total = 0;
    uint32_t photons = 0;
};

/// What photons tell of the light that arrives after scattering, in cubes of space and by the surface's normal.
class PhotonImportance {
  public:
    /// @param cube_size > 0
    explicit PhotonImportance(float cube_size) : cube_size_(cube_size) {}
    void add(std::span<const Photon> photons);

    /// Returns the flux around a point, by chance of one cube or its neighbour; null where few photons lie.
    /// @param u, v uniform in [0, 1)
    const IncomingFlux *around(const SurfacePoint &point, float u, float v) const;

    size_t memory_bytes() const;

  private:
    float cube_size_;
    std::unordered_map<uint64_t, uint32_t> index_;  ///< of a place, into the list; only looked up
    std::vector<IncomingFlux> places_;
};

/// A density over directions: that of the flux times the closures. Nothing is certain of few photons, so that each cell
/// has a share of them from the start.
class Guide {
  public:
    Guide(const IncomingFlux &incoming, const Shading &shading);

    /// @param u, v uniform in [0, 1)
    Vec3 sample(float u, float v) const;
    /// Density by solid angle; 0 for directions below the surface.
    float pdf(Vec3 direction) const;

  private:
    Frame frame_;
    std::array<float, IncomingFlux::cell_count> weights_;
    float total_ = 0;
};

/// Draws a direction from the diffuse lobes as sample() does, or from a guide, by even chances. Weight and density are
/// those of both together (Veach 1997, section 9.2.4: one sample, balance heuristic).
std::optional<ScatterSample> sample_guided(const Guide &guide, const Shading &shading, const std::array<float, 3> &u);

/// Returns the density by solid angle with which sample_guided() draws a direction.
float pdf_guided(const Guide &guide, const Shading &shading, Vec3 direction);

}  // namespace photon_maps
