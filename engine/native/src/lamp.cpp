// SPDX-License-Identifier: GPL-3.0-or-later
#include "lamp.h"

#include "sampling.h"
#include "spherical_rectangle.h"

namespace photon_maps {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A shadow ray stops short of what it aims at by this share, so that it does not meet the lamp's own housing.
constexpr float shadow_end = 0.9999f;

/// 1 - cos of half the sun's angle.
float sun_cone(const Lamp &lamp) { return one_minus_cos(lamp.width / 2); }

/// Radiance of the sun's disk: irradiance across the beam is radiance * pi * sin^2 (half angle).
Vec3 sun_radiance(const Lamp &lamp) {
    const float sine = std::sin(lamp.width / 2);
    return lamp.power / (pi * sine * sine);
}

bool is_area(const Lamp &lamp) { return lamp.type == LightType::rectangle || lamp.type == LightType::ellipse; }

float area(const Lamp &lamp) { return lamp.width * lamp.height * (lamp.type == LightType::ellipse ? pi / 4 : 1.0f); }

/// Share of a spot's intensity in a unit direction of travel: a smooth step in the cosine over `spot_blend` of the
/// cone, as Blender draws it. Non-uniform scale of the lamp stretches the cone.
float spot_attenuation(const Lamp &lamp, Vec3 direction) {
    const Transform &t = lamp.transform;
    const Vec3 local{dot(direction, t.x) / length_squared(t.x), dot(direction, t.y) / length_squared(t.y),
                     -dot(direction, t.z) / length_squared(t.z)};
    const float edge = one_minus_cos(lamp.spot_angle / 2);
    const float fade = edge * lamp.spot_blend;
    const float inside = edge - (1 - normalize(local).z);
    if (inside <= 0) return 0;
    if (inside >= fade) return 1;
    const float s = inside / fade;
    return s * s * (3 - 2 * s);
}

/// 1 - cos of the cone about -z, unscaled, that holds all directions of a point or spot lamp.
float emission_cone(const Lamp &lamp) {
    if (lamp.type != LightType::spot) return 2;
    const Transform &t = lamp.transform;
    const float widening = std::max(length(t.x), length(t.y)) / length(t.z);
    if (lamp.spot_angle >= pi) return 2;
    return one_minus_cos(std::atan(std::tan(lamp.spot_angle / 2) * std::max(widening, 1e-6f)));
}

float attenuation(const Lamp &lamp, Vec3 direction) {
    return lamp.type == LightType::spot ? spot_attenuation(lamp, direction) : 1.0f;
}

/// Radiant intensity of a point or spot lamp on its axis, W/sr.
Vec3 intensity(const Lamp &lamp) { return lamp.power / (4 * pi); }

/// Radiance of an area lamp at an angle to its normal whose tangent is given: power / (pi area), narrowed by the
/// spread as by the slats of a soft box, (tan h - tan a) / (tan h - h) with h half the spread: flux is kept.
Vec3 area_radiance(const Lamp &lamp, float tangent) {
    const Vec3 full = lamp.power / (pi * area(lamp));
    if (lamp.spread >= pi) return full;
    const double half = static_cast<double>(lamp.spread) / 2;  // tan h - h cancels to h^3 / 3
    const double slats = (std::tan(half) - static_cast<double>(tangent)) / (std::tan(half) - half);
    return full * static_cast<float>(std::max(0.0, slats));
}

/// Tangent of the angle between unit vectors, exact for small angles too.
float tangent_between(Vec3 a, Vec3 b) { return length(cross(a, b)) / dot(a, b); }

std::optional<LightSample> sample_point(const Lamp &lamp, Vec3 position, float u, float v) {
    const Vec3 to_center = lamp.transform.origin - position;
    const float squared = length_squared(to_center);
    const float radius_squared = lamp.width * lamp.width;
    if (squared <= radius_squared) return {};
    const float distance = std::sqrt(squared);
    const Vec3 axis = to_center / distance;
    const float falloff = lamp.soft_falloff ? squared / (squared + radius_squared) : 1;
    if (lamp.width == 0)
        return LightSample{axis, distance * shadow_end, intensity(lamp) * (attenuation(lamp, -axis) / squared), 0};

    // Uniform in the cone that the sphere fills; its radiance is intensity / (pi r^2).
    const float sine_squared = radius_squared / squared;
    const float cone = sine_squared / (1 + std::sqrt(1 - sine_squared));
    const Vec3 local = sample_cone(u, v, cone);
    const Vec3 direction = Frame(axis).to_world(local);
    const float across = squared * (1 - local.z * local.z);
    const float entry = distance * local.z - std::sqrt(std::max(0.0f, radius_squared - across));
    const Vec3 radiance = intensity(lamp) * (attenuation(lamp, -direction) / (pi * radius_squared));
    return LightSample{direction, entry * shadow_end, radiance * (2 * pi * cone * falloff), 0};
}

std::optional<LightSample> sample_sun(const Lamp &lamp, float u, float v) {
    const Vec3 axis = normalize(lamp.transform.z);
    if (lamp.width == 0) return LightSample{axis, infinity, lamp.power, 0};
    const float cone = sun_cone(lamp);
    const Vec3 direction = Frame(axis).to_world(sample_cone(u, v, cone));
    return LightSample{direction, infinity, sun_radiance(lamp) * (2 * pi * cone), 0};
}

std::optional<LightSample> sample_area(const Lamp &lamp, Vec3 position, float u, float v) {
    const Vec3 x = normalize(lamp.transform.x), y = normalize(lamp.transform.y), z = normalize(lamp.transform.z);
    const Vec3 center = lamp.transform.origin;
    if (dot(position - center, z) >= 0) return {};  // behind: lamps shine along -z

    Vec3 point;
    float solid_angle = 0;
    if (lamp.type == LightType::rectangle) {
        const SphericalRectangle rectangle(position, center, x, y, lamp.width, lamp.height);
        solid_angle = rectangle.solid_angle();
        point = rectangle.sample(u, v);
    }
    // Seen small or slantwise the solid angle drowns in rounding; then by area, as ellipses always.
    const bool by_area = solid_angle < 0.01f;
    if (by_area) {
        const Vec2 d = lamp.type == LightType::ellipse ? sample_disk(u, v) : Vec2{2 * u - 1, 2 * v - 1};
        point = center + x * (d.x * lamp.width / 2) + y * (d.y * lamp.height / 2);
    }
    const Vec3 to = point - position;
    const float squared = length_squared(to);
    const float distance = std::sqrt(squared);
    const Vec3 direction = to / distance;
    const float cosine = dot(direction, z);
    if (!(cosine > 0)) return {};
    if (by_area) solid_angle = area(lamp) * cosine / squared;
    return LightSample{direction, distance * shadow_end,
                       area_radiance(lamp, tangent_between(direction, z)) * solid_angle, 0};
}

PhotonEmission emit_from_point(const Lamp &lamp, const std::array<float, 4> &u) {
    // A sphere of radiance L shows to every direction a disk of flux L pi r^2 = intensity.
    const float cone = emission_cone(lamp);
    const Vec3 direction = Frame(-normalize(lamp.transform.z)).to_world(sample_cone(u[0], u[1], cone));
    const Vec2 d = sample_disk(u[2], u[3]);
    const Frame frame(direction);
    const float depth = std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y));
    const Vec3 origin = lamp.transform.origin + (frame.x * d.x + frame.y * d.y + direction * depth) * lamp.width;
    PhotonEmission photon{{origin, direction}, intensity(lamp) * (2 * pi * cone * attenuation(lamp, direction)), {}};
    if (lamp.soft_falloff) {
        photon.falloff_center = lamp.transform.origin;
        photon.falloff_radius_squared = lamp.width * lamp.width;
    }
    return photon;
}

