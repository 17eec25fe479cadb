// SPDX-License-Identifier: GPL-3.0-or-later
// The world as a light: its radiance by direction, and directions chosen by it.
#pragma once

#include <optional>

#include "direction_map.h"
#include "program.h"

namespace photon_maps {

/// What surrounds the scene.
struct World {
    std::optional<uint32_t> material;  ///< whose emission it is; none: black
    uint32_t visibility = ~0u;         ///< bits 1 << pm_ray
};

/// Directions to a world that is not uniform are chosen by a map of its radiance; what arrives from them is always the
/// shader's own value.
class WorldLight {
  public:
    /// The scene must outlive it.
    WorldLight(const Scene &scene, const World &world);

    /// Whether it lights anything: a world for the camera alone does not.
    bool shines() const { return mean_radiance_ > 0; }
    bool is_uniform() const { return is_uniform_; }
    uint32_t visibility() const { return world_.visibility; }
    /// Whether rays of different kinds, but for the camera's, find different radiances.
    bool depends_on_ray() const;
    /// Over all directions and RGB, W/(m2 sr); about right unless the world is uniform.
    float mean_radiance() const { return mean_radiance_; }

    /// Radiance that arrives along a ray that leaves the scene, whether or not the world is visible to it.
    Vec3 radiance(Vec3 direction, const RayState &ray) const;

    /// A direction to the world, as a diffuse ray would find it.
    struct Direction {
        Vec3 direction;  ///< unit, away from the scene
        Vec3 radiance;   ///< not divided by the density
        float pdf;       ///< by solid angle, never 0
    };
    Direction sample(float u, float v) const;
    /// Only the direction of sample().
    Vec3 sample_direction(float u, float v) const { return map_.sample(u, v); }
    /// Density by solid angle with which sample() chooses a direction.
    float pdf(Vec3 direction) const { return map_.pdf(direction); }

  private:
    const Scene &scene_;
    World world_;
    bool is_uniform_ = true;
    float mean_radiance_ = 0;
    DirectionMap map_;  // of the largest radiance that any but camera rays find; empty where the world is uniform
};

}  // namespace photon_maps
