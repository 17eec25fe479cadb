// SPDX-License-Identifier: GPL-3.0-or-later
#include "light.h"

#include "lamp.h"
#include "sampling.h"

namespace photon_maps {

namespace {

constexpr float below_one = 0x1.fffffep-1f;

float area(const WorldTriangle &t) { return length(cross(t.b - t.a, t.c - t.a)) / 2; }

/// Whether one of an instance's materials emits, so that its triangles need be looked at.
bool emits_anywhere(const Scene &scene, const Instance &instance) {
    const auto first = scene.slot_materials.begin() + instance.first_slot;
    const auto count = static_cast<ptrdiff_t>(scene.meshes[instance.mesh].slot_count);
    return std::any_of(first, first + count, [&](uint32_t material) { return scene.materials[material].emits(); });
}

/// A point of a triangle, uniform by area.
Vec3 sample_triangle(const WorldTriangle &t, float u, float v) {
    const float root = std::sqrt(u);
    return t.a * (1 - root) + t.b * (root * (1 - v)) + t.c * (root * v);
}

/// Radiance that a side of a triangle emits at its middle.
Vec3 middle_emission(const Scene &scene, uint32_t instance, uint32_t triangle, Vec3 travel) {
    const SurfacePoint middle = scene.surface_point(instance, triangle, 1.0f / 3, 1.0f / 3, travel);
    return shade(scene, middle, middle.normal, {}).emission;
}

SceneSphere sphere_of(const Scene &scene) { return {scene.bounds().center(), scene.bounds().radius()}; }

}  // namespace

Lights::Lights(const Scene &scene, std::vector<Lamp> lamps, const World &world)
    : scene_(scene), lamps_(std::move(lamps)) {
    if (world.material) world_ = shade_world(scene, scene.materials[*world.material], {0, 0, 1}, {});
    find_emissive_triangles();
    const SceneSphere sphere = sphere_of(scene);
    for (const Lamp &lamp : lamps_) power_.push_back(emitted_power(lamp, sphere));
    power_.push_back(triangle_power_);
    power_.push_back(average(world_) * 4 * pi * pi * sphere.radius * sphere.radius);
    for (const float power : power_) total_power_ += power;
}

void Lights::find_emissive_triangles() {
    // Each side of a triangle emits pi * area * radiance.
    double power = 0;
    std::vector<double> cumulative;
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
        const Mesh &mesh = scene_.meshes[scene_.instances[i].mesh];
        if (!emits_anywhere(scene_, scene_.instances[i])) continue;
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const Material &material = scene_.material(i, t);
            if (!material.emits()) continue;
            const WorldTriangle corners = scene_.world_triangle(i, t);
            const float own_power = 2 * pi * area(corners) * average(middle_emission(scene_, i, t, {0, 0, 1}));
            if (own_power <= 0) continue;
            power += own_power;
            cumulative.push_back(power);
            triangles_.push_back({i, t, 0});
            triangle_bounds_.add(corners.a);
            triangle_bounds_.add(corners.b);
            triangle_bounds_.add(corners.c);
        }
    }
    for (size_t e = 0; e < triangles_.size(); ++e) triangles_[e].cumulative = cumulative[e] / power;
    triangle_power_ = static_cast<float>(power);
}

float Lights::importance(size_t source, Vec3 position) const {
    if (source < lamps_.size()) return possible_irradiance(lamps_[source], position);
    if (source == world_source()) return pi * average(world_);
    if (triangles_.empty()) return 0;
    const float radius = triangle_bounds_.radius();
    const float squared = length_squared(triangle_bounds_.center() - position);
    return triangle_power_ / (2 * pi * std::max(squared, radius * radius));
}

float Lights::total_importance(Vec3 position) const {
    float total = 0;
    for (size_t s = 0; s < source_count(); ++s) total += importance(s, position);
    return total;
}

std::optional<Lights::Choice> Lights::choose(Vec3 position, float u) const {
    const float total = total_importance(position);
    if (!(total > 0)) return {};
    Choice choice{0, 0, u * total};
    for (size_t s = 0; s < source_count(); ++s) {
        const float own = importance(s, position);
        if (own <= 0) continue;
        choice.source = s;
        choice.probability = own;
        if (choice.left < own) break;
        choice.left -= own;
    }
    choice.left = std::min(choice.left / choice.probability, below_one);
    choice.probability /= total;
    return choice;
}

std::optional<LightSample> Lights::sample(size_t source, Vec3 position, Vec3 shading_normal,
                                          const std::array<float, 3> &u) const {
    if (source == triangles_source()) return sample_triangles(position, u[2], u[0], u[1]);
    if (source != world_source()) return sample_lamp(lamps_[source], position, u[0], u[1]);
    // The world by the cosine about the normal: while it is uniform no other density has less noise.
    const Vec3 local = sample_cosine_hemisphere(u[0], u[1]);
    if (local.z <= 0) return {};
    const Vec3 direction = Frame(shading_normal).to_world(local);
    return LightSample{direction, std::numeric_limits<float>::infinity(), world_ * (pi / local.z), 0};
}