PhotonEmission emit_from_area(const Lamp &lamp, const std::array<float, 4> &u) {
    const Vec3 x = normalize(lamp.transform.x), y = normalize(lamp.transform.y), z = normalize(lamp.transform.z);
    const Vec2 p = lamp.type == LightType::ellipse ? sample_disk(u[2], u[3]) : Vec2{2 * u[2] - 1, 2 * u[3] - 1};
    const Vec3 origin = lamp.transform.origin + x * (p.x * lamp.width / 2) + y * (p.y * lamp.height / 2);

    // Cosine-distributed within the spread; what varies in the radiance goes into the flux.
    const float sine = lamp.spread >= pi ? 1 : std::sin(lamp.spread / 2);
    const Vec2 d = sample_disk(u[0], u[1]);
    const float squared = sine * sine * (d.x * d.x + d.y * d.y);
    const float cosine = std::sqrt(std::max(1e-12f, 1 - squared));
    const Vec3 direction = x * (sine * d.x) + y * (sine * d.y) - z * cosine;
    const Vec3 flux = area_radiance(lamp, std::sqrt(squared) / cosine) * (pi * sine * sine * area(lamp));
    // A lamp in the plane of a ceiling shines off it, not into it.
    const Vec3 nudge = direction * (max_component(abs(origin)) * 8 * std::numeric_limits<float>::epsilon());
    return {{origin + nudge, direction}, flux, {}};
}

}  // namespace

