// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps: directions follow the density that a ray which meets the lamp is told, and bring the irradiance of the closed
// form.
#include "lamp.h"
#include "light_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

/// Irradiance at the origin, from above, of a parallelogram or ellipse of radiance 1, by the middles of its parts.
double area_irradiance(const Lamp &lamp) {
    constexpr uint32_t steps = 600;
    const Vec3 z = normalize(lamp.transform.z);
    double sum = 0;
    for (uint32_t i = 0; i < steps; ++i) {
        for (uint32_t j = 0; j < steps; ++j) {
            const float u = (static_cast<float>(i) + 0.5f) / steps * 2 - 1,
                        v = (static_cast<float>(j) + 0.5f) / steps * 2 - 1;
            if (lamp.type == LightType::ellipse && u * u + v * v > 1) continue;
            const Vec3 p = lamp.transform.origin + normalize(lamp.transform.x) * (u * lamp.width / 2) +
                           normalize(lamp.transform.y) * (v * lamp.height / 2);
            const float squared = length_squared(p);
            const Vec3 d = p / std::sqrt(squared);
            const float cosine = std::max(0.0f, dot(d, z));
            float radiance = 1;
            if (lamp.spread < pi) {
                const float h = lamp.spread / 2, tangent = std::sqrt(1 - cosine * cosine) / cosine;
                radiance = std::max(0.0f, (std::tan(h) - tangent) / (std::tan(h) - h));
            }
            sum += static_cast<double>(radiance * cosine * d.z / squared);
        }
    }
    return sum * static_cast<double>(lamp.width * lamp.height) / (steps * steps);
}

/// A lamp above the origin that shines down on it, slantwise.
Lamp lamp_above(LightType type, float distance, float width, float height = 0) {
    Lamp lamp{};
    lamp.type = type;
    const Frame frame(normalize(Vec3{0.3f, -0.2f, 1}));
    lamp.transform = {frame.x, frame.y, frame.z, frame.z * distance};
    lamp.power = {12, 12, 12};
    lamp.width = width;
    lamp.height = height;
    lamp.spot_angle = 1.2f;
    lamp.spot_blend = 0.3f;
    lamp.visibility = 1u << PM_RAY_DIFFUSE;
    return lamp;
}

/// Compares one lamp; its irradiance is given.
void check_lamp(Checks &checks, const std::string &name, const Lamp &lamp, float cone, double irradiance,
                double tolerance = 0.005) {
    Scene scene(embree());
    scene.freeze();
    const Lights lights(scene, {lamp}, {});
    const auto draw = [&](std::array<float, 3> u) {
        return lights.sample(0, {}, up, false, ray_of(PM_RAY_DIFFUSE), u);
    };
    const auto look = [&](Vec3 direction) {
        const std::optional<LampHit> hit =
            lights.meet(0, {{}, direction * 2.0f, 0, infinity, 1u << PM_RAY_DIFFUSE}, true);
        return hit ? Seen{hit->pdf, hit->radiance} : Seen{};
    };
    check_source(checks, name, draw, look, {normalize(lamp.transform.z), cone, irradiance, tolerance});

    // Where it is met, and by whom.
    const std::optional<LightSample> sample = draw({0.3f, 0.6f, 0.5f});
    if (!sample) return checks.that(false, name + ": a sample");
    Ray ray{{}, sample->direction * 2.0f, 0, infinity, 1u << PM_RAY_DIFFUSE};
    const std::optional<LampHit> hit = lights.meet(0, ray, true);
    if (!hit) return checks.that(false, name + ": the sample is met");
    if (std::isinf(sample->distance)) {
        checks.that(std::isinf(hit->distance) && !lights.meet(0, ray, false), name + ": lies beyond all surfaces");
    } else {
        checks.near(2.0 * static_cast<double>(hit->distance), static_cast<double>(sample->distance),
                    2e-4 * static_cast<double>(sample->distance), name + ": distance");
        ray.far = hit->distance * 0.99f;
        checks.that(!lights.meet(0, ray, false), name + ": behind a surface it is not met");
    }
    ray.far = infinity;
    ray.kinds = 1u << PM_RAY_GLOSSY;
    checks.that(!lights.meet(0, ray, true), name + ": invisible to other rays");
    checks.that(sample->visibility == lamp.visibility && hit->visibility == lamp.visibility, name + ": visibility");
}

