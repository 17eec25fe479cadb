// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles: points on them follow the density that a ray which meets them is told, and bring the irradiance
// of the closed form.
#include "light_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

/// Irradiance of a triangle of radiance 1 at the origin (Lambert's formula).
double triangle_irradiance(std::array<Vec3, 3> corners) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) {
        const Vec3 a = normalize(corners[i]), b = normalize(corners[(i + 1) % 3]);
        sum += std::acos(static_cast<double>(dot(a, b))) * static_cast<double>(normalize(cross(a, b)).z);
    }
    return std::abs(sum) / 2;
}

/// Two instances, one of them moved, of a mesh of two triangles of unlike brightness and one that is dark.
struct TriangleScene {
    Scene scene{embree()};

    TriangleScene() {
        Mesh mesh;
        mesh.vertices = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2.5f}, {-1, 1, 2}, {0, -2, 2}, {}};
        mesh.triangles = {{0, 1, 2}, {1, 0, 4}, {0, 2, 3}};
        mesh.slots = {0, 1, 2};
        mesh.slot_count = 3;
        scene.meshes.push_back(mesh);
        scene.instances.resize(2);
        scene.instances[1].transform.origin = scene.instances[1].place.origin = {0.5f, 3, 0.5f};
        scene.instances[0].visibility = 1u << PM_RAY_DIFFUSE;
        scene.slot_materials = {1, 0, 2};
        for (const float radiance : {0.0f, 1.0f, 5.0f})
            scene.materials.push_back(emitter(scene, {radiance, radiance, radiance}));
    }

    double irradiance() const {
        double sum = 0;
        for (const Vec3 offset : {Vec3{}, Vec3{0.5f, 3, 0.5f}}) {
            const auto corner = [&](size_t i) { return scene.meshes[0].vertices[i] + offset; };
            sum += triangle_irradiance({corner(0), corner(1), corner(2)}) +
                   5 * triangle_irradiance({corner(0), corner(2), corner(3)});
        }
        return sum;
    }
};

/// Compares the triangles of a built scene, seen from the origin.
void check_emitters(Checks &checks, const std::string &name, const Scene &scene, const Lights &lights, Vec3 axis,
                    float cone, double irradiance, double tolerance = 0.005) {
    const RayState ray = ray_of(PM_RAY_DIFFUSE);
    const auto draw = [&](std::array<float, 3> u) {
        return lights.sample(lights.triangles_source(), {}, up, false, ray, u);
    };
    const auto look = [&](Vec3 direction) {
        SurfacePoint hit;
        if (!scene.intersect({{}, direction}, hit) || !hit.material->emits()) return Seen{};
        return Seen{lights.triangle_pdf({}, hit), shade(scene, hit, -direction, ray).emission};
    };
    check_source(checks, name, draw, look, {axis, cone, irradiance, tolerance});
}

void check_triangles(Checks &checks) {
    TriangleScene triangles;
    Scene &scene = triangles.scene;
    const double irradiance = triangles.irradiance();
    scene.freeze();
    scene.build(1, nullptr);
    const Lights lights(scene, {}, {});
    check_emitters(checks, "triangles", scene, lights, normalize(Vec3{0.2f, 1.2f, 2}), 0.5f, irradiance);

    double sum = 0;
    for (uint32_t i = 0; i < 2; ++i) {
        for (uint32_t t = 0; t < 3; ++t) {
            const float probability = lights.emissive_triangles().probability(i, t);
            checks.that((probability > 0) == (t != 1), "triangles that emit can be chosen");
            sum += static_cast<double>(probability);
        }
    }
    checks.near(sum, 1, 1e-6, "some triangle is chosen");
    const auto draw = [&](std::array<float, 3> u) {
        return lights.sample(lights.triangles_source(), {}, up, false, ray_of(PM_RAY_DIFFUSE), u);
    };
    const auto of_first = draw({0.5f, 0.5f, 0.1f}), of_second = draw({0.5f, 0.5f, 0.9f});
    checks.that(of_first && of_first->visibility == 1u << PM_RAY_DIFFUSE && of_second && of_second->visibility == ~0u,
                "the visibility is the instance's");
}

