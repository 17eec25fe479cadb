// SPDX-License-Identifier: GPL-3.0-or-later
#include "edge_index.h"

#include <bit>
#include <stdexcept>

namespace photon_maps {

namespace {

/// More entries than this are not worth their memory (4 bytes each): larger cells are.
constexpr double max_entries = 4e6;
constexpr size_t max_buckets = size_t{1} << 24;

}  // namespace

/// Calls visit(edge, bucket) for the cells within max_radius of each edge, edges in ascending order. An edge is taken
/// in pieces no longer than a cell: a long diagonal passes few of the cells that its box holds.
template <typename Visit>
void EdgeIndex::visit_cells(Visit visit) const {
    const double reach = max_radius_ * 1.0001;  // more than what rounding takes away
    for (uint32_t i = 0; i < edges_.size(); ++i) {
        const Vec3 a = edges_[i].a, b = edges_[i].b;
        const size_t pieces = piece_count(edges_[i]);
        for (size_t piece = 0; piece < pieces; ++piece) {
            std::array<int64_t, 3> first, last;
            for (int axis = 0; axis < 3; ++axis) {
                const double origin = a[axis], step = (double{b[axis]} - origin) / static_cast<double>(pieces);
                const double from = origin + step * static_cast<double>(piece), to = from + step;
                first[static_cast<size_t>(axis)] = cell_of(std::min(from, to) - reach);
                last[static_cast<size_t>(axis)] = cell_of(std::max(from, to) + reach);
            }
            for (int64_t z = first[2]; z <= last[2]; ++z) {
                for (int64_t y = first[1]; y <= last[1]; ++y) {
                    for (int64_t x = first[0]; x <= last[0]; ++x) visit(i, bucket_of(x, y, z));
                }
            }
        }
    }
}

size_t EdgeIndex::piece_count(const FeatureEdge &edge) const {
    return 1 + static_cast<size_t>(length(edge.b - edge.a) * inverse_cell_);
}

EdgeIndex::EdgeIndex(std::vector<FeatureEdge> edges, float max_radius)
    : edges_(std::move(edges)), max_radius_(max_radius) {
    if (!(max_radius > 0)) throw std::invalid_argument("the largest kernel radius must be positive");
    if (edges_.empty()) return;

    // 1. The cell: the radius, or more where edges would pass too many.
    double extent = 0;
    for (const FeatureEdge &edge : edges_) {
        extent = std::max({extent, double{max_component(abs(edge.a))}, double{max_component(abs(edge.b))}});
    }
    const auto entries = [&](double cell) {
        double pieces = 0;
        for (const FeatureEdge &edge : edges_) pieces += 1 + length(edge.b - edge.a) / cell;
        const double reach = 2 * double{max_radius} / cell;  // a piece and what is near it, in cells along and across
        return pieces * (2 + reach) * (1 + reach) * (1 + reach);
    };
    constexpr double bearable_entries = 24;  // of an edge
    double cell = double{max_radius};
    while (entries(cell) > std::max(max_entries, bearable_entries * static_cast<double>(edges_.size()))) cell *= 2;
    // Cell numbers fit into 64 bits.
    cell = std::max(cell, (extent + max_radius) * 1e-15);
    inverse_cell_ = 1 / cell;

    // 2. Count and fill, both in the order of edges. Pieces and cells of an edge may meet in a bucket: once is enough.
    const size_t buckets = std::min(max_buckets, std::bit_ceil(static_cast<size_t>(entries(cell))));
    starts_.assign(buckets + 1, 0);
    constexpr uint32_t none = 0xffffffff;
    std::vector<uint32_t> latest(buckets, none);
    visit_cells([&](uint32_t edge, size_t bucket) {
        if (latest[bucket] != edge) ++starts_[bucket + 1];
        latest[bucket] = edge;
    });
    for (size_t b = 0; b < buckets; ++b) starts_[b + 1] += starts_[b];
    entries_.resize(starts_.back());
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    std::ranges::fill(latest, none);
    visit_cells([&](uint32_t edge, size_t bucket) {
        if (latest[bucket] != edge) entries_[next[bucket]++] = edge;
        latest[bucket] = edge;
    });
}

double EdgeIndex::crowding() const {
    double squares = 0;
    for (size_t bucket = 0; bucket + 1 < starts_.size(); ++bucket) {
        const double size = starts_[bucket + 1] - starts_[bucket];
        squares += size * size;
    }
    return entries_.empty() ? 0 : squares / static_cast<double>(entries_.size());
}

size_t EdgeIndex::memory_bytes() const {
    return edges_.size() * sizeof(FeatureEdge) + (starts_.size() + entries_.size()) * sizeof(uint32_t);
}

}  // namespace photon_maps
