// SPDX-License-Identifier: GPL-3.0-or-later
#include "lamp.h"

#include "sampling.h"
#include "spherical_rectangle.h"

namespace photon_maps {

namespace {

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

}  // namespace

/// 1 - cos of half the sun's angle.
float sun_cone(const Lamp &lamp) { return one_minus_cos(lamp.width / 2); }

/// Radiance of the sun's disk: irradiance across the beam is radiance * pi * sin^2 (half angle).
Vec3 sun_radiance(const Lamp &lamp) {
    const float sine = std::sin(lamp.width / 2);
    return lamp.power / (pi * sine * sine);
}

bool is_area(const Lamp &lamp) { return lamp.type == LightType::rectangle || lamp.type == LightType::ellipse; }

float area(const Lamp &lamp) { return lamp.width * lamp.height * (lamp.type == LightType::ellipse ? pi / 4 : 1.0f); }

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

Vec3 area_radiance(const Lamp &lamp, Vec3 direction, Vec3 normal) {
    if (lamp.spread >= pi) return area_radiance(lamp, 0);                                   // the same at all angles
    return area_radiance(lamp, length(cross(direction, normal)) / dot(direction, normal));  // exact for small ones too
}

namespace {

/// 1 - cos of the cone about its centre that a point or spot lamp fills, seen from a squared distance. A sphere is seen
/// from inside in all directions. Under soft falloff it is a disk that faces whoever looks: its irradiance is that of a
/// point times d2/(d2 + r2).
float sphere_cone(const Lamp &lamp, float squared) {
    const float radius_squared = lamp.width * lamp.width;
    if (!lamp.soft_falloff && squared <= radius_squared) return 2;
    const float sine_squared = radius_squared / (lamp.soft_falloff ? squared + radius_squared : squared);
    return sine_squared / (1 + std::sqrt(1 - sine_squared));
}

/// Distance to such a lamp in a direction within its cone.
float sphere_distance(const Lamp &lamp, Vec3 to_center, Vec3 direction) {
    const float squared = length_squared(to_center), along = dot(to_center, direction);
    if (lamp.soft_falloff) return squared / along;
    const float radius_squared = lamp.width * lamp.width;
    const float root = std::sqrt(std::max(0.0f, radius_squared - length_squared(to_center - direction * along)));
    return squared > radius_squared ? along - root : along + root;
}

/// Radiance of such a lamp: that of a disk of its radius whose flux is the intensity.
Vec3 sphere_radiance(const Lamp &lamp, Vec3 direction) {
    return intensity(lamp) * (attenuation(lamp, -direction) / (pi * lamp.width * lamp.width));
}

std::optional<LightSample> sample_point(const Lamp &lamp, Vec3 position, float u, float v) {
    const Vec3 to_center = lamp.transform.origin - position;
    const float squared = length_squared(to_center);
    if (!(squared > 0)) return {};
    const float distance = std::sqrt(squared);
    const Vec3 axis = to_center / distance;
    if (lamp.width == 0)
        return LightSample{axis, distance * shadow_end, intensity(lamp) * (attenuation(lamp, -axis) / squared), 0,
                           lamp.visibility};

    const float cone = sphere_cone(lamp, squared);
    const Vec3 direction = Frame(axis).to_world(sample_cone(u, v, cone));
    const float pdf = 1 / (2 * pi * cone);
    return LightSample{direction, sphere_distance(lamp, to_center, direction) * shadow_end,
                       sphere_radiance(lamp, direction) / pdf, pdf, lamp.visibility};
}

std::optional<LampHit> meet_sphere(const Lamp &lamp, Vec3 origin, Vec3 direction) {
    if (lamp.width == 0) return {};
    const Vec3 to_center = lamp.transform.origin - origin;
    const float squared = length_squared(to_center), along = dot(to_center, direction);
    const float radius_squared = lamp.width * lamp.width;
    if (along <= 0 && (lamp.soft_falloff || squared > radius_squared)) return {};
    const float distance = sphere_distance(lamp, to_center, direction);
    // Off the centre of the disk, or off the point of the ray that is nearest to that of the sphere.
    const Vec3 off = direction * (lamp.soft_falloff ? distance : along) - to_center;
    if (length_squared(off) > radius_squared) return {};
    return LampHit{0, distance, sphere_radiance(lamp, direction), 1 / (2 * pi * sphere_cone(lamp, squared)),
                   lamp.visibility};
}

std::optional<LightSample> sample_sun(const Lamp &lamp, float u, float v) {
    const Vec3 axis = normalize(lamp.transform.z);
    if (lamp.width == 0) return LightSample{axis, infinity, lamp.power, 0, lamp.visibility};
    const float pdf = 1 / (2 * pi * sun_cone(lamp));
    const Vec3 direction = Frame(axis).to_world(sample_cone(u, v, sun_cone(lamp)));
    return LightSample{direction, infinity, sun_radiance(lamp) / pdf, pdf, lamp.visibility};
}

std::optional<LampHit> meet_sun(const Lamp &lamp, Vec3 direction) {
    // 1 - cos by the chord: exact for small angles too.
    const float off_axis = length_squared(direction - normalize(lamp.transform.z)) / 2;
    if (lamp.width == 0 || off_axis > sun_cone(lamp)) return {};
    return LampHit{0, infinity, sun_radiance(lamp), 1 / (2 * pi * sun_cone(lamp)), lamp.visibility};
}

/// Seen smaller than this or slantwise the solid angle of a rectangle drowns in rounding; then it is sampled by area,
/// as ellipses always.
constexpr float least_solid_angle = 0.01f;

/// Density by solid angle with which a direction is chosen that meets an area lamp under a cosine.
/// @param solid_angle of the whole lamp, 0 for an ellipse
float area_pdf(const Lamp &lamp, float solid_angle, float squared_distance, float cosine) {
    return solid_angle >= least_solid_angle ? 1 / solid_angle : squared_distance / (area(lamp) * cosine);
}

/// An area lamp's axes, unit vectors; it shines along -z.
struct AreaAxes {
    Vec3 x, y, z;

