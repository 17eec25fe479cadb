// SPDX-License-Identifier: GPL-3.0-or-later
#include "emission.h"

#include <numeric>

#include "aim.h"
#include "sampling.h"

namespace photon_maps {

namespace {

/// How a light is looked at: by diffuse surfaces.
RayState diffuse_ray() {
    RayState ray;
    ray.kinds = 1u << PM_RAY_DIFFUSE;
    ray.depth = ray.diffuse_depth = 1;
    return ray;
}

/// What every source that shines weighs besides its power: a share of that of all lights.
double even_weight(const Lights &lights) {
    double total = 0, count = 0;
    for (size_t s = 0; s < lights.source_count(); ++s) {
        total += double{lights.power(s)};
        count += lights.shines(s) ? 1 : 0;
    }
    return count > 0 ? double{even_share} / (1 - double{even_share}) * total / count : 0;
}

/// What the photons of one point of an emissive triangle are aimed at; both its sides shine.
DirectionAim aim_from_triangle(Vec3 origin, Vec3 normal, std::span<const Caster> casters) {
    DirectionAim aim(0.5f);
    for (const Caster &caster : casters) {
        const std::optional<Cone> cone = cone_towards(origin, caster.center, caster.radius);
        float share = 1;
        if (cone) {
            const float cosine = std::max(cone->nearest_cosine(normal), cone->nearest_cosine(-normal));
            share = std::min(1.0f, cone->solid_angle() * cosine / (2 * pi));
        }
        aim.add(cone, caster.strength * share);
    }
    return aim;
}

}  // namespace

size_t Choices::choose(double u) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u * total());
    size_t chosen = std::min(static_cast<size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
    while (chosen > 0 && !(weight(chosen) > 0)) --chosen;  // rounding up to the end, where the last may weigh nothing
    return chosen;
}

Emission::Emission(const Scene &scene, const Lights &lights)
    : scene_(scene),
      lights_(lights),
      sphere_{scene.bounds().center(), scene.bounds().radius()},
      casters_(find_casters(scene)) {
    const double even = even_weight(lights);
    const auto weight = [&](size_t source) { return lights.shines(source) ? double{lights.power(source)} + even : 0; };
    for (size_t lamp = 0; lamp < lights.lamps().size(); ++lamp) by_power_.add(weight(lamp));
    const EmissiveTriangles &triangles = lights.emissive_triangles();
    for (size_t e = 0; e < triangles.size(); ++e)
        by_power_.add(double{triangles[e].probability} * weight(lights.triangles_source()));
    by_power_.add(weight(lights.world_source()));

    if (empty()) return;

    // For caustics by the flux that casters can make use of, and a little by power.
    std::vector<double> useful;
    for (size_t s = 0; s < by_power_.size(); ++s)
        useful.push_back(by_power_.weight(s) > 0 ? by_power_.weight(s) * double{wanted_share(s)} : 0);
    const double total_useful = std::accumulate(useful.begin(), useful.end(), 0.0);
    const double by_power = total_useful > 0 ? double{unaimed_share} : 1;
    for (size_t s = 0; s < by_power_.size(); ++s) {
        const double by_use = total_useful > 0 ? useful[s] / total_useful : 0;
        by_use_.add(by_power * by_power_.probability(s) + (1 - by_power) * by_use);
    }
}

float Emission::wanted_share(size_t source) const {
    const std::span<const Lamp> lamps = lights_.lamps();
    if (source < lamps.size()) return photon_maps::wanted_share(lamps[source], sphere_, casters_);
    if (source == world_source()) return DiskAim(sphere_.center, sphere_.radius, casters_).total();
    const EmissiveTriangles::Emitter emitter = lights_.emissive_triangles()[source - lamps.size()];
    const WorldTriangle t = scene_.world_triangle(emitter.instance, emitter.triangle);
    const Vec3 normal = cross(t.b - t.a, t.c - t.a);
    if (!(length_squared(normal) > 0)) return 0;
    return aim_from_triangle((t.a + t.b + t.c) / 3, normalize(normal), casters_).total();
}

