// SPDX-License-Identifier: GPL-3.0-or-later
#include "photon_map.h"

#include <stdexcept>

#include "parallel.h"
#include "select.h"

namespace photon_maps {

namespace {

/// A photon while the tree is built.
struct Item {
    std::array<float, 3> position;
    uint32_t index;
};

/// Returns the axis along which the items reach furthest.
size_t widest_axis(std::span<const Item> items) {
    using Float4 = float __attribute__((vector_size(16)));
    static_assert(sizeof(Item) == sizeof(Float4));
    Float4 low{infinity, infinity, infinity, infinity}, high = -low;
    for (const Item &item : items) {
        const auto position = std::bit_cast<Float4>(item);  // and an index in the lane that is not read
        low = position < low ? position : low;
        high = position > high ? position : high;
    }
    const Float4 extent = high - low;
    const size_t xy = extent[1] > extent[0] ? 1 : 0;
    return extent[2] > extent[xy] ? 2 : xy;
}

/// Moves the `middle` items that come first along the widest axis to the front; at one position the index decides.
void split(std::span<Item> items, size_t middle, const std::atomic<bool> *cancel) {
    const size_t axis = widest_axis(items);
    const auto before = [axis](const Item &a, const Item &b) {
        const float x = a.position[axis], y = b.position[axis];
        return (x < y) | ((x == y) & (a.index < b.index));
    };
    select(items, middle, before, cancel);
}

}  // namespace

PhotonMap::PhotonMap(std::span<const Photon> photons, int threads, const std::atomic<bool> *cancel) {
    if (photons.size() > std::numeric_limits<uint32_t>::max()) {
        throw std::length_error("a photon map holds fewer than 2^32 photons; emit fewer of them per pass");
    }
    allocate(photons.size());
    if (photons.empty()) return;

    // 1. What the tree is built from: positions and indices.
    constexpr size_t block = 1 << 16;
    const auto items = std::make_unique_for_overwrite<Item[]>(size_);
    parallel_for(threads, (size_ + block - 1) / block, cancel, [&](size_t b) {
        for (size_t i = b * block; i < std::min((b + 1) * block, size_); ++i) {
            const Vec3 p = photons[i].position;
            items[i] = {{p.x, p.y, p.z}, static_cast<uint32_t>(i)};
        }
    });

    // 2. The upper nodes, all of one depth at a time. Node j of depth d holds the photons [n j / 2^d, n (j + 1) / 2^d).
    const auto node = [&](unsigned depth, size_t j) {
        const size_t begin = size_ * j >> depth;
        return std::span(items.get() + begin, (size_ * (j + 1) >> depth) - begin);
    };
    const auto split_node = [&](unsigned depth, size_t j) {
        split(node(depth, j), node(depth + 1, 2 * j).size(), cancel);
    };
    constexpr unsigned subtree_depth = 11;
    const unsigned upper_depth = depth_ > subtree_depth ? depth_ - subtree_depth : 0;
    for (unsigned depth = 0; depth < upper_depth; ++depth) {
        parallel_for(threads, size_t{1} << depth, cancel, [&](size_t j) { split_node(depth, j); });
    }

    // 3. Each subtree below, down to its leaves.
    parallel_for(threads, size_t{1} << upper_depth, cancel, [&](size_t root) {
        for (unsigned depth = upper_depth; depth < depth_; ++depth) {
            const unsigned below = depth - upper_depth;
            for (size_t j = root << below; j < (root + 1) << below; ++j) split_node(depth, j);
        }
        const unsigned below = depth_ - upper_depth;
        for (size_t leaf = root << below; leaf < (root + 1) << below; ++leaf) {
            const std::span<const Item> order = node(depth_, leaf);
            std::array<uint32_t, max_leaf_size> indices;
            std::ranges::transform(order, indices.begin(), &Item::index);
            fill_leaf(leaf, photons, std::span(indices).first(order.size()));
        }
    });
    build_upper_levels();
}

void PhotonMap::allocate(size_t size) {
    size_ = size;
    while ((size_ >> depth_) + 1 > max_leaf_size) ++depth_;
    const auto add_padded = [this]<typename T>(std::unique_ptr<T[]> &array, T padding) {
        array = std::make_unique_for_overwrite<T[]>(size_ + lanes);
        std::fill_n(array.get() + size_, lanes, padding);
    };
    for (const auto axis : {&PhotonArrays::x, &PhotonArrays::y, &PhotonArrays::z}) add_padded(photons_.*axis, infinity);
    for (const auto channel : {&PhotonArrays::red, &PhotonArrays::green, &PhotonArrays::blue}) {
        add_padded(photons_.*channel, 0.0f);
    }
    for (const auto packed : {&PhotonArrays::normal, &PhotonArrays::direction}) add_padded(photons_.*packed, 0u);

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

void PhotonMap::fill_leaf(size_t leaf, std::span<const Photon> photons, std::span<const uint32_t> indices) {
    Vec3 low{infinity, infinity, infinity}, high = -low;
    size_t i = leaf_begin(leaf);
    for (const uint32_t index : indices) {
        const Photon &photon = photons[index];
        low = min(low, photon.position);
        high = max(high, photon.position);
        photons_.x[i] = photon.position.x;
        photons_.y[i] = photon.position.y;
        photons_.z[i] = photon.position.z;
        photons_.red[i] = photon.flux.x;
        photons_.green[i] = photon.flux.y;
        photons_.blue[i] = photon.flux.z;
        photons_.normal[i] = photon.normal;
        photons_.direction[i] = photon.direction;
        ++i;
    }
    Boxes &boxes = levels_[0][leaf / lanes];
    for (size_t axis = 0; axis < 3; ++axis) {
        boxes.low[axis][leaf % lanes] = low[static_cast<int>(axis)];
        boxes.high[axis][leaf % lanes] = high[static_cast<int>(axis)];
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
    size_t bytes = size_ == 0 ? 0 : (size_ + lanes) * sizeof(Photon);
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

    [[gnu::always_inline]] void add_leaf(const PhotonArrays &photons, Vec3 p, size_t begin, size_t end) {
        for (size_t i = begin; i < end; i += lanes) {
            const Float8 dx = load(&photons.x[i]) - p.x;
            const Float8 dy = load(&photons.y[i]) - p.y;
            const Float8 dz = load(&photons.z[i]) - p.z;
            const Float8 distance_squared = dx * dx + dy * dy + dz * dz;
            std::array<float, lanes> distance;
            std::memcpy(distance.data(), &distance_squared, sizeof distance_squared);
            for (uint64_t near = bytes((distance_squared <= limit_) & first_lanes(end - i)); near != 0;) {
                const uint32_t lane = take_first(near);
                buffer_[count_++] = {distance[lane], static_cast<uint32_t>(i + lane)};
            }
            if (count_ + lanes > buffer_.size()) keep_nearest();
        }
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
                search.add_leaf(photons_, p, leaf_begin(child), leaf_begin(child + 1));
            }
        }
        search.finish();
    });
}

}  // namespace photon_maps
