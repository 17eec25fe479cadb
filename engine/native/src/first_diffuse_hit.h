// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene.h"
#include "sequence.h"

namespace photon_maps {

/// Follows a ray of the camera through glossy and transparent surfaces to the first diffuse one.
/// @return whether it met one; `distance` is then the length of the way
bool first_diffuse_hit(const Scene &scene, const Ray &ray, Sequence &sequence, SurfacePoint &hit, float &distance);

}  // namespace photon_maps
