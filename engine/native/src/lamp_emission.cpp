// SPDX-License-Identifier: GPL-3.0-or-later
#include "lamp_emission.h"

#include "aim.h"
#include "sampling.h"

namespace photon_maps {

namespace {

/// 1 - cos of the widest cone worth aiming at, for light that fills a cone: in half of it the light's own density will
/// do.
float widest_aim(float emission_cone) { return std::min(emission_cone, 2.0f) / 2; }

/// What all photons of a point or spot lamp are aimed at, by its centre: they may leave anywhere on its sphere.
DirectionAim aim_from_point(const Lamp &lamp, std::span<const Caster> casters) {
    const float width = emission_cone(lamp);
    const Vec3 axis = -normalize(lamp.transform.z);
    DirectionAim aim(widest_aim(width));
    for (const Caster &caster : casters) {
        const std::optional<Cone> cone = cone_towards(lamp.transform.origin, caster.center, caster.radius + lamp.width);
        float share = 1;
        if (cone) share = std::min(1.0f, cone->one_minus_cosine / width);
        if (cone && 1 - cone->nearest_cosine(axis) > width) share = 0;
        aim.add(cone, caster.strength * share);
    }
    return aim;
}

/// What the photons of one point of an area lamp are aimed at.
DirectionAim aim_from_area(const Lamp &lamp, Vec3 origin, std::span<const Caster> casters) {
    if (casters.empty()) return DirectionAim(0);
    const Vec3 axis = -normalize(lamp.transform.z);
    DirectionAim aim(widest_aim(one_minus_cos(std::min(lamp.spread, pi) / 2)));
    for (const Caster &caster : casters) {
        const std::optional<Cone> cone = cone_towards(origin, caster.center, caster.radius);
        float share = 1;
        if (cone) {
            const float cosine = std::max(0.0f, cone->nearest_cosine(axis));
            const float tangent = std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / std::max(cosine, 1e-6f);
            const float radiance = average(area_radiance(lamp, tangent)) * area(lamp) / average(lamp.power);
            share = std::min(1.0f, radiance * cosine * cone->solid_angle());
        }
        aim.add(cone, caster.strength * share);
    }
    return aim;
}

PhotonEmission emit_from_point(const Lamp &lamp, std::span<const Caster> casters, const EmissionNumbers &u) {
    const float cone = emission_cone(lamp);
    DirectionAim aim = aim_from_point(lamp, casters);
    std::optional<Vec3> direction = aim.sample(u.target, u.ray[0], u.ray[1]);
    if (!direction) direction = Frame(-normalize(lamp.transform.z)).to_world(sample_cone(u.ray[0], u.ray[1], cone));
    const float pdf = aim.pdf(*direction, 1 / (2 * pi * cone));

    // A sphere of radiance L shows to every direction a disk of flux L pi r^2 = intensity.
    const Vec2 d = sample_disk(u.ray[2], u.ray[3]);
    const Frame frame(*direction);
    const float depth = std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y));
    const Vec3 origin = lamp.transform.origin + (frame.x * d.x + frame.y * d.y + *direction * depth) * lamp.width;
    PhotonEmission photon;
    photon.ray = {origin, *direction};
    photon.flux = intensity(lamp) * (attenuation(lamp, *direction) / pdf);
    if (lamp.soft_falloff) {
        photon.falloff_center = lamp.transform.origin;
        photon.falloff_radius_squared = lamp.width * lamp.width;
    }
    return photon;
}

PhotonEmission emit_from_area(const Lamp &lamp, std::span<const Caster> casters, const EmissionNumbers &u) {
    const Vec3 x = normalize(lamp.transform.x), y = normalize(lamp.transform.y), z = normalize(lamp.transform.z);
    const Vec2 p =
        lamp.type == LightType::ellipse ? sample_disk(u.ray[2], u.ray[3]) : Vec2{2 * u.ray[2] - 1, 2 * u.ray[3] - 1};
    const Vec3 origin = lamp.transform.origin + x * (p.x * lamp.width / 2) + y * (p.y * lamp.height / 2);

    // Aimed, or cosine-distributed within the spread.
    const float sine = lamp.spread >= pi ? 1 : std::sin(lamp.spread / 2);
    DirectionAim aim = aim_from_area(lamp, origin, casters);
    std::optional<Vec3> direction = aim.sample(u.target, u.ray[0], u.ray[1]);
    if (!direction) {
        const Vec2 d = sample_disk(u.ray[0], u.ray[1]);
        const float cosine = std::sqrt(std::max(1e-12f, 1 - sine * sine * (d.x * d.x + d.y * d.y)));
        direction = x * (sine * d.x) + y * (sine * d.y) - z * cosine;
    }
    const float cosine = -dot(*direction, z);
    PhotonEmission photon;
    // A lamp in the plane of a ceiling shines off it, not into it.
    const Vec3 nudge = *direction * (max_component(abs(origin)) * 8 * std::numeric_limits<float>::epsilon());
    photon.ray = {origin + nudge, *direction};
    if (!(cosine > 0)) return photon;
    const float pdf = aim.pdf(*direction, cosine / (pi * sine * sine));
    photon.flux = area_radiance(lamp, *direction, -z) * (area(lamp) * cosine / pdf);
    return photon;
}

PhotonEmission emit_from_sun(const Lamp &lamp, const SceneSphere &sphere, std::span<const Caster> casters,
                             const EmissionNumbers &u) {
    const Vec3 axis = -normalize(lamp.transform.z);
    const float cone = sun_cone(lamp);
    const Vec3 direction = Frame(axis).to_world(sample_cone(u.ray[0], u.ray[1], cone));
    const Vec3 across = lamp.width == 0 ? lamp.power : sun_radiance(lamp) * (2 * pi * cone);
    const DiskAim::Line line =
        DiskAim(sphere.center, sphere.radius, casters).sample(direction, u.target, u.ray[2], u.ray[3]);
    PhotonEmission photon;
    photon.ray = {line.origin, direction};
    photon.flux = across / line.pdf;
    return photon;
}

}  // namespace

PhotonEmission emit_from_lamp(const Lamp &lamp, const SceneSphere &sphere, std::span<const Caster> casters,
                              const EmissionNumbers &u) {
    PhotonEmission photon = is_area(lamp)                 ? emit_from_area(lamp, casters, u)
                            : lamp.type == LightType::sun ? emit_from_sun(lamp, sphere, casters, u)
                                                          : emit_from_point(lamp, casters, u);
    photon.visibility = lamp.visibility;
    return photon;
}

float wanted_share(const Lamp &lamp, const SceneSphere &sphere, std::span<const Caster> casters) {
    if (lamp.type == LightType::sun) return DiskAim(sphere.center, sphere.radius, casters).total();
    if (is_area(lamp)) return aim_from_area(lamp, lamp.transform.origin, casters).total();
    return aim_from_point(lamp, casters).total();
}

}  // namespace photon_maps
