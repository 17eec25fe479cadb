// SPDX-License-Identifier: GPL-3.0-or-later
#include "feature_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <tuple>

#include "parallel.h"

namespace photon_maps {

namespace {

constexpr uint32_t none = 0xffffffff;

/// Returns for each vertex the first one at the same position, found by a hash table with open addressing.
std::vector<uint32_t> weld(std::span<const Vec3> vertices) {
    std::vector<uint32_t> table(std::bit_ceil(2 * vertices.size() + 1), none);
    std::vector<uint32_t> first(vertices.size());
    for (uint32_t v = 0; v < vertices.size(); ++v) {
        const Vec3 p = vertices[v] + Vec3{};  // turns -0 into 0
        uint64_t h = std::bit_cast<uint32_t>(p.x) * 0x9e3779b97f4a7c15u;
        h = (h ^ h >> 32 ^ std::bit_cast<uint32_t>(p.y)) * 0xbf58476d1ce4e5b9u;
        h = (h ^ h >> 29 ^ std::bit_cast<uint32_t>(p.z)) * 0x94d049bb133111ebu;
        size_t slot = (h ^ h >> 32) & (table.size() - 1);
        while (table[slot] != none && !(vertices[table[slot]] == p)) slot = (slot + 1) & (table.size() - 1);
        if (table[slot] == none) table[slot] = v;
        first[v] = table[slot];
    }
    return first;
}

/// A triangle's edge from its corner `corner` to the next, by the vertex it shares with others of the same edge.
struct HalfEdge {
    uint32_t other;  ///< the edge's greater vertex; the smaller one is the list this is in
    uint32_t triangle;
    uint32_t corner;
};

/// A triangle with what is needed of it, in double precision since positions may be far from the origin.
struct Face {
    std::array<std::array<double, 3>, 3> corners;

