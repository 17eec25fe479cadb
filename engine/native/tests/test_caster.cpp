// SPDX-License-Identifier: GPL-3.0-or-later
// The spheres that photons are aimed at hold every glossy triangle, and no more of the scene than need be.
#include <random>

#include "caster.h"
#include "check.h"
#include "emission_scenes.h"

using namespace photon_maps;

namespace {

bool holds(const Caster &caster, const WorldTriangle &t) {
    return std::max({length(t.a - caster.center), length(t.b - caster.center), length(t.c - caster.center)}) <=
           caster.radius;
}

/// Checks that each glossy triangle lies in one of the spheres.
void check_all_held(test::Checks &checks, const Scene &scene, const std::vector<Caster> &casters) {
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        for (uint32_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); ++t) {
            if ((scene.material(i, t).traits.lobes & glossy_lobes) == 0) continue;
            const WorldTriangle corners = scene.world_triangle(i, t);
            checks.that(std::ranges::any_of(casters, [&](const Caster &c) { return holds(c, corners); }),
                        "a glossy triangle lies in a sphere");
        }
    }
}

void check_ball(test::Checks &checks) {
    test::TestScene test;
    test.add(test::pane_mesh(100, 100), {}, test::matte);
    test.scene.freeze();
    checks.that(find_casters(test.scene).empty(), "a matte scene has no casters");

    test::TestScene with_ball;
    with_ball.add(test::pane_mesh(100, 100), {}, test::matte);
    with_ball.add(test::sphere_mesh(2), {3, 4, 5}, test::glass);
    with_ball.scene.freeze();
    const std::vector<Caster> casters = find_casters(with_ball.scene);
    checks.near(static_cast<double>(casters.size()), 1, 0, "one ball is one caster");
    checks.near(double{length(casters[0].center - Vec3{3, 4, 5})}, 0, 0.01, "the ball's centre");
    checks.that(casters[0].radius >= 2 && casters[0].radius < 2.4f, "the ball's radius, and little more");
    checks.near(double{casters[0].strength}, 1, 1e-6, "the ball's strength");
}

void check_things_apart(test::Checks &checks) {
    // Two balls and a pane in one mesh whose first slot is matte, and far away a plastic ball.
    test::TestScene test;
    const Mesh floor = test::pane_mesh(200, 200), ball = test::sphere_mesh(1);
    Mesh mesh = test::joined(test::joined(floor, ball, {-50, 0, 1}, 1), ball, {50, 0, 1}, 1);
    mesh = test::joined(mesh, test::pane_mesh(4, 2), {0, 60, 3}, 1);
    test.add_instance(test.add_mesh(std::move(mesh)), Transform(), {test::matte, test::glass});
    test.add(ball, {-50, 0, 3}, test::plastic);
    test.scene.freeze();
    const std::vector<Caster> casters = find_casters(test.scene);
    check_all_held(checks, test.scene, casters);
    checks.near(static_cast<double>(casters.size()), 4, 0, "things that lie apart are casters of their own");
    for (const Caster &caster : casters) {
        checks.that(caster.radius < 2.7f, "a caster is no larger than the thing");
        const bool is_plastic = caster.center.z > 2 && caster.center.x < -40;
        if (is_plastic) checks.near(double{caster.strength}, 0.04, 1e-6, "plastic scatters little of the light");
        if (!is_plastic) checks.that(caster.strength > 0.2f, "glass scatters most of the light");
    }
}

void check_instances(test::Checks &checks) {
    // Ten heaps of turned and stretched things of one mesh, and a large ball of a mesh of its own.
    test::TestScene test;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto anywhere = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    const uint32_t mesh = test.add_mesh(test::joined(test::sphere_mesh(1, 6), test::pane_mesh(3, 1), {2, 1, 0}, 1));
    for (int heap = 0; heap < 10; ++heap) {
        const Vec3 center = anywhere() * 500;
        for (int i = 0; i < 100; ++i) {
            const Transform place{anywhere() * 0.7f, anywhere() * 0.7f, anywhere() * 0.7f, center + anywhere() * 4};
            test.add_instance(mesh, place,
                              {i % 3 == 0 ? test::plastic : test::matte, i % 2 == 0 ? test::glass : test::matte});
        }
    }
    test.add(test::sphere_mesh(30, 40), {900, 0, 0}, test::plastic);
    test.scene.freeze();
    const std::vector<Caster> casters = find_casters(test.scene);
    check_all_held(checks, test.scene, casters);
    checks.that(casters.size() >= 21 && casters.size() <= max_casters, "each heap gets a sphere for each material");
    for (const Caster &caster : casters) checks.that(caster.radius < 36, "no sphere holds two heaps");
}

}  // namespace

int main() {
    test::Checks checks;
    check_ball(checks);
    check_things_apart(checks);
    check_instances(checks);
    return checks.report();
}
