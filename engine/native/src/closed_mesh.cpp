// SPDX-License-Identifier: GPL-3.0-or-later
#include "closed_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace photon_maps {

namespace {

/// Gives vertices at equal positions one number.
std::vector<uint32_t> numbers_by_position(std::span<const Vec3> vertices) {
    std::vector<uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t v) { return std::tie(vertices[v].x, vertices[v].y, vertices[v].z); };
    std::ranges::sort(order, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    std::vector<uint32_t> numbers(vertices.size());
    for (size_t i = 0, number = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i - 1]) != key(order[i])) number = i;
        numbers[order[i]] = static_cast<uint32_t>(number);
    }
    return numbers;
}

}  // namespace

bool is_closed(std::span<const Vec3> vertices, std::span<const std::array<uint32_t, 3>> triangles) {
    const std::vector<uint32_t> numbers = numbers_by_position(vertices);
    std::vector<uint64_t> edges;
    edges.reserve(3 * triangles.size());
    for (const auto &triangle : triangles) {
        const std::array corners{numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        for (size_t c = 0; c < 3; ++c) {
            const auto [low, high] = std::minmax(corners[c], corners[(c + 1) % 3]);
            edges.push_back(uint64_t{low} << 32 | high);
        }
    }
    std::ranges::sort(edges);
    for (size_t i = 0; i < edges.size(); i += 2)
        if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
    return true;
}

}  // namespace photon_maps
