// SPDX-License-Identifier: GPL-3.0-or-later
// The photon map: photons in the order of a balanced kd-tree, found by position.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "photon.h"
#include "simd.h"

namespace photon_maps {

/// Photons as a structure of arrays. Eight may be loaded from any index below the photon count: those after the last
/// one lie at infinity and carry nothing.
struct PhotonArrays {
    std::unique_ptr<float[]> x, y, z;
    std::unique_ptr<float[]> red, green, blue;      ///< flux in W
    std::unique_ptr<uint32_t[]> normal, direction;  ///< as in Photon
};

/// A photon found by PhotonMap::nearest.
struct Neighbor {
    float distance_squared;
    uint32_t index;  ///< into the arrays
};

/// A kd-tree balanced by median splits (Bentley 1975), with photons in leaves and tight boxes around its nodes, eight
/// children a node so that one step tests them all. The tree is a function of the photons alone, not of the threads
/// that built it, and immutable: any number of threads may read it.
class PhotonMap {
  public:
    PhotonMap() = default;

    /// Builds the map from a copy of the photons.
    /// @param photons fewer than 2^32, at finite positions
    /// @param cancel may be null
    /// @throws Cancelled once `cancel` is set; std::length_error for too many photons
    PhotonMap(std::span<const Photon> photons, int threads, const std::atomic<bool> *cancel);

    size_t size() const { return size_; }
    size_t memory_bytes() const;
    const PhotonArrays &photons() const { return photons_; }

    /// Calls visit(begin, end) for runs of indices that together hold every photon within `radius` of `center`, and
    /// others near it; ascending, and the same however the map was built.
    template <typename Visit>
    void visit_range(Vec3 center, float radius, Visit &&visit) const;

    /// Finds the k nearest photons within max_radius (all, if they are fewer), exactly; of photons at the same
    /// distance those of lower index count as nearer.
    /// @param max_radius may be infinite; a good guess saves time
    /// @param neighbors receives them in no particular, but reproducible order
    void nearest(Vec3 p, size_t k, float max_radius, std::vector<Neighbor> &neighbors) const;

  private:
    static constexpr size_t max_leaf_size = 32;
    static constexpr size_t max_levels = 11;  ///< 8^11 > 2^32

    /// The boxes of eight sibling nodes; missing ones lie at infinity.
    struct alignas(32) Boxes {
        std::array<std::array<float, lanes>, 3> low, high;
    };

    void allocate(size_t size);
    void fill_leaf(size_t leaf, std::span<const Photon> photons, std::span<const uint32_t> indices);
    void build_upper_levels();

    /// Leaf i holds the photons [leaf_begin(i), leaf_begin(i + 1)).
    size_t leaf_begin(size_t leaf) const { return size_ * leaf >> depth_; }
    [[gnu::always_inline]] Float8 box_distances_squared(const Boxes &boxes, Vec3 p) const;

    size_t size_ = 0;
    unsigned depth_ = 0;                      ///< 2^depth_ leaves
    std::vector<std::vector<Boxes>> levels_;  ///< leaves first; box i of a level is that of group i one level below
    PhotonArrays photons_;
};

inline Float8 PhotonMap::box_distances_squared(const Boxes &boxes, Vec3 p) const {
    Float8 sum{};
    for (size_t axis = 0; axis < 3; ++axis) {
        const float c = p[static_cast<int>(axis)];
        const Float8 outside = max(load(boxes.low[axis].data()) - c, c - load(boxes.high[axis].data()));
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

    size_t begin = 0, end = 0;
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
            continue;
        }
        // Neighbouring leaves form one run, so that only its end is ragged.
        const size_t leaf_start = leaf_begin(child);
        if (leaf_start != end) {
            if (begin < end) visit(begin, end);
            begin = leaf_start;
        }
        end = leaf_begin(child + 1);
    }
    if (begin < end) visit(begin, end);
}

}  // namespace photon_maps