    explicit AreaAxes(const Lamp &lamp)
        : x(normalize(lamp.transform.x)), y(normalize(lamp.transform.y)), z(normalize(lamp.transform.z)) {}
};

std::optional<LightSample> sample_area(const Lamp &lamp, Vec3 position, float u, float v) {
    const AreaAxes axes(lamp);
    const Vec3 center = lamp.transform.origin;
    if (dot(position - center, axes.z) >= 0) return {};  // behind

    Vec3 point;
    float solid_angle = 0;
    if (lamp.type == LightType::rectangle) {
        const SphericalRectangle rectangle(position, center, axes.x, axes.y, lamp.width, lamp.height);
        solid_angle = rectangle.solid_angle();
        if (solid_angle >= least_solid_angle) point = rectangle.sample(u, v);
    }
    if (!(solid_angle >= least_solid_angle)) {
        const Vec2 d = lamp.type == LightType::ellipse ? sample_disk(u, v) : Vec2{2 * u - 1, 2 * v - 1};
        point = center + axes.x * (d.x * lamp.width / 2) + axes.y * (d.y * lamp.height / 2);
    }
    const Vec3 to = point - position;
    const float squared = length_squared(to);
    const float distance = std::sqrt(squared);
    const Vec3 direction = to / distance;
    const float cosine = dot(direction, axes.z);
    if (!(cosine > 0)) return {};
    const float pdf = area_pdf(lamp, solid_angle, squared, cosine);
    return LightSample{direction, distance * shadow_end, area_radiance(lamp, direction, axes.z) / pdf, pdf,
                       lamp.visibility};
}

std::optional<LampHit> meet_area(const Lamp &lamp, Vec3 origin, Vec3 direction) {
    const Vec3 to_center = lamp.transform.origin - origin;
    const Vec3 z = normalize(lamp.transform.z);
    const float cosine = dot(direction, z), height = dot(to_center, z);
    if (cosine <= 0 || height <= 0) return {};  // behind, or away
    const float distance = height / cosine;
    const Vec3 p = direction * distance - to_center;
    const float reach = std::max(lamp.width, lamp.height);
    if (length_squared(p) > reach * reach) return {};
    const AreaAxes axes(lamp);
    const float u = 2 * dot(p, axes.x) / lamp.width, v = 2 * dot(p, axes.y) / lamp.height;
    const bool is_ellipse = lamp.type == LightType::ellipse;
    if (is_ellipse ? u * u + v * v > 1 : std::abs(u) > 1 || std::abs(v) > 1) return {};
    const float solid_angle =
        is_ellipse
            ? 0
            : SphericalRectangle(origin, lamp.transform.origin, axes.x, axes.y, lamp.width, lamp.height).solid_angle();
    return LampHit{0, distance, area_radiance(lamp, direction, z),
                   area_pdf(lamp, solid_angle, distance * distance, cosine), lamp.visibility};
}

}  // namespace

std::optional<LightSample> sample_lamp(const Lamp &lamp, Vec3 position, float u, float v) {
    if (is_area(lamp)) return sample_area(lamp, position, u, v);
    return lamp.type == LightType::sun ? sample_sun(lamp, u, v) : sample_point(lamp, position, u, v);
}

float emitted_power(const Lamp &lamp, const SceneSphere &sphere) {
    const float power = average(lamp.power);
    if (lamp.type == LightType::sun) return power * pi * sphere.radius * sphere.radius;
    if (lamp.type == LightType::spot) return power * emission_cone(lamp) / 2;
    return power;
}

LightReach reach_of(const Lamp &lamp) {
    const float power = average(lamp.power);
    if (lamp.type == LightType::sun) return {{}, 0, 1, power};
    const float floor = std::max(is_area(lamp) ? area(lamp) : lamp.width * lamp.width, least_floor);
    return {lamp.transform.origin, power / (is_area(lamp) ? pi : 4 * pi), floor, 0};
}

float reach_about_center(const Lamp &lamp) {
    if (!is_area(lamp)) return lamp.width;
    const float longer = std::max(lamp.width, lamp.height), shorter = std::min(lamp.width, lamp.height);
    return (lamp.type == LightType::ellipse ? longer : std::sqrt(longer * longer + shorter * shorter)) / 2;
}

std::optional<LampHit> meet_lamp(const Lamp &lamp, Vec3 origin, Vec3 direction) {
    if (is_area(lamp)) return meet_area(lamp, origin, direction);
    return lamp.type == LightType::sun ? meet_sun(lamp, direction) : meet_sphere(lamp, origin, direction);
}

}  // namespace photon_maps
