// SPDX-License-Identifier: GPL-3.0-or-later
// How many photons a pass emits for each map, and how wide the global map's kernels are: by what pilot passes tell of
// noise, blur and cost, so that the picture comes to its error in the least time. A function of scene, camera and
// settings alone: costs are counted in rays, not measured by a clock.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace photon_maps {

/// Photons that a pass emits for each map.
struct PhotonCounts {
    uint64_t global = 0, caustic = 0;
};

/// What one sort of photons does to the pictures of passes that emit `count`.
struct MapNoise {
    double variance = 0;       ///< relative to squared radiance as ErrorEstimate has it
    double flux_variance = 0;  ///< the part of it that kernels of all widths have, as of how many photons come at all
    double blur = 0;           ///< relative square of the error by the kernel's width
    double count = 0;          ///< emitted in a pass
    double cost = 0;           ///< of tracing and storing one of them, in rays

    /// Relative standard deviation of a pass that emits so many, by kernels of the same width.
    double deviation(uint64_t emitted) const {
        return emitted > 0 ? std::sqrt(variance * count / static_cast<double>(emitted)) : 0;
    }
};

/// What pilot passes found.
struct PilotNoise {
    static constexpr uint32_t passes = 4;           ///< that pilots have
    static constexpr double most_stratified = 1.4;  ///< by more passes than pilots have, as measured

    double camera_variance = 0;  ///< of all that photons do not carry
    double direct_variance = 0;  ///< part of it that more light samples take away
    double path_variance = 0;    ///< part of it by diffuse bounces of cameras' paths
    /// Power by which the variance of the mean of passes falls with their number, of what the eye sees without those.
    double stratification = most_stratified;
    MapNoise global, caustic;
    double lack = 0;         ///< relative square of the light that is missing in all pilot passes
    double pixel_cost = 0;   ///< of the cameras' paths and their estimates of a whole pass, in rays
    double light_cost = 0;   ///< of so many more light samples in a whole pass, in rays
    double gather_cost = 0;  ///< of the photons in the kernels of a whole pass, in rays

    /// The same for passes with so many light samples in the place of one.
    PilotNoise with_light_samples(uint32_t count) const;
};

struct Plan {
    PhotonCounts counts;
    uint32_t light_samples = 1;
    float global_radius = 1;                                ///< over that of the pilot passes
    double passes = 0;                                      ///< until the picture has its error
    double cost = std::numeric_limits<double>::infinity();  ///< in rays, until the picture has its error
};

/// Chooses what comes to an error in the least time. The variance of a map falls with its photons and, but for that of
/// flux, with the square of the radius; its blur grows with the radius.
/// @param error > 0, relative
/// @param shrinks whether radii shrink from pass to pass (shrunk_radius)
Plan plan_for(const PilotNoise &noise, double error, bool shrinks);

}  // namespace photon_maps
