// SPDX-License-Identifier: GPL-3.0-or-later
// The photons of one pass with what they came from, and the maps made of them: for those who look at them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "camera_pass.h"
#include "map_cache.h"

namespace photon_maps {

/// Immutable once made by Render::snapshot(), and independent of the render; scene and lights must outlive it.
struct PhotonSnapshot {
    static constexpr size_t kind_count = PM_PHOTONS_SHADOW + 1;

    std::vector<PhotonTracing> tracings;                  ///< what was traced, for the maps that there are
    std::array<std::vector<Photon>, kind_count> photons;  ///< by pm_photon_kind, in the order of their emission
    std::array<std::vector<PhotonOrigin>, kind_count> origins;
    std::array<ReceivedBySource, 2> received;  ///< by PhotonPurpose
    std::shared_ptr<const EdgeIndex> edges;
    std::shared_ptr<const Coverage> coverage;
    Maps maps;
    PhotonMaps gathers;  ///< of the maps

    /// Takes over what was traced but for the photons of the maps' kinds.
    void add(const PhotonTracing &tracing, TracedPhotons &traced);
};

/// What is found along a ray.
struct Probe {
    SurfacePoint hit;
    bool keeps_photons;  ///< the surface scatters light diffusely
    ProbedIrradiance global, caustic;
};

/// Estimates the irradiance at the first surface along a ray that hides most of what lies behind it.
/// @param ray with a unit direction; `kinds` says what it meets
std::optional<Probe> probe(const Scene &scene, const PhotonSnapshot &snapshot, Ray ray);

/// Traces some photons once more, each from its light to where it ends.
/// @param purpose of the map they were traced for; without one there are none
/// @param numbers of photons in their pass, each below its tracing's count
std::vector<PhotonSegment> trace_segments(const Scene &scene, const Emission &emission, const PhotonSnapshot &snapshot,
                                          PhotonPurpose purpose, std::span<const uint32_t> numbers);

}  // namespace photon_maps
