// SPDX-License-Identifier: GPL-3.0-or-later
// One lamp: radiance and direct sampling of each of Blender's types.
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

/// Power that emission shares photons by, mean of RGB, W.
float emitted_power(const Lamp &lamp, const SceneSphere &sphere);

/// The least squared distance that irradiance is divided by.
constexpr float least_floor = 1e-20f;

/// The irradiance that the lamp might bring to a surface: never zero where it shines.
LightReach reach_of(const Lamp &lamp);

/// Radius of a sphere about its centre that holds a lamp that is no sun.
float reach_about_center(const Lamp &lamp);

/// The lamp, if it has an extent, that lies in a unit direction from a point: its source is left to the caller.
std::optional<LampHit> meet_lamp(const Lamp &lamp, Vec3 origin, Vec3 direction);

bool is_area(const Lamp &lamp);
/// Of an area lamp.
float area(const Lamp &lamp);
/// Radiance of an area lamp at an angle to its normal: by the tangent, or between unit vectors.
Vec3 area_radiance(const Lamp &lamp, float tangent);
Vec3 area_radiance(const Lamp &lamp, Vec3 direction, Vec3 normal);
/// Radiant intensity of a point or spot lamp on its axis, W/sr.
Vec3 intensity(const Lamp &lamp);
/// 1 - cos of the cone about -z that holds all directions of a point or spot lamp.
float emission_cone(const Lamp &lamp);
/// Share of a point or spot lamp's intensity in a unit direction of travel.
float attenuation(const Lamp &lamp, Vec3 direction);
/// 1 - cos of half the sun's angle, and the radiance of its disk.
float sun_cone(const Lamp &lamp);
Vec3 sun_radiance(const Lamp &lamp);

}  // namespace photon_maps
