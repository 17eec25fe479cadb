// SPDX-License-Identifier: GPL-3.0-or-later
#include "first_diffuse_hit.h"

#include "ray_state.h"

namespace photon_maps {

bool first_diffuse_hit(const Scene &scene, const Ray &camera_ray, Sequence &sequence, SurfacePoint &hit,
                       float &distance) {
    constexpr int most_steps = 16;
    Ray ray = camera_ray;
    RayState state;
    state.kinds = ray.kinds = 1u << PM_RAY_CAMERA;
    distance = 0;
    for (int step = 0; step < most_steps; ++step) {
        if (!scene.intersect(ray, hit)) return false;
        distance += hit.distance * length(ray.direction);
        const Vec3 direction = normalize(ray.direction);
        const Shading shading = shade(scene, hit, -direction, state);
        if (lobes_of(shading) & diffuse_lobes) return true;
        const auto u = sequence.next();
        if (u[3] < average(shading.transparency)) {
            state = passed(state);
            ray = {hit.origin_towards(direction), direction, 0, infinity, ray.kinds};
            continue;
        }
        const auto drawn = sample(shading, glossy_lobes, {u[0], u[1], u[2]}, Transport::radiance);
        if (!drawn) return false;
        state = scattered(state, *drawn);
        ray = {hit.origin_towards(drawn->direction), drawn->direction};
        ray.kinds = visible_kind(drawn->lobe);
    }
    return false;
}

}  // namespace photon_maps
