// SPDX-License-Identifier: GPL-3.0-or-later
// The photon map: photons in the order of a balanced kd-tree, found by position.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <new>
#include <span>
#include <vector>

#include "photon.h"
#include "simd.h"

namespace photon_maps {

/// A photon found by PhotonMap::nearest.
struct Neighbor {
    float distance_squared;
    uint32_t index;  ///< lane index % 8 of block index / 8
};

/// A kd-tree balanced by median splits (Bentley 1975), with photons in leaves of whole blocks and tight boxes around
/// its nodes, eight children a node so that one step tests them all. The tree is a function of the photons and their
/// order, not of the threads that built it, and immutable: any number of threads may read it.
class PhotonMap {
  public:
    PhotonMap() = default;

    /// Builds the map in the place of the photons' list, so that they are never there twice.
    /// @param photons fewer than 2^32, at finite positions; room for seven more saves a copy
    /// @param cancel may be null
    /// @throws Cancelled once `cancel` is set; std::length_error for too many photons
    PhotonMap(std::vector<Photon> photons, int threads, const std::atomic<bool> *cancel);

    size_t size() const { return size_; }
    size_t memory_bytes() const;
    /// All photons; those after the last one lie at infinity and carry nothing.
    std::span<const PhotonBlock> blocks() const {
        // The constructor has left blocks in the bytes of the list.
        return {std::launder(reinterpret_cast<const PhotonBlock *>(photons_.data())), photons_.size() / lanes};
    }

    /// Calls visit(block) for blocks that together hold every photon within `radius` of `center`, and others near it;
    /// in their order, and the same however the map was built.
    template <typename Visit>
    void visit_range(Vec3 center, float radius, Visit &&visit) const;

    /// Finds the k nearest photons within max_radius (all, if they are fewer), exactly; of photons at the same
    /// distance those of lower index count as nearer.
    /// @param max_radius may be infinite; a good guess saves time
    /// @param neighbors receives them in no particular, but reproducible order
    void nearest(Vec3 p, size_t k, float max_radius, std::vector<Neighbor> &neighbors) const;

  private:
    static constexpr size_t max_leaf_blocks = 4;
    static constexpr size_t max_levels = 11;  ///< 8^11 > 2^32

    /// The boxes of eight sibling nodes; missing ones lie at infinity.
    struct alignas(32) Boxes {
        std::array<std::array<float, lanes>, 3> low, high;
    };

    void allocate();
    std::span<Photon> node(unsigned depth, size_t j);
    void fill_leaf(size_t leaf);
    void build_upper_levels();

    /// Node j of a depth holds the blocks from first_block(depth, j) to first_block(depth, j + 1).
    size_t first_block(unsigned depth, size_t j) const { return photons_.size() / lanes * j >> depth; }
    std::span<const PhotonBlock> blocks_of_leaf(size_t leaf) const {
        const size_t first = first_block(depth_, leaf);
        return blocks().subspan(first, first_block(depth_, leaf + 1) - first);
    }
    [[gnu::always_inline]] Float8 box_distances_squared(const Boxes &boxes, Vec3 p) const;

    size_t size_ = 0;
    unsigned depth_ = 0;                      ///< 2^depth_ leaves
    std::vector<std::vector<Boxes>> levels_;  ///< leaves first; box i of a level is that of group i one level below
    std::vector<Photon> photons_;             ///< at the end the bytes of whole blocks
};

inline Float8 PhotonMap::box_distances_squared(const Boxes &boxes, Vec3 p) const {
    Float8 sum{};
    for (size_t axis = 0; axis < 3; ++axis) {
        const float c = p[static_cast<int>(axis)];
        const Float8 outside = max(load(boxes.low[axis]) - c, c - load(boxes.high[axis]));
        const Float8 d = max(outside, Float8{});
        sum += d * d;
    }
    return sum;
}

template <typename Visit>
[[gnu::always_inline]] inline void PhotonMap::visit_range(Vec3 center, float radius, Visit &&visit) const {
    if (size_ == 0) return;
    // Missing boxes are infinitely far: stay below that.
    const float radius_squared = std::min(radius * radius, std::numeric_limits<float>::max());
    struct Step {
        size_t group;
        uint64_t near;  ///< children still to be visited, one byte each
    };
    std::array<Step, max_levels> path;
    const auto enter = [&](size_t level, size_t group) {
        path[level] = {group, bytes(box_distances_squared(levels_[level][group], center) <= radius_squared)};
    };

    size_t level = levels_.size() - 1;
    enter(level, 0);
    while (level < levels_.size()) {
        Step &step = path[level];
        if (step.near == 0) {
            ++level;
            continue;
        }
        const size_t child = step.group * lanes + take_first(step.near);
        if (level > 0) {
            enter(--level, child);
        } else {
            for (const PhotonBlock &photons : blocks_of_leaf(child)) visit(photons);
        }
    }
}

}  // namespace photon_maps
