// SPDX-License-Identifier: GPL-3.0-or-later
#include "light.h"

#include "lamp.h"
#include "sampling.h"

namespace photon_maps {

namespace {

constexpr float below_one = 0x1.fffffep-1f;

/// Rays that light is carried by, once it has left the light.
constexpr uint32_t lit_kinds = 1u << PM_RAY_DIFFUSE | 1u << PM_RAY_GLOSSY | 1u << PM_RAY_TRANSMISSION;

/// Share of the directions to a world that is not uniform that is chosen by the cosine about the normal, not by the
/// world's map: the map does not know which half of the world a surface faces.
constexpr float cosine_share = 0.5f;

SceneSphere sphere_of(const Scene &scene) { return {scene.bounds().center(), scene.bounds().radius()}; }

}  // namespace

Lights::Lights(const Scene &scene, std::vector<Lamp> lamps, const World &world)
    : lamps_(std::move(lamps)), triangles_(scene), world_(scene, world) {
    const SceneSphere sphere = sphere_of(scene);
    for (const Lamp &lamp : lamps_) power_.push_back(lamp.visibility & lit_kinds ? emitted_power(lamp, sphere) : 0.0f);
    power_.push_back(triangles_.power());
    power_.push_back(world_.mean_radiance() * 4 * pi * pi * sphere.radius * sphere.radius);
    for (const float power : power_) total_power_ += power;
}

float Lights::importance(size_t source, Vec3 position) const {
    if (!shines(source)) return 0;
    if (source < lamps_.size()) return possible_irradiance(lamps_[source], position);
    if (source == world_source()) return pi * world_.mean_radiance();
    const float radius = triangles_.bounds().radius();
    const float squared = length_squared(triangles_.bounds().center() - position);
    return triangles_.power() / (2 * pi * std::max(squared, radius * radius));
}

Lights::Importances Lights::importances(Vec3 position) const {
    float total = 0, count = 0;
    for (size_t s = 0; s < source_count(); ++s) {
        const float own = importance(s, position);
        total += own;
        count += own > 0 ? 1.0f : 0.0f;
    }
    const float each = count > 0 ? even_share / (1 - even_share) * total / count : 0;
    return {each, total / (1 - even_share)};
}

std::optional<Lights::Choice> Lights::choose(Vec3 position, float u) const {
    const auto [each, total] = importances(position);
    if (!(total > 0)) return {};
    Choice choice{0, 0, u * total};
    for (size_t s = 0; s < source_count(); ++s) {
        const float own = importance(s, position);
        if (own <= 0) continue;
        choice.source = s;
        choice.probability = own + each;
        if (choice.left < own + each) break;
        choice.left -= own + each;
    }
    choice.left = std::min(choice.left / choice.probability, below_one);
    choice.probability /= total;
    return choice;
}

float Lights::choice_probability(size_t source, Vec3 position) const {
    const float own = importance(source, position);
    if (own <= 0) return 0;
    const auto [each, total] = importances(position);
    return (own + each) / total;
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