void check_lamps(Checks &checks) {
    const double intensity = 12 / (4 * pi_double), cosine = static_cast<double>(normalize(Vec3{0.3f, -0.2f, 1}).z);
    const auto cone = [](double tangent) { return static_cast<float>(1 - 1 / std::hypot(1, tangent)); };

    check_lamp(checks, "sphere", lamp_above(LightType::point, 2, 0.5f), cone(0.27), intensity / 4 * cosine);
    check_lamp(checks, "small sphere", lamp_above(LightType::point, 2, 1e-3f), cone(6e-4), intensity / 4 * cosine);
    check_lamp(checks, "inside of a sphere", lamp_above(LightType::point, 1, 2), 2, intensity / 4);
    Lamp soft = lamp_above(LightType::point, 2, 0.5f);
    soft.soft_falloff = true;
    check_lamp(checks, "soft falloff", soft, cone(0.26), intensity / 4.25 * cosine);
    check_lamp(checks, "spot", lamp_above(LightType::spot, 2, 0.5f), cone(0.27), intensity / 4 * cosine);
    check_lamp(checks, "sun", lamp_above(LightType::sun, 0, 0.2f), cone(0.11), 12 * cosine);
    check_lamp(checks, "small sun", lamp_above(LightType::sun, 0, 0.00918f), cone(0.005), 12 * cosine);

    for (const LightType type : {LightType::rectangle, LightType::ellipse}) {
        for (const float distance : {0.4f, 2.0f, 60.0f}) {
            for (const float spread : {pi, 1.5f}) {
                Lamp lamp = lamp_above(type, distance, 1.5f, 0.5f);
                lamp.spread = spread;
                const double area = 0.75 * (type == LightType::ellipse ? pi_double / 4 : 1);
                const double irradiance = 12 / (pi_double * area) * area_irradiance(lamp);
                const std::string name = std::string(type == LightType::ellipse ? "ellipse" : "rectangle") + " at " +
                                         std::to_string(distance) + " of spread " + std::to_string(spread);
                check_lamp(checks, name, lamp, cone(0.8 / static_cast<double>(distance)), irradiance, 0.01);
            }
        }
    }
}

void check_lamps_in_a_row(Checks &checks) {
    Scene scene(embree());
    scene.freeze();
    const Lamp near = lamp_above(LightType::point, 2, 0.2f), far = lamp_above(LightType::rectangle, 3, 1, 1);
    const Lights lights(scene, {far, near, lamp_above(LightType::point, 1, 0)}, {});
    const Ray ray{{}, near.transform.origin};
    const std::optional<LampHit> hit = lights.meet(1, ray, false);
    checks.that(hit && hit->source == 1, "a lamp that is asked for by its number is met");
    checks.that(!lights.meet(2, ray, false), "a point is not met");
    double distance = 0;
    size_t count = 0;
    lights.meet_all(ray, false, [&](const LampHit &lamp) {
        ++count;
        distance += static_cast<double>(lamp.distance);
    });
    checks.that(count == 2, "all lamps along the ray are met");
    checks.near(distance, 0.9 + 1.5, 1e-5, "their distances");
    const std::optional<LightSample> point =
        lights.sample(2, {}, up, false, ray_of(PM_RAY_DIFFUSE), {0.5f, 0.5f, 0.5f});
    checks.that(point && point->pdf == 0, "a point has no density");

    double sum = 0;
    for (size_t source = 0; source < lights.source_count(); ++source)
        sum += static_cast<double>(lights.choice_probability(source, {1, 2, 3}));
    checks.near(sum, 1, 1e-6, "some source is chosen");
    for (const float u : {0.0f, 0.3f, 0.7f, 0.9999f}) {
        const auto choice = lights.choose(lights.chances_at({1, 2, 3}), u);
        checks.that(choice && choice->probability == lights.choice_probability(choice->source, {1, 2, 3}),
                    "the chosen source's probability");
    }
}

}  // namespace

namespace {

/// A spot fades from its edge by a smooth step in the cosine, over the share `spot_blend` of the cone.
void check_spot_blend(Checks &checks) {
    const Lamp spot = lamp_above(LightType::spot, 1, 0);
    const Frame frame(-normalize(spot.transform.z));
    const float edge = 1 - std::cos(spot.spot_angle / 2), fade = edge * spot.spot_blend;
    for (const float s : {0.0f, 0.1f, 0.25f, 0.6f, 1.0f}) {
        const float cosine = 1 - (edge - s * fade), sine = std::sqrt(1 - cosine * cosine);
        checks.near(double{attenuation(spot, frame.to_world({sine, 0, cosine}))}, double{s * s * (3 - 2 * s)}, 1e-3,
                    "a spot fades by a smooth step");
    }
}

}  // namespace

int main() {
    Checks checks;
    check_lamps(checks);
    check_spot_blend(checks);
    check_lamps_in_a_row(checks);
    return checks.report();
}
