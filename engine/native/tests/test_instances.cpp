// SPDX-License-Identifier: GPL-3.0-or-later
// Rays meet a mesh where its instances show it, on the side that they show, whether it is shared or has one use.
#include <string>
#include <utility>
#include <vector>

#include "check.h"
#include "emission_scenes.h"

using namespace photon_maps;

namespace {

constexpr std::array<Vec3, 3> corners{{{0.2f, -0.3f, 0.1f}, {1.1f, 0.2f, -0.4f}, {-0.1f, 0.9f, 0.5f}}};
const Vec3 outwards = cross(corners[1] - corners[0], corners[2] - corners[0]);

/// Turned, stretched and sheared; mirrored; neither. Far from each other.
const std::vector<std::pair<std::string, Transform>> places{
    {"sheared", {{0.3f, 1.2f, 0.1f}, {-0.8f, 0.4f, 0.5f}, {0.2f, -0.3f, 1.5f}, {4, 5, 6}}},
    {"mirrored", {{-0.9f, 0.2f, 0.3f}, {0.1f, 1.1f, -0.4f}, {0.5f, 0.2f, 0.8f}, {-7, 2, -3}}},
    {"as it is", {}},
};

Mesh triangle() {
    Mesh mesh;
    mesh.vertices.assign(corners.begin(), corners.end());
    mesh.vertices.emplace_back();
    mesh.triangles = {{0, 1, 2}};
    mesh.slot_count = 1;
    return mesh;
}

void check_hits(test::Checks &checks, const std::string &name, const Scene &scene) {
    constexpr float u = 0.3f, v = 0.5f;
    for (uint32_t i = 0; i < places.size(); ++i) {
        const auto &[place_name, place] = places[i];
        const std::string what = name + ", " + place_name + ": ";
        const Vec3 point = place.point(corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v);
        const Vec3 out = place.vector(outwards);  // not the normal, but on its side
        for (const float side : {1.0f, -1.0f}) {
            SurfacePoint hit;
            checks.that(scene.intersect({point + out * side, out * -side}, hit), what + "it is met");
            checks.that(hit.instance == i, what + "the instance");
            checks.that(length(hit.position - point) < 1e-5f, what + "the place");
            checks.near(double{hit.distance}, 1, 1e-5, what + "the distance");
            checks.that(hit.is_backfacing == (side < 0), what + "the side");
            checks.that(dot(hit.normal, out) * side > 0, what + "the normal is on the ray's side");
            for (size_t edge = 1; edge < 3; ++edge) {
                const Vec3 along = normalize(place.vector(corners[edge] - corners[0]));
                checks.near(double{dot(hit.normal, along)}, 0, 1e-5, what + "the normal is across the triangle");
            }
        }
    }
}

}  // namespace

int main() {
    test::Checks checks;
    for (const bool is_shared : {false, true}) {
        test::TestScene test;
        const uint32_t shared = test.add_mesh(triangle());
        for (size_t i = 0; i < places.size(); ++i)
            test.add_instance(is_shared || i == 0 ? shared : test.add_mesh(triangle()), places[i].second,
                              {test::matte});
        test.scene.freeze();
        test.scene.build(1, nullptr);
        check_hits(checks, is_shared ? "shared" : "of one use", test.scene);
    }
    return checks.report();
}
