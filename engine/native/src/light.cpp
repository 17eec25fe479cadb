// SPDX-License-Identifier: GPL-3.0-or-later
#include "light.h"

#include <numeric>

#include "lamp.h"
#include "sampling.h"

namespace photon_maps {

namespace {

/// Rays that light is carried by, once it has left the light.
constexpr uint32_t lit_kinds = 1u << PM_RAY_DIFFUSE | 1u << PM_RAY_GLOSSY | 1u << PM_RAY_TRANSMISSION;

/// Share of the directions to a world that is not uniform that is chosen by the cosine about the normal, not by the
/// world's map: the map does not know which half of the world a surface faces.
constexpr float cosine_share = 0.5f;

SceneSphere sphere_of(const Scene &scene) { return {scene.bounds().center(), scene.bounds().radius()}; }

std::vector<float> powers_of(std::span<const Lamp> lamps, const EmissiveTriangles &triangles, const WorldLight &world,
                             const SceneSphere &sphere) {
    std::vector<float> powers;
    for (const Lamp &lamp : lamps) powers.push_back(lamp.visibility & lit_kinds ? emitted_power(lamp, sphere) : 0.0f);
    powers.push_back(triangles.power());
    powers.push_back(world.mean_radiance() * 4 * pi * pi * sphere.radius * sphere.radius);
    return powers;
}

bool can_be_met(const Lamp &lamp) { return lamp.visibility != 0 && lamp.width > 0 && max_component(lamp.power) > 0; }

std::vector<uint32_t> wide_suns(std::span<const Lamp> lamps) {
    std::vector<uint32_t> suns;
    for (uint32_t i = 0; i < lamps.size(); ++i)
        if (lamps[i].type == LightType::sun && can_be_met(lamps[i])) suns.push_back(i);
    return suns;
}

std::vector<LampSphere> spheres_about(std::span<const Lamp> lamps) {
    std::vector<LampSphere> spheres;
    for (uint32_t i = 0; i < lamps.size(); ++i)
        if (lamps[i].type != LightType::sun && can_be_met(lamps[i]))
            spheres.push_back({i, lamps[i].transform.origin, reach_about_center(lamps[i])});
    return spheres;
}

}  // namespace

Lights::Lights(const Scene &scene, std::vector<Lamp> lamps, const World &world)
    : lamps_(std::move(lamps)),
      triangles_(scene),
      world_(scene, world),
      power_(powers_of(lamps_, triangles_, world_, sphere_of(scene))),
      total_power_(std::accumulate(power_.begin(), power_.end(), 0.0f)),
      choice_(reaches()),
      far_lamps_(wide_suns(lamps_)),
      spheres_(spheres_about(lamps_)) {}

std::vector<LightReach> Lights::reaches() const {
    std::vector<LightReach> reaches(source_count());
    for (size_t lamp = 0; lamp < lamps_.size(); ++lamp)
        if (shines(lamp)) reaches[lamp] = reach_of(lamps_[lamp]);
    const Bounds &bounds = triangles_.bounds();
    const float least = std::max(bounds.radius() * bounds.radius(), least_floor);
    if (shines(triangles_source()))
        reaches[triangles_source()] = {bounds.center(), triangles_.power() / (2 * pi), least, 0};
    if (shines(world_source())) reaches[world_source()].constant = pi * world_.mean_radiance();
    return reaches;
}

std::optional<LightSample> Lights::sample(size_t source, Vec3 position, Vec3 normal, bool both_sides,
                                          const RayState &receiver, const std::array<float, 3> &u) const {
    if (source == triangles_source()) return triangles_.sample(position, receiver, u);
    if (source == world_source()) return sample_world(normal, both_sides, receiver, u);
    return sample_lamp(lamps_[source], position, u[0], u[1]);
}

std::optional<LightSample> Lights::sample_world(Vec3 normal, bool both_sides, const RayState &receiver,
                                                const std::array<float, 3> &u) const {
    Vec3 direction;
    const float share = world_.is_uniform() ? 1 : cosine_share;
    if (u[2] < share) {
        const float side = both_sides && u[2] >= share / 2 ? -1.0f : 1.0f;
        direction = Frame(normal * side).to_world(sample_cosine_hemisphere(u[0], u[1]));
    } else {
        direction = world_.sample_direction(u[0], u[1]);
    }
    const float pdf = world_pdf(direction, normal, both_sides);
    if (!(pdf > 0)) return {};
    RayState ray = receiver;
    ray.length = infinity;
    return LightSample{direction, ray.length, world_.radiance(direction, ray) / pdf, pdf, world_.visibility()};
}

Vec3 Lights::world_radiance(Vec3 direction, const RayState &ray) const {
    return world_.visibility() & ray.kinds ? world_.radiance(direction, ray) : Vec3();
}

float Lights::world_pdf(Vec3 direction, Vec3 normal, bool both_sides) const {
    const float cosine = dot(direction, normal);
    const float about_normal = both_sides ? std::abs(cosine) / (2 * pi) : std::max(0.0f, cosine) / pi;
    if (world_.is_uniform()) return about_normal;
    return cosine_share * about_normal + (1 - cosine_share) * world_.pdf(direction);
}

std::optional<LampHit> Lights::meet(size_t source, const Ray &ray, bool is_open) const {
    const Lamp &lamp = lamps_[source];
    if (!(lamp.visibility & ray.kinds) || !(max_component(lamp.power) > 0)) return {};
    const float scale = length(ray.direction);
    std::optional<LampHit> hit = meet_lamp(lamp, ray.origin, ray.direction / scale);
    if (!hit) return {};
    hit->source = source;
    hit->distance /= scale;
    const bool within = std::isinf(hit->distance) ? is_open : hit->distance > ray.near && hit->distance < ray.far;
    if (!within) return {};
    return hit;
}

}  // namespace photon_maps
