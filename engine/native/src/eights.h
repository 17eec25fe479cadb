// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of eight children a node, without pointers: points are put in an order in which each aligned run of 8, 64,
// 512, ... lies close together, so that a node is a run.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simd.h"
#include "vec.h"

namespace photon_maps {

/// A number of each child of a node.
using Eight = std::array<float, lanes>;

/// A node by its place: children of level 0 are the things themselves, child i of level k + 1 is node i of level k.
struct NodePlace {
    uint32_t level, number;

    uint32_t child(size_t lane) const { return number * static_cast<uint32_t>(lanes) + static_cast<uint32_t>(lane); }
};

/// A level of as many nodes or fewer is not gone through from above, but as a whole.
constexpr size_t top_nodes = 16;

/// Returns the numbers of the points, in such an order.
std::vector<uint32_t> order_in_eights(std::span<const Vec3> points);

/// Returns how many nodes hold so many things.
constexpr size_t node_count(size_t things) { return (things + lanes - 1) / lanes; }

}  // namespace photon_maps
