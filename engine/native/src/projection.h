// SPDX-License-Identifier: GPL-3.0-or-later
// How a vector finds its place in an image, as Blender's Image and Environment Texture have it.
#pragma once

#include "photon_maps.h"
#include "vec.h"

namespace photon_maps {

/// A place in an image that fills the unit square.
struct Place2 {
    float u, v;
};

/// The place of a vector by any projection but box.
Place2 project(pm_projection projection, Vec3 position);

/// Box projection: how much of an image from each axis a surface with this normal shows; they add up to 1.
/// @param normal unit, in the object's space
/// @param blend 0 to 1: how wide neighbouring sides overlap
Vec3 box_weights(Vec3 normal, float blend);
/// Box projection: the place as seen along an axis, from the side that the normal points to.
Place2 project_on_side(Vec3 position, Vec3 normal, int axis);

}  // namespace photon_maps
