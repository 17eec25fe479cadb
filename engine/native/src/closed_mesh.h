// SPDX-License-Identifier: GPL-3.0-or-later
// Whether triangles enclose a body.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vec.h"

namespace photon_maps {

/// Returns whether every edge is one of an even number of triangles: there is an inside then, which paths leave as
/// often as they enter it. Vertices at equal positions count as one; triangles that have two of them are ignored.
/// @param triangles indices below vertices.size()
bool is_closed(std::span<const Vec3> vertices, std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace photon_maps
