// SPDX-License-Identifier: GPL-3.0-or-later
#include "emissive_triangles.h"

#include "sampling.h"
#include "sequence.h"

namespace photon_maps {

namespace {

/// Points at which each side of a triangle of varying emission is looked at; fewer where there are many triangles.
constexpr size_t most_points = 64, all_points = 100000;

/// Radiance that every triangle of varying emission counts for at least, as a share of the mean over all: the points
/// looked at may have missed what shines.
constexpr double least_power_share = 0.02;

/// Whether one of an instance's materials emits, so that its triangles need be looked at.
bool emits_anywhere(const Scene &scene, const Instance &instance) {
    const auto first = scene.slot_materials.begin() + instance.first_slot;
    const auto count = static_cast<ptrdiff_t>(scene.meshes[instance.mesh].slot_count);
    return std::any_of(first, first + count, [&](uint32_t material) { return scene.materials[material].emits(); });
}

/// Barycentric weights of the second and third corner, uniform by area.
std::array<float, 2> sample_barycentric(float u, float v) {
    const float root = std::sqrt(u);
    return {root * (1 - v), root * v};
}

/// Mean of RGB of the radiance of both sides of a triangle, by area and the cosine.
double mean_emission(const Scene &scene, uint32_t instance, uint32_t triangle, Vec3 face, size_t points) {
    RayState ray;
    ray.kinds = 1u << PM_RAY_DIFFUSE;
    ray.depth = ray.diffuse_depth = 1;
    double sum = 0;
    for (size_t k = 0; k < points; ++k) {
        const auto u = sobol4(k, hash(instance, triangle));
        const auto [b, c] = sample_barycentric(u[0], u[1]);
        for (const Vec3 side : {face, -face}) {
            const Vec3 outgoing = Frame(side).to_world(sample_cosine_hemisphere(u[2], u[3]));
            const SurfacePoint point = scene.surface_point(instance, triangle, b, c, -outgoing);
            sum += static_cast<double>(std::max(0.0f, average(shade(scene, point, outgoing, ray).emission)));
        }
    }
    return sum / static_cast<double>(2 * points);
}

}  // namespace

EmissiveTriangles::EmissiveTriangles(const Scene &scene) : scene_(scene) {
    find_instances();
    find_powers();
}

void EmissiveTriangles::find_instances() {
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
        const bool emits = emits_anywhere(scene_, scene_.instances[i]);
        first_.push_back(emits ? size() : none);
        if (!emits) continue;
        instances_.push_back(i);
        instance_first_.push_back(size());
        cumulative_.resize(size() + scene_.meshes[scene_.instances[i].mesh].triangles.size());
    }
}

void EmissiveTriangles::find_powers() {
    // Look at each triangle: a side emits pi * area * radiance.
    const size_t points = std::clamp(all_points / std::max(size(), size_t{1}), size_t{1}, most_points);
    std::vector<std::optional<double>> constants(scene_.materials.size());
    double power = 0, emitting_area = 0;
    for (size_t e = 0; e < size(); ++e) {
        const auto [i, t, unknown] = (*this)[e];
        const Material &material = scene_.material(i, t);
        const WorldTriangle corners = scene_.world_triangle(i, t);
        const auto own_area = static_cast<double>(area(corners));
        if (!material.emits() || !(own_area > 0)) continue;

        const Vec3 face = normalize(cross(corners.b - corners.a, corners.c - corners.a));
        std::optional<double> &constant = constants[static_cast<size_t>(&material - scene_.materials.data())];
        if (material.traits.is_constant && !constant) constant = mean_emission(scene_, i, t, face, 1);
        const double mean = constant ? *constant : mean_emission(scene_, i, t, face, points);
        cumulative_[e] = 2 * std::numbers::pi * own_area * mean;
        power += cumulative_[e];
        emitting_area += own_area;
        bounds_.add(corners.a);
        bounds_.add(corners.b);
        bounds_.add(corners.c);
    }
    power_ = static_cast<float>(power);

    // Share the choice among them.
    double sum = 0;
    for (size_t e = 0; e < size(); ++e) {
        const auto [i, t, unknown] = (*this)[e];
        const Material &material = scene_.material(i, t);
        if (power > 0 && material.emits() && !material.traits.is_constant) {
            const auto own_area = static_cast<double>(area(scene_.world_triangle(i, t)));
            cumulative_[e] = std::max(cumulative_[e], least_power_share * power * own_area / emitting_area);
        }
        cumulative_[e] = sum += cumulative_[e];
    }
    if (sum > 0)
        for (double &c : cumulative_) c /= sum;
}

EmissiveTriangles::Emitter EmissiveTriangles::operator[](size_t index) const {
    const auto after = std::upper_bound(instance_first_.begin(), instance_first_.end(), index);
    const auto i = static_cast<size_t>(after - instance_first_.begin()) - 1;
    const auto triangle = static_cast<uint32_t>(index - instance_first_[i]);
    return {instances_[i], triangle, probability(instances_[i], triangle)};
}

EmissiveTriangles::Emitter EmissiveTriangles::choose(float u) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), static_cast<double>(u));
    return (*this)[static_cast<size_t>(found - cumulative_.begin())];
}

float EmissiveTriangles::probability(uint32_t instance, uint32_t triangle) const {
    if (!shines() || first_[instance] == none) return 0;
    const size_t e = first_[instance] + triangle;
    return static_cast<float>(cumulative_[e] - (e == 0 ? 0 : cumulative_[e - 1]));
}

SurfacePoint EmissiveTriangles::point(const Emitter &emitter, float u, float v, Vec3 travel) const {
    const auto [b, c] = sample_barycentric(u, v);
    return scene_.surface_point(emitter.instance, emitter.triangle, b, c, travel);
}

std::optional<LightSample> EmissiveTriangles::sample(Vec3 position, const RayState &receiver,
                                                     const std::array<float, 3> &u) const {
    const Emitter choice = choose(u[2]);
    const WorldTriangle corners = scene_.world_triangle(choice.instance, choice.triangle);
    const SurfacePoint emitter = point(choice, u[0], u[1], corners.a - position);  // coplanar: the side is known
    const Vec3 to = emitter.position - position;
    const float density = pdf(position, emitter);
    if (!(density > 0) || !std::isfinite(density)) return {};
    RayState ray = receiver;
    ray.length = length(to);
    const Vec3 direction = to / ray.length;
    const Vec3 emission = shade(scene_, emitter, -direction, ray).emission;
    return LightSample{direction, ray.length * shadow_end, emission / density, density,
                       scene_.instances[choice.instance].visibility};
}

float EmissiveTriangles::pdf(Vec3 position, const SurfacePoint &emitter) const {
    const float chosen = probability(emitter.instance, emitter.triangle);
    if (!(chosen > 0)) return 0;
    const Vec3 to = emitter.position - position;
    const float squared = length_squared(to);
    const float cosine = std::abs(dot(to, emitter.normal)) / std::sqrt(squared);
    return chosen / area(scene_.world_triangle(emitter.instance, emitter.triangle)) * squared / cosine;
}

}  // namespace photon_maps
