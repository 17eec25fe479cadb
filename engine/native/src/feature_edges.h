// SPDX-License-Identifier: GPL-3.0-or-later
// Edges at which a surface stops or folds: what cuts the disc over which photons are gathered.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "vec.h"

namespace photon_maps {

/// Two faces continue each other across an edge where their in-plane vectors away from it are this opposed (cosine).
constexpr float smooth_edge_cosine = -0.7f;

/// A half-edge of a face. Looking against `normal`, the face lies on the left of the way from a to b.
struct FeatureEdge {
    Vec3 a, b;
    Vec3 normal;           ///< unit normal of the face, by its winding
    bool is_open = false;  ///< no other face shares it: a sheet ends here

    /// Returns the vector in the face's plane that leads from the edge into the face; not normalised.
    Vec3 inward() const { return cross(normal, b - a); }
};

/// Returns the half-edges of faces where the surface stops or folds: those whose edge has no other face that
/// continues theirs smoothly, whatever the winding of either. Vertices at equal positions count as one, since
/// imported meshes split them. Triangles without area are ignored.
/// @param vertices finite positions
/// @param triangles indices below vertices.size(), fewer than 2^32 / 3 triangles
/// @param cancel may be null
/// @throws Cancelled once `cancel` is set
std::vector<FeatureEdge> find_feature_edges(std::span<const Vec3> vertices,
                                            std::span<const std::array<uint32_t, 3>> triangles,
                                            const std::atomic<bool> *cancel = nullptr);

/// Returns a feature edge carried along with its mesh; a mirrored mesh keeps its faces on the left.
FeatureEdge transformed(const FeatureEdge &edge, const Transform &transform);

}  // namespace photon_maps