    Face(std::span<const Vec3> vertices, const std::array<uint32_t, 3> &triangle) {
        for (size_t c = 0; c < 3; ++c) {
            const Vec3 p = vertices[triangle[c]];
            corners[c] = {p.x, p.y, p.z};
        }
    }
};

using Double3 = std::array<double, 3>;

Double3 difference(const Double3 &a, const Double3 &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Double3 &a, const Double3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Double3 cross(const Double3 &a, const Double3 &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Double3 normalized(const Double3 &a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// Returns the unit normal of a triangle, or zero if it has no area to speak of.
Double3 face_normal(const Face &face) {
    constexpr double degenerate = 1e-7;  // height over longest side: what rounding of the corners leaves undefined
    const Double3 ab = difference(face.corners[1], face.corners[0]), ac = difference(face.corners[2], face.corners[0]);
    const Double3 bc = difference(face.corners[2], face.corners[1]), n = cross(ab, ac);
    const double longest_squared = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
    if (!(std::sqrt(dot(n, n)) > degenerate * longest_squared)) return {};
    return normalized(n);
}

/// Returns the unit vector in a triangle's plane that leads from its edge `corner` inwards.
Double3 inward(const Face &face, const Double3 &normal, uint32_t corner) {
    return normalized(cross(normal, difference(face.corners[(corner + 1) % 3], face.corners[corner])));
}

/// Marks those of the faces around one edge that none of the others continues. What matters of a face is the angle
/// at which it leaves the edge; sorted, so that even thousands of faces on one edge take no time.
void mark_features(std::span<const Double3> inwards, const Double3 &along, std::vector<bool> &is_feature) {
    is_feature.assign(inwards.size(), true);
    if (inwards.size() < 2) return;
    const Double3 x = inwards[0], y = cross(along, x);
    const auto angle = [&](const Double3 &t) { return std::atan2(dot(t, y), dot(t, x)); };
    std::vector<double> angles(inwards.size());
    std::ranges::transform(inwards, angles.begin(), angle);
    std::ranges::sort(angles);
    const double tolerance = std::acos(-static_cast<double>(smooth_edge_cosine));
    for (size_t f = 0; f < inwards.size(); ++f) {
        for (const double turn : {-std::numbers::pi, std::numbers::pi}) {
            const double opposite = angle(inwards[f]) + turn;
            const auto next = std::ranges::lower_bound(angles, opposite - tolerance);
            if (next != angles.end() && *next <= opposite + tolerance) is_feature[f] = false;
        }
    }
}

}  // namespace

std::vector<FeatureEdge> find_feature_edges(std::span<const Vec3> vertices,
                                            std::span<const std::array<uint32_t, 3>> triangles,
                                            const std::atomic<bool> *cancel) {
    const std::vector<uint32_t> welded = weld(vertices);

    throw_if_cancelled(cancel);

    // 1. Normals; zero for triangles to ignore.
    std::vector<Double3> normals(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) normals[t] = face_normal(Face(vertices, triangles[t]));
    const auto is_degenerate = [&](size_t t) { return dot(normals[t], normals[t]) == 0; };

    throw_if_cancelled(cancel);

    // 2. Half-edges, listed by their edge's smaller vertex.
    const auto visit_half_edges = [&](const auto &visit) {
        for (uint32_t t = 0; t < triangles.size(); ++t) {
            if (is_degenerate(t)) continue;
            for (uint32_t corner = 0; corner < 3; ++corner) {
                const uint32_t a = welded[triangles[t][corner]], b = welded[triangles[t][(corner + 1) % 3]];
                visit(std::min(a, b), HalfEdge{std::max(a, b), t, corner});
            }
        }
    };
    std::vector<uint32_t> ends(vertices.size() + 1, 0);
    visit_half_edges([&](uint32_t vertex, const HalfEdge &) { ++ends[vertex + 1]; });
    for (size_t v = 0; v < vertices.size(); ++v) ends[v + 1] += ends[v];
    std::vector<HalfEdge> half_edges(ends.back());
    // Filling moves each list's start to its end, which is where the next one starts.
    visit_half_edges([&](uint32_t vertex, const HalfEdge &edge) { half_edges[ends[vertex]++] = edge; });

    // 3. Edge by edge: the half-edges with both vertices in common.
    std::vector<FeatureEdge> features;
    std::vector<Double3> inwards;
    std::vector<bool> is_feature;
    uint32_t list_begin = 0;
    for (size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        if (vertex % 4096 == 0) throw_if_cancelled(cancel);
        const std::span list(half_edges.begin() + list_begin, half_edges.begin() + ends[vertex]);
        list_begin = ends[vertex];
        std::ranges::sort(list, [](const HalfEdge &a, const HalfEdge &b) {
            return std::tie(a.other, a.triangle, a.corner) < std::tie(b.other, b.triangle, b.corner);
        });
        for (size_t begin = 0, end; begin < list.size(); begin = end) {
            for (end = begin + 1; end < list.size() && list[end].other == list[begin].other;) ++end;
            const std::span around = list.subspan(begin, end - begin);
            inwards.clear();
            for (const HalfEdge &h : around) {
                inwards.push_back(inward(Face(vertices, triangles[h.triangle]), normals[h.triangle], h.corner));
            }
            const Face face(vertices, triangles[around[0].triangle]);
            const uint32_t corner = around[0].corner;
            const Double3 along = normalized(difference(face.corners[(corner + 1) % 3], face.corners[corner]));
            mark_features(inwards, along, is_feature);
            for (size_t f = 0; f < around.size(); ++f) {
                if (!is_feature[f]) continue;
                const HalfEdge &h = around[f];
                const auto &triangle = triangles[h.triangle];
                const Double3 &n = normals[h.triangle];
                features.push_back({vertices[triangle[h.corner]],
                                    vertices[triangle[(h.corner + 1) % 3]],
                                    {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])},
                                    around.size() == 1});
            }
        }
    }
    return features;
}

FeatureEdge transformed(const FeatureEdge &edge, const Transform &transform) {
    const Vec3 a = transform.point(edge.a), b = transform.point(edge.b);
    const Vec3 normal = normalize(transform.normal(edge.normal));
    return transform.determinant() < 0 ? FeatureEdge{b, a, normal, edge.is_open}
                                       : FeatureEdge{a, b, normal, edge.is_open};
}

}  // namespace photon_maps
