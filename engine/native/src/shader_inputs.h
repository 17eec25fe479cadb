// SPDX-License-Identifier: GPL-3.0-or-later
// What a shader asks of the point it runs at: geometry, object, ray, and values that vary over the mesh.
#pragma once

#include "photon_maps_shader.h"
#include "program.h"
#include "scene.h"

namespace photon_maps {

/// Where a program runs: at a point that a ray met, or for a direction out of the scene.
struct ShaderPoint {
    const Scene &scene;
    const Material &material;
    const SurfacePoint *hit;  ///< null: out of the scene
    Vec3 outgoing;            ///< unit, towards where the ray came from
    const RayState &ray;
};

/// A step along the surface, and what it adds to the barycentric coordinates.
struct SurfaceStep {
    Vec3 offset;
    float du = 0, dv = 0;
};

/// Returns the step that bump mapping takes: number 1 or 2, at right angles; 0 is none. Of a ray's footprint it is a
/// tenth, as Cycles' filter width is; without one, a thousandth of the triangle's size.
SurfaceStep surface_step(const ShaderPoint &point, uint32_t shift);

/// PM_OP_INPUT.
Vec3 input(const ShaderPoint &point, pm_input kind, uint32_t shift);
/// PM_OP_ATTRIBUTE.
Rgba attribute(const ShaderPoint &point, uint32_t id, uint32_t shift);
/// PM_OP_TRANSFORM.
Vec3 transform(const ShaderPoint &point, uint32_t option, Vec3 v);

/// The shading normal on the side that is seen.
inline Vec3 shading_normal(const ShaderPoint &point) { return point.hit ? point.hit->shading_normal : point.outgoing; }
/// A normal in the object's space, unit.
Vec3 to_object_normal(const ShaderPoint &point, Vec3 normal);

/// Values of an attribute at a triangle's corners.
/// @return false if the mesh has none of the id; then the values are 0
bool corner_values(const Mesh &mesh, uint32_t id, uint32_t triangle, std::array<Rgba, 3> &values);

}  // namespace photon_maps
