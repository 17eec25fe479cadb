// SPDX-License-Identifier: GPL-3.0-or-later
// The radii of the first pass, and how they shrink.
#pragma once

#include <atomic>
#include <cstdint>

#include "camera.h"
#include "photon_trace.h"

namespace photon_maps {

/// Photons of one pass that choose_indirect_radius() finds room for.
constexpr double usual_photons_in_kernel = 125;

/// Radius of pass `index` (counted from 0) after Knaus and Zwicker 2011, equation 21: r^2 shrinks by (i + 2/3) / (i +
/// 1) from the i-th pass to the next, so that noise and bias both vanish.
float shrunk_radius(float first_radius, uint32_t index);

/// Chooses the first radius of the global map so that the kernel of a typical pixel holds `usual_photons_in_kernel`
/// photons of one pass: by the density of pilot photons, which no picture sums - a radius from the photons themselves
/// would brighten it.
/// @return above 0 in a scene that has surfaces, even if no pilot photon fell anywhere
float choose_indirect_radius(const Scene &scene, const Emission &emission, const Camera &camera,
                             const PhotonTracing &pass, const std::atomic<bool> *cancel);

/// Chooses the first radius of the caustic map: some pixels wide where the caustic is sharp, and wider where its
/// photons are sparse, by pilot photons likewise.
/// @return 0 if no pilot photon came by glass or metal
float choose_caustic_radius(const Scene &scene, const Emission &emission, const Camera &camera,
                            const PhotonTracing &pass, const std::atomic<bool> *cancel);

}  // namespace photon_maps
