// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: buffers that grow pass by pass, read as the mean of the passes. Depth and position stay those of the
// first pass: a mean of two surfaces would lie on neither.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nested_film.h"
#include "tiles.h"
#include "vec.h"

namespace photon_maps {

/// Buffers of a picture, numbered as pm_pass; the error is not kept but estimated (error_estimate.h).
enum class Buffer : uint32_t {
    combined,
    depth,
    normal,
    position,
    albedo,
    emission,
    direct,
    indirect,
    caustic,
    background,
    photon_density,
    specular,
    soft_indirect,
    error
};
constexpr size_t buffer_count = 14;
constexpr std::array<size_t, buffer_count> buffer_channels = {4, 1, 3, 3, 3, 3, 3, 3, 3, 3, 1, 3, 3, 1};

/// Depth where nothing is hit, as Blender has it.
constexpr float no_depth = 1e10f;

/// What the photons of one map bring to a pixel.
struct MapSample {
    Vec3 radiance;
    Vec3 blur;  ///< by how much that is more than with kernels of half the radius
};

/// What one camera path brings to its pixel.
struct PixelSample {
    Vec3 emission, background, direct, specular, soft_indirect, caustic;  ///< radiance
    float alpha = 1;
    float depth = no_depth;
    Vec3 normal, position, albedo;
    float photon_density = 0;       ///< 1/m2
    MapSample global, caustic_map;  ///< part of the radiance above; told by probes only

    Vec3 indirect() const { return specular + soft_indirect; }
    Vec3 radiance() const { return emission + background + direct + indirect() + caustic; }
};

class Film {
  public:
    /// @param wanted bit 1 << Buffer for each buffer to keep
    /// @param is_nested caustics come by nested radii as well: samples have them by one, reading gives the chosen ones
    Film(uint32_t width, uint32_t height, uint32_t wanted, bool is_nested = false);

    const Tiles &tiles() const { return tiles_; }
    bool has(Buffer buffer) const { return ((wanted_ >> static_cast<uint32_t>(buffer)) & 1) != 0; }
    /// Number of floats in a buffer.
    size_t size(Buffer buffer) const {
        return size_t{tiles_.width} * tiles_.height * buffer_channels[static_cast<size_t>(buffer)];
    }
    /// Sets a pixel (index from the bottom left, row by row) to one sample.
    void set(size_t pixel, const PixelSample &sample);
    /// Adds a pass: a film of the same size.
    /// @param left_out for each tile whether the pass has not rendered it; empty: it has rendered all
    void add(const Film &pass, const std::vector<bool> &left_out = {});
    uint32_t passes() const { return passes_; }
    /// Passes that a tile was rendered in.
    uint32_t passes_of(size_t tile) const { return tile_passes_[tile]; }
    const std::vector<uint32_t> &tile_passes() const { return tile_passes_; }
    /// Caustics by nested radii; null where they are not kept.
    NestedFilm *nested() { return nested_ ? &*nested_ : nullptr; }
    const NestedFilm *nested() const { return nested_ ? &*nested_ : nullptr; }
    /// Copies a buffer: the mean of the passes added; zero without any.
    void read(Buffer buffer, std::span<float> pixels) const;
    /// The sum of a pixel's radiance over its passes.
    Vec3 sum(size_t pixel) const;
    size_t memory_bytes() const;

  private:
    std::vector<float> &values(Buffer buffer) { return buffers_[static_cast<size_t>(buffer)]; }
    void set(Buffer buffer, size_t pixel, Vec3 value);

    Tiles tiles_;
    uint32_t wanted_;
    uint32_t passes_ = 0;
    std::vector<uint32_t> tile_passes_;
    std::array<std::vector<float>, buffer_count> buffers_;
    std::optional<NestedFilm> nested_;
};

}  // namespace photon_maps
