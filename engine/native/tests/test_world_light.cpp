// SPDX-License-Identifier: GPL-3.0-or-later
// The world as a light: directions follow the density that is told of them, and bring the irradiance of the closed
// form.
#include "light_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

void check_uniform_world(Checks &checks) {
    Scene scene(embree());
    scene.materials = {emitter(scene, {1, 2, 3}), emitter(scene, {1, 2, 3})};
    scene.materials[1].traits.is_constant = false;  // gets a map
    scene.freeze();
    for (const uint32_t material : {0u, 1u}) {
        for (const bool both_sides : {false, true}) {
            const Lights lights(scene, {}, {material, ~0u});
            const Vec3 normal = normalize(Vec3{1, 0, 1});
            const auto draw = [&](std::array<float, 3> u) {
                return lights.sample(lights.world_source(), {}, normal, both_sides, ray_of(PM_RAY_DIFFUSE), u);
            };
            const auto look = [&](Vec3 direction) {
                return Seen{lights.world_pdf(direction, normal, both_sides),
                            lights.world_radiance(direction, ray_of(PM_RAY_DIFFUSE))};
            };
            // Without transmission only what is above both the plane and its shading normal is asked for.
            const bool covers_all = both_sides || material == 1;
            const double irradiance = 2 * pi_double * (covers_all ? 1 : (1 + std::sqrt(0.5)) / 2);
            check_source(checks, "uniform world", draw, look, {normal, 2, irradiance, 0.01});
        }
    }
    const Lights hidden(scene, {}, {0, 1u << PM_RAY_CAMERA});
    checks.that(!hidden.shines(hidden.world_source()), "a world that only the camera sees lights nothing");
    checks.that(max_component(hidden.world_radiance(up, ray_of(PM_RAY_DIFFUSE))) <= 0, "nor is it seen by other rays");
    checks.that(hidden.world_radiance(up, ray_of(PM_RAY_CAMERA)) == Vec3{1, 2, 3}, "but by the camera");
}

/// Compares a map with its own density, and sums a function by it.
void check_map(Checks &checks, const std::string &name, const std::function<float(Vec3)> &value, Vec3 axis, float cone,
               double irradiance, double mean) {
    const DirectionMap map(value);
    const auto draw = [&](std::array<float, 3> u) {
        const Vec3 d = map.sample(u[0], u[1]);
        const float pdf = map.pdf(d);
        const float radiance = value(d) / pdf;
        return std::optional(LightSample{d, infinity, {radiance, radiance, radiance}, pdf, ~0u});
    };
    const auto look = [&](Vec3 d) { return Seen{map.pdf(d), Vec3{1, 1, 1} * value(d)}; };
    check_source(checks, name, draw, look, {axis, cone, irradiance, 0.005});
    checks.near(static_cast<double>(map.mean()), mean, 0.01 * mean, name + ": mean");
}

void check_maps(Checks &checks) {
    check_map(
        checks, "gradient", [](Vec3 d) { return 1 + d.z; }, normalize(Vec3{1, 2, 3}), 2, pi_double * (1 + 2.0 / 3), 1);

    // A sun of 0.53 degrees that is as bright as the rest of the sky by thousands.
    const Vec3 sun = normalize(Vec3{0.5f, -0.4f, 0.6f});
    const float disk = one_minus_cos(0.00463f);
    const auto sky = [&](Vec3 d) { return length_squared(d - sun) / 2 < disk ? 1e5f : 1.0f; };
    const double sun_angle = 2 * pi_double * static_cast<double>(disk);
    check_map(checks, "sun in the sky", sky, sun, one_minus_cos(0.03f),
              pi_double + 1e5 * sun_angle * static_cast<double>(sun.z), 1 + 1e5 * sun_angle / (4 * pi_double));

    // Half the sphere is black.
    check_map(checks, "half sky", [](Vec3 d) { return d.z > 0 ? 1.0f : 0.0f; }, up, 2, pi_double, 0.5);
}