std::optional<PhotonEmission> Emission::emit(const Choices &choices, std::span<const Caster> casters,
                                             Sequence &sequence) const {
    if (empty()) return {};
    const auto ray = sequence.next();
    const auto choice = sequence.next();
    const EmissionNumbers u{ray, choice[1], choice[3]};
    // One float does not tell millions of triangles apart.
    const size_t source = choices.choose(double{choice[0]} + double{choice[2]} * 0x1p-24);
    const size_t lamp_count = lights_.lamps().size();
    PhotonEmission photon;
    if (source < lamp_count) {
        photon = emit_from_lamp(lights_.lamps()[source], sphere_, casters, u);
        photon.source = source;
        photon.label = static_cast<uint32_t>(source);
    } else if (source == world_source()) {
        photon = emit_from_world(casters, u);
        photon.source = lights_.world_source();
        photon.label = PM_SOURCE_WORLD;
    } else {
        const EmissiveTriangles::Emitter emitter = lights_.emissive_triangles()[source - lamp_count];
        photon = emit_from_triangle(emitter, casters, u);
        photon.source = lights_.triangles_source();
        photon.label = PM_SOURCE_INSTANCE | emitter.instance;
    }
    photon.flux = photon.flux / static_cast<float>(choices.probability(source));
    return photon;
}

PhotonEmission Emission::emit_from_triangle(const EmissiveTriangles::Emitter &emitter, std::span<const Caster> casters,
                                            const EmissionNumbers &u) const {
    const WorldTriangle t = scene_.world_triangle(emitter.instance, emitter.triangle);
    const Vec3 across = cross(t.b - t.a, t.c - t.a);
    const float twice_area = length(across);
    const Vec3 face = across / twice_area;

    // A point, uniform by area; its barycentric coordinates.
    const float root = std::sqrt(u.ray[2]);
    const float b = root * (1 - u.ray[3]), c = root * u.ray[3];
    const Vec3 point = t.a + (t.b - t.a) * b + (t.c - t.a) * c;

    // A direction to either side.
    DirectionAim aim = aim_from_triangle(point, face, casters);
    std::optional<Vec3> direction = aim.sample(u.target, u.ray[0], u.ray[1]);
    if (!direction)
        direction = Frame(u.side < 0.5f ? face : -face).to_world(sample_cosine_hemisphere(u.ray[0], u.ray[1]));
    const float cosine = dot(*direction, face);
    const float pdf = aim.pdf(*direction, std::abs(cosine) / (2 * pi)) * 2 / twice_area;

    // What the point emits there.
    PhotonEmission photon;
    photon.visibility = scene_.instances[emitter.instance].visibility;
    const Vec3 nudge = face * std::copysign(scene_.position_error(emitter.instance, emitter.triangle), cosine);
    photon.ray = {point + nudge, *direction};
    if (!(pdf > 0)) return photon;
    const SurfacePoint seen = scene_.surface_point(emitter.instance, emitter.triangle, b, c, -*direction);
    photon.flux = shade(scene_, seen, *direction, diffuse_ray()).emission * (std::abs(cosine) / pdf);
    return photon;
}

PhotonEmission Emission::emit_from_world(std::span<const Caster> casters, const EmissionNumbers &u) const {
    const WorldLight::Direction from = lights_.world_light().sample(u.ray[0], u.ray[1]);
    const Vec3 direction = -from.direction;
    const DiskAim::Line line =
        DiskAim(sphere_.center, sphere_.radius, casters).sample(direction, u.target, u.ray[2], u.ray[3]);
    PhotonEmission photon;
    photon.ray = {line.origin, direction};
    photon.flux = from.radiance / (from.pdf * line.pdf);
    photon.visibility = lights_.world_visibility();
    return photon;
}

}  // namespace photon_maps