/// A square above the origin, of `steps` x `steps` pairs of triangles that face down, or up.
Mesh square(uint32_t steps, bool faces_down) {
    Mesh mesh;
    const auto at = [&](uint32_t i) { return static_cast<float>(i) * 2 / static_cast<float>(steps) - 1; };
    for (uint32_t j = 0; j <= steps; ++j)
        for (uint32_t i = 0; i <= steps; ++i) mesh.vertices.push_back({at(i), at(j), 1});
    mesh.vertices.emplace_back();
    for (uint32_t j = 0; j < steps; ++j) {
        for (uint32_t i = 0; i < steps; ++i) {
            const uint32_t a = j * (steps + 1) + i, b = a + 1, c = a + steps + 1, d = c + 1;
            mesh.triangles.push_back(faces_down ? Triangle{a, d, b} : Triangle{a, b, d});
            mesh.triangles.push_back(faces_down ? Triangle{a, c, d} : Triangle{a, d, c});
        }
    }
    mesh.slot_count = 1;
    return mesh;
}

/// Irradiance at the origin of that square, whose radiance is a function of x.
double square_irradiance(const std::function<double(double)> &radiance) {
    constexpr int steps = 1000;
    double sum = 0;
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            const double x = (i + 0.5) / steps * 2 - 1, y = (j + 0.5) / steps * 2 - 1, squared = 1 + x * x + y * y;
            sum += radiance(x) / (squared * squared);
        }
    }
    return sum * 4 / (steps * steps);
}

void check_square(Checks &checks, const std::string &name, Mesh mesh, Builder builder, uint32_t shown,
                  const std::function<double(double)> &radiance) {
    Scene scene(embree());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.resize(1);
    scene.slot_materials = {0};
    scene.materials.push_back(builder.emitting(shown, scene));
    scene.freeze();
    scene.build(1, nullptr);
    const Lights lights(scene, {}, {});
    const double irradiance = square_irradiance(radiance);
    if (irradiance > 0) check_emitters(checks, name, scene, lights, up, 0.5f, irradiance, 0.01);
    for (uint32_t t = 0; t < scene.meshes[0].triangles.size(); ++t)
        checks.that(lights.emissive_triangles().probability(0, t) > 0, name + ": every triangle can be chosen");
}

void check_varying_triangles(Checks &checks) {
    Builder x_squared;
    const uint32_t position = x_squared.add(PM_OP_INPUT, {}, PM_INPUT_POSITION);
    const uint32_t x = x_squared.add(PM_OP_COMPONENT, {position}, 0);
    const uint32_t squared = x_squared.add(PM_OP_MATH, {x, x}, PM_MATH_MULTIPLY);
    check_square(checks, "emission x^2", square(1, true), x_squared, squared, [](double v) { return v * v; });

    // A narrow strip of light, much of it between the points that are looked at.
    Builder strip;
    const uint32_t edge = strip.constant({0.93f, 0.93f, 0.93f});
    const uint32_t along = strip.add(PM_OP_COMPONENT, {strip.add(PM_OP_INPUT, {}, PM_INPUT_POSITION)}, 0);
    const uint32_t lit = strip.add(PM_OP_MATH, {along, edge}, PM_MATH_GREATER_THAN);
    for (const uint32_t steps : {1u, 3u, 20u}) {
        check_square(checks, "strip over " + std::to_string(steps), square(steps, true), strip, lit,
                     [](double v) { return v > 0.93 ? 1 : 0; });
    }

    // The back alone shines.
    Builder back;
    const uint32_t is_back = back.add(PM_OP_INPUT, {}, PM_INPUT_BACKFACING);
    check_square(checks, "back", square(2, false), back, is_back, [](double) { return 1; });
    check_square(checks, "dark front", square(2, true), back, is_back, [](double) { return 0; });
}

void check_dark_triangles(Checks &checks) {
    Scene scene(embree());
    scene.meshes.push_back(square(1, true));
    scene.instances.resize(1);
    scene.slot_materials = {0};
    Builder builder;
    scene.materials.push_back(builder.emitting(builder.add(PM_OP_INPUT, {}, PM_INPUT_IS_CAMERA_RAY), scene));
    scene.freeze();
    scene.build(1, nullptr);
    const Lights lights(scene, {}, {});
    SurfacePoint hit;
    checks.that(scene.intersect({{}, up}, hit) && hit.material->emits(), "something that may emit is met");
    checks.that(!lights.shines(lights.triangles_source()) && lights.empty(), "what only the camera sees is no light");
    checks.that(lights.triangle_pdf({}, hit) == 0 && lights.choice_probability(lights.triangles_source(), {}) == 0,
                "and is not chosen");
}

}  // namespace

int main() {
    Checks checks;
    check_triangles(checks);
    check_varying_triangles(checks);
    check_dark_triangles(checks);
    return checks.report();
}
