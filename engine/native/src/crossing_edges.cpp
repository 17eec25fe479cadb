// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossing_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kernel_area.h"
#include "parallel.h"

namespace photon_maps {

namespace {

struct Double3 {
    double x, y, z;
};
Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Double3 cross(Double3 a, Double3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Double3 a) { return std::sqrt(dot(a, a)); }
Double3 precise(Vec3 v) { return {v.x, v.y, v.z}; }

using Corners = std::array<Double3, 3>;
Corners corners_of(const WorldTriangle &t) { return {precise(t.a), precise(t.b), precise(t.c)}; }

Double3 face(const Corners &t) { return cross(t[1] - t[0], t[2] - t[0]); }

/// A stretch of the line in which two planes meet, by its coordinate along it.
struct Interval {
    double from, to;
    Double3 start, end;
};

/// Returns where a triangle passes through a plane; nothing if it does not come to both sides of it.
/// @param tolerance distance within which a corner lies in the plane
std::optional<Interval> cut(const Corners &t, Double3 origin, Double3 unit_normal, Double3 along, double tolerance) {
    std::array<double, 3> height;
    for (size_t i = 0; i < 3; ++i) height[i] = dot(t[i] - origin, unit_normal);
    const auto [low, high] = std::ranges::minmax(height);
    if (!(low < -tolerance && high > tolerance)) return {};
    std::array<Double3, 2> ends{};
    size_t count = 0;
    for (size_t i = 0; i < 3 && count < 2; ++i) {
        const size_t j = (i + 1) % 3;
        if ((height[i] > 0) == (height[j] > 0)) continue;
        const double s = height[i] / (height[i] - height[j]);
        const Double3 d = t[j] - t[i];
        ends[count++] = {t[i].x + s * d.x, t[i].y + s * d.y, t[i].z + s * d.z};
    }
    Interval found{dot(ends[0] - origin, along), dot(ends[1] - origin, along), ends[0], ends[1]};
    if (found.from > found.to) {
        std::swap(found.from, found.to);
        std::swap(found.start, found.end);
    }
    return found;
}

Vec3 rounded(Double3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

float longest_side(const WorldTriangle &t) {
    return std::sqrt(std::max({length_squared(t.b - t.a), length_squared(t.c - t.b), length_squared(t.a - t.c)}));
}

/// A triangle of the scene.
struct Place {
    uint32_t instance, triangle;
    auto operator<=>(const Place &) const = default;
};
using Pair = std::pair<Place, Place>;

/// Appends the triangles that a triangle's sides meet between their ends.
void add_met(const Scene &scene, Place place, float shortest, std::vector<Pair> &pairs) {
    constexpr int most_hits = 64;  // in planes that sides lie in rays may meet one triangle again and again
    constexpr float end = 1e-5f;   // of a side: what meets it there is its neighbour
    const WorldTriangle t = scene.world_triangle(place.instance, place.triangle);
    if (longest_side(t) < shortest) return;
    for (const auto &[a, b] : {std::pair{t.a, t.b}, std::pair{t.b, t.c}, std::pair{t.c, t.a}}) {
        Ray side{a, b - a};
        side.near = end;
        side.far = 1 - end;
        SurfacePoint hit;
        for (int hits = 0; hits < most_hits && side.near < side.far && scene.intersect(side, hit); ++hits) {
            const Place met{hit.instance, hit.triangle};
            if (met != place) pairs.push_back(std::minmax(place, met));
            side.near = std::max(hit.distance, side.near) + end;
        }
    }
}

}  // namespace

std::optional<Segment> crossing(const WorldTriangle &p, const WorldTriangle &q) {
    const Corners first = corners_of(p), second = corners_of(q);
    const Double3 n = face(first), m = face(second), line = cross(n, m);
    const double n_length = length(n), m_length = length(m), line_length = length(line);
    constexpr double parallel = 1e-3;  // sine
    if (!(line_length > parallel * n_length * m_length)) return {};
    const Double3 along{line.x / line_length, line.y / line_length, line.z / line_length};
    const Double3 unit_n{n.x / n_length, n.y / n_length, n.z / n_length};
    const Double3 unit_m{m.x / m_length, m.y / m_length, m.z / m_length};

    // Where both reach through the other's plane, the line of the planes passes through both.
    constexpr double rounding = 4e-7;
    double extent = 0;
    for (const Vec3 v : {p.a, p.b, p.c, q.a, q.b, q.c}) extent = std::max(extent, double{max_component(abs(v))});
    const auto of_first = cut(first, second[0], unit_m, along, rounding * extent);
    const auto of_second = cut(second, first[0], unit_n, along, rounding * extent);
    if (!of_first || !of_second) return {};
    // Coordinates along the line count from different corners.
    const double shift = dot(first[0] - second[0], along);
    const double from = of_second->from + shift, to = of_second->to + shift;
    if (!(std::min(of_first->to, to) > std::max(of_first->from, from))) return {};
    return Segment{rounded(of_first->from > from ? of_first->start : of_second->start),
                   rounded(of_first->to < to ? of_first->end : of_second->end)};
}

std::vector<FeatureEdge> find_crossing_edges(const Scene &scene, float shortest, int threads,
                                             const std::atomic<bool> *cancel) {
    // 1. Which triangles meet, from each one's sides; a crossing ends where a side of either meets the other.
    constexpr size_t chunk_size = 4096;
    std::vector<Place> chunks;  // the first triangle of each
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
        for (size_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); t += chunk_size)
            chunks.push_back({i, static_cast<uint32_t>(t)});
    std::vector<std::vector<Pair>> met(chunks.size());
    parallel_for(threads, chunks.size(), cancel, [&](size_t c) {
        const auto [instance, first] = chunks[c];
        const size_t count = scene.meshes[scene.instances[instance].mesh].triangles.size();
        for (size_t t = first; t < std::min(count, first + chunk_size); ++t)
            add_met(scene, {instance, static_cast<uint32_t>(t)}, shortest, met[c]);
    });
    std::vector<Pair> pairs;
    for (const std::vector<Pair> &some : met) pairs.insert(pairs.end(), some.begin(), some.end());
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());

    // 2. Where they cross, an edge of each.
    std::vector<FeatureEdge> edges;
    for (const auto &[p, q] : pairs) {
        const WorldTriangle first = scene.world_triangle(p.instance, p.triangle);
        const WorldTriangle second = scene.world_triangle(q.instance, q.triangle);
        const std::optional<Segment> found = crossing(first, second);
        if (!found || length(found->b - found->a) < shortest) continue;
        const Vec3 n = normalize(cross(first.b - first.a, first.c - first.a));
        const Vec3 m = normalize(cross(second.b - second.a, second.c - second.a));
        if (std::abs(dot(n, m)) > normal_tolerance) continue;
        edges.push_back({found->a, found->b, n});
        edges.push_back({found->a, found->b, m});
    }
    return edges;
}

}  // namespace photon_maps
