// SPDX-License-Identifier: GPL-3.0-or-later
#include "world_light.h"

#include "photon_maps_shader.h"
#include "scene.h"

namespace photon_maps {

namespace {

RayState ray_of(pm_ray kind) {
    RayState ray;
    ray.kinds = 1u << kind;
    ray.depth = 1;
    ray.length = infinity;
    if (kind == PM_RAY_DIFFUSE) ray.diffuse_depth = 1;
    if (kind == PM_RAY_GLOSSY) ray.glossy_depth = 1;
    if (kind == PM_RAY_TRANSMISSION) ray.transmission_depth = 1;
    return ray;
}

}  // namespace

WorldLight::WorldLight(const Scene &scene, const World &world) : scene_(scene), world_(world) {
    if (!world.material || !scene.materials[*world.material].emits()) return;
    const Material &material = scene.materials[*world.material];

    // What lights the scene: all rays but the camera's.
    std::vector<RayState> rays;
    for (const pm_ray kind : {PM_RAY_DIFFUSE, PM_RAY_GLOSSY, PM_RAY_TRANSMISSION})
        if (world.visibility & 1u << kind) rays.push_back(ray_of(kind));
    if (rays.empty()) return;
    if (!material.traits.depends_on_ray) rays.resize(1);

    const auto value = [&](Vec3 direction) {
        float largest = 0;
        for (const RayState &ray : rays) largest = std::max(largest, average(radiance(direction, ray)));
        return largest;
    };
    is_uniform_ = material.traits.is_constant;
    if (!is_uniform_) map_ = DirectionMap(value);
    mean_radiance_ = is_uniform_ ? value({0, 0, 1}) : map_.mean();
}

bool WorldLight::depends_on_ray() const {
    return world_.material && scene_.materials[*world_.material].traits.depends_on_ray;
}

Vec3 WorldLight::radiance(Vec3 direction, const RayState &ray) const {
    return world_.material ? shade_world(scene_, scene_.materials[*world_.material], direction, ray) : Vec3();
}

WorldLight::Direction WorldLight::sample(float u, float v) const {
    const Vec3 direction = map_.sample(u, v);
    return {direction, radiance(direction, ray_of(PM_RAY_DIFFUSE)), map_.pdf(direction)};
}

}  // namespace photon_maps
