// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface.h"

namespace photon_maps {

void add_diffuse(Shading &shading, Vec3 weight, float roughness, Vec3 normal) {
    if (shading.closure_count == max_closures || max_component(weight) <= 0) return;
    shading.closures[shading.closure_count++] = {ClosureType::diffuse, min(weight, {1, 1, 1}), normal, roughness};
}

}  // namespace photon_maps
