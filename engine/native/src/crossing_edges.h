// SPDX-License-Identifier: GPL-3.0-or-later
// Lines along which surfaces pass through each other: light on the one side of a wall does not cross it on the floor
// that goes on beneath, though neither has an edge there.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "feature_edges.h"
#include "scene.h"

namespace photon_maps {

/// A line segment.
struct Segment {
    Vec3 a, b;
};

/// Returns where two triangles pass through each other, from either side to the other of both; nothing where they only
/// touch, lie in one plane, or have no area (Moller 1997, "A Fast Triangle-Triangle Intersection Test").
std::optional<Segment> crossing(const WorldTriangle &p, const WorldTriangle &q);

/// Finds where triangles of a scene cross under an angle by which photons of one do not count for the other; each
/// segment is an edge of either. It is rays along the triangles' sides that tell which ones meet.
/// @param scene built
/// @param shortest length of what is found; triangles with shorter sides only are left out
/// @param cancel may be null
/// @throws Cancelled once `cancel` is set
std::vector<FeatureEdge> find_crossing_edges(const Scene &scene, float shortest, int threads,
                                             const std::atomic<bool> *cancel);

}  // namespace photon_maps