/// A world of a shader lights a plane above and below.
void check_shader_world(Checks &checks, const std::string &name, Builder builder, uint32_t shown, Vec3 axis, float cone,
                        double irradiance, double mean) {
    Scene scene(nullptr);
    scene.materials.push_back(builder.emitting(shown, scene));
    scene.freeze();
    const Lights lights(scene, {}, {0, ~0u});
    checks.near(static_cast<double>(lights.world_light().mean_radiance()), mean, 0.01 * mean, name + ": mean");
    for (const bool both_sides : {false, true}) {
        const auto draw = [&](std::array<float, 3> u) {
            return lights.sample(lights.world_source(), {}, up, both_sides, ray_of(PM_RAY_DIFFUSE), u);
        };
        const auto look = [&](Vec3 direction) {
            return Seen{lights.world_pdf(direction, up, both_sides),
                        lights.world_radiance(direction, ray_of(PM_RAY_DIFFUSE))};
        };
        check_source(checks, name, draw, look, {axis, cone, irradiance, 0.01});
    }
    for (const float u : {0.1f, 0.4f, 0.9f}) {
        const WorldLight::Direction from = lights.world_light().sample(u, 1 - u);
        checks.that(from.pdf == lights.world_light().pdf(from.direction) &&
                        from.radiance == lights.world_radiance(from.direction, ray_of(PM_RAY_DIFFUSE)),
                    name + ": directions of photons");
    }
}

void check_shader_worlds(Checks &checks) {
    Builder gradient;
    const uint32_t one = gradient.constant({1, 1, 1});
    const uint32_t z = gradient.add(PM_OP_COMPONENT, {gradient.add(PM_OP_INPUT, {}, PM_INPUT_POSITION)}, 2);
    const uint32_t sum = gradient.add(PM_OP_MATH, {z, one}, PM_MATH_ADD);
    check_shader_world(checks, "gradient shader", gradient, sum, normalize(Vec3{1, 2, 3}), 2, pi_double * (1 + 2.0 / 3),
                       1);

    // A disk of 2 degrees that is brighter than the rest.
    const Vec3 sun = normalize(Vec3{0.5f, -0.4f, 0.6f});
    const float disk = one_minus_cos(0.02f);
    Builder spot;
    const uint32_t axis = spot.constant(sun), edge = spot.constant(Vec3{1, 1, 1} * (1 - disk));
    const uint32_t bright = spot.constant({1e4f, 1e4f, 1e4f}), sky = spot.constant({1, 1, 1});
    const uint32_t cosine = spot.add(PM_OP_VECTOR, {axis, spot.add(PM_OP_INPUT, {}, PM_INPUT_POSITION)}, PM_VECTOR_DOT);
    const uint32_t inside = spot.add(PM_OP_MATH, {cosine, edge}, PM_MATH_GREATER_THAN);
    const uint32_t radiance = spot.add(PM_OP_MATH, {inside, bright, sky}, PM_MATH_MULTIPLY_ADD);
    const double angle = 2 * pi_double * static_cast<double>(disk);
    check_shader_world(checks, "spot shader", spot, radiance, sun, one_minus_cos(0.06f),
                       pi_double + 1e4 * angle * static_cast<double>(sun.z), 1 + 1e4 * angle / (4 * pi_double));
}

void check_world_of_some_rays(Checks &checks) {
    for (const pm_input kind : {PM_INPUT_IS_CAMERA_RAY, PM_INPUT_IS_DIFFUSE_RAY, PM_INPUT_IS_GLOSSY_RAY}) {
        Scene scene(nullptr);
        Builder builder;
        scene.materials.push_back(builder.emitting(builder.add(PM_OP_INPUT, {}, kind), scene));
        scene.freeze();
        const WorldLight light(scene, {0, ~0u});
        checks.that(light.shines() == (kind != PM_INPUT_IS_CAMERA_RAY), "what only the camera sees lights nothing");
        checks.that(light.radiance(up, ray_of(PM_RAY_GLOSSY)).x == (kind == PM_INPUT_IS_GLOSSY_RAY ? 1.0f : 0.0f),
                    "each ray sees its own world");
    }
}

}  // namespace

int main() {
    Checks checks;
    check_uniform_world(checks);
    check_maps(checks);
    check_shader_worlds(checks);
    check_world_of_some_rays(checks);
    return checks.report();
}
