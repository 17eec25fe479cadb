// SPDX-License-Identifier: GPL-3.0-or-later
// Where triangles pass through each other.
#include "check.h"
#include "crossing_edges.h"

using namespace photon_maps;

namespace {

/// Whether a segment joins two points, in either order.
bool joins(const std::optional<Segment> &found, Vec3 a, Vec3 b) {
    constexpr float near = 1e-5f;
    if (!found) return false;
    const auto is = [&](Vec3 p, Vec3 q) { return length(p - q) < near; };
    return (is(found->a, a) && is(found->b, b)) || (is(found->a, b) && is(found->b, a));
}

const WorldTriangle floor_triangle{{-4, -4, 0}, {4, -4, 0}, {0, 8, 0}};

void check_crossings(test::Checks &checks) {
    const WorldTriangle wall{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    checks.that(joins(crossing(floor_triangle, wall), {-0.5f, 0, 0}, {0.5f, 0, 0}), "a wall through a floor");
    checks.that(joins(crossing(wall, floor_triangle), {-0.5f, 0, 0}, {0.5f, 0, 0}), "the same the other way round");

    // Its far end lies beyond the floor: the line ends where the floor does, at x = 4 - y / 3 on its right side.
    const WorldTriangle wide{{0, -4, -1}, {20, -4, -1}, {10, -4, 9}};
    const WorldTriangle through{{0, -1, -1}, {20, -1, -1}, {10, -1, 9}};
    checks.that(joins(crossing(floor_triangle, through), {1, -1, 0}, {3, -1, 0}), "as far as the floor goes");
    checks.that(!crossing(floor_triangle, wide), "what meets its edge alone does not cross it");

    const Vec3 far{1e5f, -1e5f, 0};
    const auto moved = [&](const WorldTriangle &t) { return WorldTriangle{t.a + far, t.b + far, t.c + far}; };
    checks.that(joins(crossing(moved(floor_triangle), moved(wall)), far + Vec3{-0.5f, 0, 0}, far + Vec3{0.5f, 0, 0}),
                "far from the origin");
}

void check_others(test::Checks &checks) {
    checks.that(!crossing(floor_triangle, {{-1, 0, 0}, {1, 0, 0}, {0, 0, 1}}), "a wall that stands on the floor");
    checks.that(!crossing(floor_triangle, {{-1, 0, 1e-7f}, {1, 0, 1e-7f}, {0, 0, 1}}), "or nearly");
    checks.that(!crossing(floor_triangle, {{-1, 0, 0.1f}, {1, 0, 0.1f}, {0, 0, 1}}), "one above it");
    checks.that(!crossing(floor_triangle, {{9, 0, -1}, {11, 0, -1}, {10, 0, 1}}), "one beside it");
    checks.that(!crossing(floor_triangle, {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "one in its plane");
    checks.that(!crossing(floor_triangle, floor_triangle), "itself");
    checks.that(!crossing(floor_triangle, {{0, 0, -1}, {0, 0, 1}, {0, 0, 2}}), "one without area");
}

}  // namespace

int main() {
    test::Checks checks;
    check_crossings(checks);
    check_others(checks);
    return checks.report();
}
