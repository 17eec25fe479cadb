// SPDX-License-Identifier: GPL-3.0-or-later
// Which edges end a surface.
#include <numbers>

#include "check.h"
#include "feature_edges.h"

using namespace photon_maps;

namespace {

using Triangle = std::array<uint32_t, 3>;

struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;

    void add_quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
        const auto first = static_cast<uint32_t>(vertices.size());
        vertices.insert(vertices.end(), {a, b, c, d});
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
    std::vector<FeatureEdge> features() const { return find_feature_edges(vertices, triangles); }
};

/// A cube with eight shared corners, or with four of its own for each face.
Mesh cube(bool is_welded) {
    const auto corner = [](size_t i) { return Vec3{i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f}; };
    constexpr std::array<std::array<uint32_t, 4>, 6> faces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    Mesh mesh;
    if (is_welded) {
        for (size_t i = 0; i < 8; ++i) mesh.vertices.push_back(corner(i));
        for (const auto &f : faces) {
            mesh.triangles.push_back({f[0], f[1], f[2]});
            mesh.triangles.push_back({f[0], f[2], f[3]});
        }
    } else {
        for (const auto &f : faces) mesh.add_quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
    }
    return mesh;
}

Mesh sphere(uint32_t rings, uint32_t segments) {
    Mesh mesh;
    const auto point = [&](uint32_t ring, uint32_t segment) {
        if (ring == 0) return Vec3{0, 0, 1};
        if (ring == rings) return Vec3{0, 0, -1};
        const float theta = pi * static_cast<float>(ring) / static_cast<float>(rings);
        const float phi = 2 * pi * static_cast<float>(segment % segments) / static_cast<float>(segments);
        return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    };
    for (uint32_t r = 0; r < rings; ++r) {
        for (uint32_t s = 0; s < segments; ++s) {
            mesh.add_quad(point(r, s), point(r + 1, s), point(r + 1, s + 1), point(r, s + 1));
        }
    }
    return mesh;  // at the poles half of each quad has no area
}

bool has_edge(const std::vector<FeatureEdge> &edges, Vec3 a, Vec3 b) {
    return std::ranges::any_of(edges, [&](const FeatureEdge &e) { return e.a == a && e.b == b; });
}

}  // namespace

int main() {
    test::Checks checks;

    for (const bool is_welded : {true, false}) {
        const Mesh mesh = cube(is_welded);
        const std::vector<FeatureEdge> edges = mesh.features();
        checks.that(edges.size() == 24, "a cube has 24 feature half-edges");
        for (const FeatureEdge &edge : edges) {
            const Vec3 middle = (edge.a + edge.b) / 2;
            checks.near(double{dot(edge.normal, middle)}, 1, 1e-6, "normals point out of the cube");
            checks.that(dot(edge.inward(), edge.normal - middle) > 0, "the face lies on the left");
        }
        // Flipping one face changes neither the edges nor on which side their faces lie.
        Mesh flipped = mesh;
        for (size_t t = 0; t < 2; ++t) std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
        const std::vector<FeatureEdge> flipped_edges = flipped.features();
        checks.that(flipped_edges.size() == 24, "winding does not matter to a cube");
        for (const FeatureEdge &edge : flipped_edges) {
            const Vec3 middle = (edge.a + edge.b) / 2;
            const Vec3 outward = dot(edge.normal, middle) > 0 ? edge.normal : -edge.normal;
            checks.that(dot(edge.inward(), outward - middle) > 0, "the face lies on the left, flipped or not");
        }
    }

    checks.that(sphere(32, 64).features().empty(), "a smooth sphere has none");
    checks.that(sphere(4, 4).features().size() == 16, "a coarse one folds along its eight steepest edges");

    // Open quads: one, two side by side (joined or apart), one folded, one wound the other way.
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, e{2, 0, 0}, f{2, 1, 0};
    Mesh quad;
    quad.add_quad(a, b, c, d);
    const std::vector<FeatureEdge> open = quad.features();
    checks.that(open.size() == 4 && has_edge(open, a, b) && has_edge(open, b, c) && has_edge(open, c, d) &&
                    has_edge(open, d, a),
                "an open quad has its four sides");

    Mesh joined = quad;
    joined.add_quad(b, e, f, c);
    checks.that(joined.features().size() == 6, "coplanar quads continue each other");
    Mesh opposed = quad;
    opposed.add_quad(c, f, e, b);
    checks.that(opposed.features().size() == 6, "whatever their winding");
    Mesh apart = quad;
    apart.add_quad(b + Vec3{1e-3f, 0, 0}, e, f, c + Vec3{1e-3f, 0, 0});
    checks.that(apart.features().size() == 8, "a gap ends both");
    Mesh negative_zero = quad;
    negative_zero.add_quad({-1, -0.0f, -0.0f}, {-0.0f, 0, -0.0f}, {-0.0f, 1, 0}, {-1, 1, 0});
    checks.that(negative_zero.features().size() == 6, "-0 is 0");

    // Folds up to 45 degrees are smooth.
    for (const auto &[degrees, expected] :
         {std::pair{40.0f, 6u}, {50.0f, 8u}, {-40.0f, 6u}, {-50.0f, 8u}, {180.0f, 8u}}) {
        Mesh fold = quad;
        const float angle = degrees * pi / 180;
        const Vec3 step{std::cos(angle), 0, std::sin(angle)};
        fold.add_quad(b, b + step, c + step, c);
        checks.that(fold.features().size() == expected, "a fold of " + std::to_string(degrees) + " degrees");
    }

    // Three faces on an edge: the two that continue each other are smooth, the third ends there.
    Mesh third = joined;
    third.add_quad(b, c, c + Vec3{0, 0, 1}, b + Vec3{0, 0, 1});
    const std::vector<FeatureEdge> third_edges = third.features();
    checks.that(third_edges.size() == 10, "a wall on a floor ends, the floor does not");

    // Triangles without area and meshes without any.
    Mesh degenerate = quad;
    degenerate.triangles.push_back({0, 0, 1});
    degenerate.triangles.push_back({0, 1, 1});
    checks.that(degenerate.features().size() == 4, "triangles without area are ignored");
    checks.that(find_feature_edges({}, {}).empty(), "an empty mesh has none");

    // Far from the origin, and small.
    Mesh far = joined;
    for (Vec3 &v : far.vertices) v = v + Vec3{4096, -8192, 1024};
    checks.that(far.features().size() == 6, "far from the origin");
    Mesh tiny = joined;
    for (Vec3 &v : tiny.vertices) v = v * 1e-6f;
    checks.that(tiny.features().size() == 6, "tiny");

    // Ten thousand copies of one face on the same edges: none of them goes on beyond.
    Mesh fan;
    for (int i = 0; i < 10000; ++i) fan.add_quad(a, b, c, d);
    checks.that(fan.features().size() == 40000, "duplicates do not continue each other");

    // Transforms, mirrored ones included, keep the face on the left.
    const Transform turned{{0, 2, 0}, {-2, 0, 0}, {0, 0, 3}, {5, 6, 7}};
    const Transform mirrored{{-1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {5, 6, 7}};
    for (const Transform &transform : {turned, mirrored}) {
        for (const FeatureEdge &edge : open) {
            const FeatureEdge moved = transformed(edge, transform);
            const Vec3 inside = transform.point({0.5f, 0.5f, 0});
            checks.that(dot(moved.inward(), inside - moved.a) > 0, "a moved face lies on the left");
            checks.near(double{moved.normal.z}, 1, 1e-6, "a moved face keeps its normal");
        }
    }
    return checks.report();
}
