// SPDX-License-Identifier: GPL-3.0-or-later
#include "photon_map.h"

#include <stdexcept>

#include "parallel.h"
#include "select.h"

namespace photon_maps {

namespace {

/// Returns the coordinate in which photons reach furthest.
float Vec3::*widest_axis(std::span<const Photon> photons) {
    Vec3 low{infinity, infinity, infinity}, high = -low;
    for (const Photon &photon : photons) {
        low = min(low, photon.position);
        high = max(high, photon.position);
    }
    const Vec3 extent = high - low;
    if (extent.z > std::max(extent.x, extent.y)) return &Vec3::z;
    return extent.y > extent.x ? &Vec3::y : &Vec3::x;
}

}  // namespace

PhotonMap::PhotonMap(std::vector<Photon> photons, int threads, const std::atomic<bool> *cancel)
    : size_(photons.size()), photons_(std::move(photons)) {
    if (size_ > std::numeric_limits<uint32_t>::max()) {
        throw std::length_error("a photon map holds fewer than 2^32 photons; emit fewer of them per pass");
    }
    allocate();
    if (size_ == 0) return;

    // 1. The upper nodes, all of one depth at a time: the photons that come first along the widest axis go to the
    // front.
    const auto split_node = [&](unsigned depth, size_t j) {
        const std::span<Photon> photons_of_node = node(depth, j);
        float Vec3::*const axis = widest_axis(photons_of_node);
        const auto before = [axis](const Photon &a, const Photon &b) { return a.position.*axis < b.position.*axis; };
        select(photons_of_node, node(depth + 1, 2 * j).size(), before, cancel);
    };
    constexpr unsigned subtree_depth = 11;
    const unsigned upper_depth = depth_ > subtree_depth ? depth_ - subtree_depth : 0;
    for (unsigned depth = 0; depth < upper_depth; ++depth) {
        parallel_for(threads, size_t{1} << depth, cancel, [&](size_t j) { split_node(depth, j); });
    }

    // 2. Each subtree below, down to its leaves.
    parallel_for(threads, size_t{1} << upper_depth, cancel, [&](size_t root) {
        for (unsigned depth = upper_depth; depth < depth_; ++depth) {
            const unsigned below = depth - upper_depth;
            for (size_t j = root << below; j < (root + 1) << below; ++j) split_node(depth, j);
        }
        const unsigned below = depth_ - upper_depth;
        for (size_t leaf = root << below; leaf < (root + 1) << below; ++leaf) fill_leaf(leaf);
    });
    build_upper_levels();
}

void PhotonMap::allocate() {
    const size_t block_count = (size_ + lanes - 1) / lanes;
    photons_.resize(block_count * lanes, {{infinity, infinity, infinity}, {}, 0, 0});
    while ((block_count >> depth_) + 1 > max_leaf_blocks) ++depth_;
    Boxes missing;
    for (size_t axis = 0; axis < 3; ++axis) {
        missing.low[axis].fill(infinity);
        missing.high[axis].fill(-infinity);
    }
    size_t nodes = size_t{1} << depth_;
    do {
        nodes = (nodes + lanes - 1) / lanes;
        levels_.emplace_back(nodes, missing);
    } while (nodes > 1);
}

/// The photons of node j of a depth, as long as they are a list.
std::span<Photon> PhotonMap::node(unsigned depth, size_t j) {
    const size_t begin = first_block(depth, j) * lanes;
    return std::span(photons_).subspan(begin, std::min(first_block(depth, j + 1) * lanes, size_) - begin);
}

/// Makes blocks of the photons of a leaf, and its box.
void PhotonMap::fill_leaf(size_t leaf) {
    Vec3 low{infinity, infinity, infinity}, high = -low;
    for (const Photon &photon : node(depth_, leaf)) {
        low = min(low, photon.position);
        high = max(high, photon.position);
    }
    Boxes &boxes = levels_[0][leaf / lanes];
    for (size_t axis = 0; axis < 3; ++axis) {
        boxes.low[axis][leaf % lanes] = low[static_cast<int>(axis)];
        boxes.high[axis][leaf % lanes] = high[static_cast<int>(axis)];
    }
    for (size_t b = first_block(depth_, leaf); b < first_block(depth_, leaf + 1); ++b) {
        const std::span<Photon> eight = std::span(photons_).subspan(b * lanes, lanes);
        PhotonBlock block;
        for (size_t lane = 0; lane < lanes; ++lane) block.set(lane, eight[lane]);
        std::memcpy(static_cast<void *>(eight.data()), &block, sizeof block);
    }
}

void PhotonMap::build_upper_levels() {
    for (size_t level = 1; level < levels_.size(); ++level) {
        const std::vector<Boxes> &children = levels_[level - 1];
        for (size_t group = 0; group < children.size(); ++group) {
            Boxes &parent = levels_[level][group / lanes];
            for (size_t axis = 0; axis < 3; ++axis) {
                parent.low[axis][group % lanes] = *std::ranges::min_element(children[group].low[axis]);
                parent.high[axis][group % lanes] = *std::ranges::max_element(children[group].high[axis]);
            }
        }
    }
}

size_t PhotonMap::memory_bytes() const {
    size_t bytes = photons_.capacity() * sizeof(Photon);
    for (const auto &level : levels_) bytes += level.size() * sizeof(Boxes);
    return bytes;
}

namespace {

/// The candidates of one k-nearest search: a buffer that is cut back to the k nearest whenever it is full.
class NearestSearch {
  public:
    NearestSearch(size_t k, float max_radius, std::vector<Neighbor> &buffer)
        : limit_(std::min(max_radius * max_radius, std::numeric_limits<float>::max())), k_(k), buffer_(buffer) {
        buffer_.resize(2 * k + 8 * lanes);
    }