size_t Lights::choose_emitter(double choice) const {
    const auto found = std::upper_bound(triangles_.begin(), triangles_.end(), choice,
                                        [](double c, const Emitter &e) { return c < e.cumulative; });
    return std::min(static_cast<size_t>(found - triangles_.begin()), triangles_.size() - 1);
}

std::optional<LightSample> Lights::sample_triangles(Vec3 position, float choice, float u, float v) const {
    const Emitter &emitter = triangles_[choose_emitter(choice)];
    const WorldTriangle corners = scene_.world_triangle(emitter.instance, emitter.triangle);
    const Vec3 emission = middle_emission(scene_, emitter.instance, emitter.triangle, {0, 0, 1});
    const Vec3 to = sample_triangle(corners, u, v) - position;
    const float squared = length_squared(to);
    if (!(squared > 0)) return {};
    const float distance = std::sqrt(squared);
    const Vec3 direction = to / distance;
    const float cosine = std::abs(dot(direction, normalize(cross(corners.b - corners.a, corners.c - corners.a))));
    if (!(cosine > 0)) return {};
    // Chosen by power over area: density by area is radiance / total power, whatever the triangle.
    const float pdf = 2 * pi * average(emission) / triangle_power_ * squared / cosine;
    return LightSample{direction, distance * 0.9999f, emission / pdf, pdf};
}

float Lights::pdf(Vec3 position, const SurfacePoint &emitter) const {
    const Vec3 to = emitter.position - position;
    const float squared = length_squared(to);
    const float cosine = std::abs(dot(to, emitter.normal)) / std::sqrt(squared);
    return 2 * pi * average(middle_emission(scene_, emitter.instance, emitter.triangle, {0, 0, 1})) / triangle_power_ *
           squared / cosine;
}

std::optional<PhotonEmission> Lights::emit(Sequence &sequence) const {
    if (empty()) return {};
    const auto point = sequence.next();
    const auto choice = sequence.next();
    float left = choice[0] * total_power_;
    size_t chosen = 0;
    for (size_t s = 0; s < source_count(); ++s) {
        if (power_[s] <= 0) continue;
        chosen = s;
        if (left < power_[s]) break;
        left -= power_[s];
    }
    PhotonEmission photon;
    if (chosen == world_source()) {
        photon = emit_from_world(point);
    } else if (chosen == triangles_source()) {
        photon = emit_from_triangle(choice[2], choice[1], point);
    } else {
        photon = emit_from_lamp(lamps_[chosen], sphere_of(scene_), point);
    }
    photon.flux = photon.flux * (total_power_ / power_[chosen]);
    return photon;
}

PhotonEmission Lights::emit_from_triangle(float choice, float side, const std::array<float, 4> &u) const {
    const Emitter &emitter = triangles_[choose_emitter(choice)];
    const WorldTriangle corners = scene_.world_triangle(emitter.instance, emitter.triangle);
    const Vec3 face = normalize(cross(corners.b - corners.a, corners.c - corners.a));
    const Vec3 normal = side < 0.5f ? face : -face;
    const Vec3 direction = Frame(normal).to_world(sample_cosine_hemisphere(u[0], u[1]));
    const Vec3 origin =
        sample_triangle(corners, u[2], u[3]) + normal * scene_.position_error(emitter.instance, emitter.triangle);
    // Radiance over the density that choosing by power gives: the colour of the whole power.
    const Vec3 emission = middle_emission(scene_, emitter.instance, emitter.triangle, {0, 0, 1});
    return {{origin, direction}, emission * (triangle_power_ / average(emission)), {}};
}

PhotonEmission Lights::emit_from_world(const std::array<float, 4> &u) const {
    const SceneSphere sphere = sphere_of(scene_);
    const Vec3 direction = Frame({0, 0, 1}).to_world(sample_cone(u[0], u[1], 2));
    const Vec3 flux = world_ * (4 * pi * pi * sphere.radius * sphere.radius);
    return {ray_across(sphere, direction, u[2], u[3]), flux, {}};
}

std::optional<std::pair<Vec3, float>> Lights::seen(const Ray &ray, bool is_open) const {
    std::optional<std::pair<Vec3, float>> nearest;
    for (const Lamp &lamp : lamps_) {
        if (!(lamp.visibility & 1u << PM_RAY_CAMERA)) continue;
        const auto met = intersect_lamp(lamp, ray);
        if (!met) continue;
        const bool within = std::isinf(met->second) ? is_open : met->second > ray.near && met->second < ray.far;
        if (within && (!nearest || met->second < nearest->second)) nearest = met;
    }
    return nearest;
}

}  // namespace photon_maps
