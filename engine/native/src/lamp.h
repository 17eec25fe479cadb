// SPDX-License-Identifier: GPL-3.0-or-later
// One lamp: radiance, direct sampling and photon emission of each of Blender's types.
#pragma once

#include "light.h"

namespace photon_maps {

/// The sphere about the scene from whose cross-section far lights emit.
struct SceneSphere {
    Vec3 center;
    float radius;
};

/// Chooses a direction from `position` to the lamp.
/// @return nothing where the lamp does not shine on the position
std::optional<LightSample> sample_lamp(const Lamp &lamp, Vec3 position, float u, float v);

/// Emits a photon; its flux is that of the whole lamp.
PhotonEmission emit_from_lamp(const Lamp &lamp, const SceneSphere &sphere, const std::array<float, 4> &u);

/// Power that emission shares photons by, mean of RGB, W.
float emitted_power(const Lamp &lamp, const SceneSphere &sphere);

/// The irradiance that the lamp might bring to a surface at `position`, W/m2: never zero where it shines.
float possible_irradiance(const Lamp &lamp, Vec3 position);

/// Where a ray meets the lamp, and the radiance towards its origin.
std::optional<std::pair<Vec3, float>> intersect_lamp(const Lamp &lamp, const Ray &ray);

/// A parallel beam of photons towards the scene: origin on the disk across the sphere.
Ray ray_across(const SceneSphere &sphere, Vec3 direction, float u, float v);

}  // namespace photon_maps