    /// Squared distance beyond which no photon can be among the k nearest.
    float limit() const { return limit_; }

    /// @param first index of the first of eight photons
    [[gnu::always_inline]] void add(const PhotonBlock &photons, size_t first, Vec3 p) {
        const Float8 dx = load(photons.x) - p.x, dy = load(photons.y) - p.y, dz = load(photons.z) - p.z;
        const Float8 distance_squared = dx * dx + dy * dy + dz * dz;
        std::array<float, lanes> distance;
        std::memcpy(distance.data(), &distance_squared, sizeof distance_squared);
        for (uint64_t near = bytes(distance_squared <= limit_); near != 0;) {
            const uint32_t lane = take_first(near);
            buffer_[count_++] = {distance[lane], static_cast<uint32_t>(first + lane)};
        }
        if (count_ + lanes > buffer_.size()) keep_nearest();
    }

    void finish() {
        if (count_ > k_) keep_nearest();
        buffer_.resize(count_);
    }

  private:
    void keep_nearest() {
        const auto nearer = [](const Neighbor &a, const Neighbor &b) {
            return (a.distance_squared < b.distance_squared) |
                   ((a.distance_squared == b.distance_squared) & (a.index < b.index));
        };
        select(std::span(buffer_).first(count_), k_ - 1, nearer);
        count_ = k_;
        limit_ = buffer_[k_ - 1].distance_squared;
    }

    float limit_;
    size_t k_;
    std::vector<Neighbor> &buffer_;
    size_t count_ = 0;
};

}  // namespace

void PhotonMap::nearest(Vec3 p, size_t k, float max_radius, std::vector<Neighbor> &neighbors) const {
    k = std::min(k, size_);
    if (k == 0) {
        neighbors.clear();
        return;
    }
    vectorized([&] {
        // The children of the nodes on the path, nearest first, so that the limit shrinks early.
        struct Child {
            float distance_squared;
            uint32_t lane;
        };
        struct Step {
            size_t group;
            size_t next, count;
            std::array<Child, lanes> children;
        };
        const std::span<const PhotonBlock> all = blocks();
        NearestSearch search(k, max_radius, neighbors);
        std::array<Step, max_levels> path;
        const auto enter = [&](size_t level, size_t group) {
            Step &step = path[level];
            step.group = group;
            step.next = step.count = 0;
            const Float8 distances = box_distances_squared(levels_[level][group], p);
            std::array<float, lanes> distance;
            std::memcpy(distance.data(), &distances, sizeof distances);
            for (uint64_t near = bytes(distances <= search.limit()); near != 0;) {
                const uint32_t lane = take_first(near);
                size_t at = step.count++;
                for (; at > 0 && distance[lane] < step.children[at - 1].distance_squared; --at) {
                    step.children[at] = step.children[at - 1];
                }
                step.children[at] = {distance[lane], lane};
            }
        };

        size_t level = levels_.size() - 1;
        enter(level, 0);
        while (level < levels_.size()) {
            Step &step = path[level];
            if (step.next == step.count || step.children[step.next].distance_squared > search.limit()) {
                ++level;
                continue;
            }
            const size_t child = step.group * lanes + step.children[step.next++].lane;
            if (level > 0) {
                enter(--level, child);
            } else {
                for (size_t b = first_block(depth_, child); b < first_block(depth_, child + 1); ++b)
                    search.add(all[b], b * lanes, p);
            }
        }
        search.finish();
    });
}

}  // namespace photon_maps