Ray ray_across(const SceneSphere &sphere, Vec3 direction, float u, float v) {
    const Vec2 d = sample_disk(u, v);
    const Frame frame(direction);
    return {sphere.center + (frame.x * d.x + frame.y * d.y - direction) * sphere.radius, direction};
}

std::optional<LightSample> sample_lamp(const Lamp &lamp, Vec3 position, float u, float v) {
    if (is_area(lamp)) return sample_area(lamp, position, u, v);
    return lamp.type == LightType::sun ? sample_sun(lamp, u, v) : sample_point(lamp, position, u, v);
}

PhotonEmission emit_from_lamp(const Lamp &lamp, const SceneSphere &sphere, const std::array<float, 4> &u) {
    if (is_area(lamp)) return emit_from_area(lamp, u);
    if (lamp.type != LightType::sun) return emit_from_point(lamp, u);

    const Vec3 axis = -normalize(lamp.transform.z);
    const float cone = sun_cone(lamp);
    const Vec3 direction = Frame(axis).to_world(sample_cone(u[0], u[1], cone));
    const Vec3 across = lamp.width == 0 ? lamp.power : sun_radiance(lamp) * (2 * pi * cone);
    return {ray_across(sphere, direction, u[2], u[3]), across * (pi * sphere.radius * sphere.radius), {}};
}

float emitted_power(const Lamp &lamp, const SceneSphere &sphere) {
    const float power = average(lamp.power);
    if (lamp.type == LightType::sun) return power * pi * sphere.radius * sphere.radius;
    if (lamp.type == LightType::spot) return power * emission_cone(lamp) / 2;
    return power;
}

float possible_irradiance(const Lamp &lamp, Vec3 position) {
    const float power = average(lamp.power);
    if (lamp.type == LightType::sun) return power;
    const float squared = length_squared(lamp.transform.origin - position);
    if (is_area(lamp)) return power / (pi * std::max(squared, area(lamp)));
    return power / (4 * pi * std::max(squared, std::max(lamp.width * lamp.width, 1e-20f)));
}

std::optional<std::pair<Vec3, float>> intersect_lamp(const Lamp &lamp, const Ray &ray) {
    const Vec3 to_center = lamp.transform.origin - ray.origin;
    const Vec3 direction = normalize(ray.direction);
    const float scale = 1 / length(ray.direction);
    if (lamp.type == LightType::sun) {
        const float inside = sun_cone(lamp) - (1 - dot(direction, normalize(lamp.transform.z)));
        if (lamp.width == 0 || inside < 0) return {};
        return std::pair{sun_radiance(lamp), infinity};
    }
    if (is_area(lamp)) {
        const Vec3 z = normalize(lamp.transform.z);
        const float cosine = dot(direction, z);
        if (cosine <= 0) return {};
        const float distance = dot(to_center, z) / cosine;
        const Vec3 p = direction * distance - to_center;
        const float u = 2 * dot(p, normalize(lamp.transform.x)) / lamp.width;
        const float v = 2 * dot(p, normalize(lamp.transform.y)) / lamp.height;
        const bool inside = lamp.type == LightType::ellipse ? u * u + v * v <= 1 : std::abs(u) <= 1 && std::abs(v) <= 1;
        if (distance <= 0 || !inside) return {};
        return std::pair{area_radiance(lamp, tangent_between(direction, z)), distance * scale};
    }
    const float along = dot(to_center, direction);
    const float across = length_squared(to_center - direction * along);
    const float radius_squared = lamp.width * lamp.width;
    if (lamp.width == 0 || across > radius_squared) return {};
    const float distance = along - std::sqrt(radius_squared - across);
    if (distance <= 0) return {};
    const Vec3 radiance = intensity(lamp) * (attenuation(lamp, -direction) / (pi * radius_squared));
    return std::pair{radiance, distance * scale};
}

}  // namespace photon_maps
