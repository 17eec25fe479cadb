// SPDX-License-Identifier: GPL-3.0-or-later
// Textures that are computed.
#pragma once

#include "photon_maps_shader.h"
#include "vec.h"

namespace photon_maps {

/// PM_OP_CHECKER: whether a point, in units of the checks, lies in one of the first colour.
bool is_first_check(Vec3 p);

/// PM_OP_GRADIENT: 0 to 1.
float gradient(pm_gradient type, Vec3 p);

}  // namespace photon_maps
