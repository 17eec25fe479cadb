// SPDX-License-Identifier: GPL-3.0-or-later
// A material's shader as a flat program over registers of three floats (photon_maps_shader.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "closure.h"
#include "photon_maps.h"

namespace photon_maps {

class Scene;
struct SurfacePoint;

/// How a ray came to a point: what Light Path and ray visibility know.
struct RayState {
    uint32_t kinds = 0;  ///< bits 1 << pm_ray
    bool is_singular = false, is_reflection = false;
    float length = 0;     ///< in scene units
    float footprint = 0;  ///< width of what the ray stands for at the point, in scene units: steps of bump mapping
    uint16_t depth = 0, diffuse_depth = 0, glossy_depth = 0, transmission_depth = 0, transparent_depth = 0;
};

/// The program itself, checked by validate().
struct Program {
    std::vector<Vec3> constants;
    std::vector<pm_instruction> instructions;
    std::vector<uint32_t> arguments;
    uint32_t register_count = 0;
};

/// What can be said of a material without a point.
struct MaterialTraits {
    bool emits = false;           ///< may emit
    bool is_transparent = false;  ///< may let light straight through, or be a hole
    bool may_scatter = true;
    Lobes lobes = 0;              ///< that it may have; glossy_reflection stands for rough ones, too
    float specular = 0;           ///< about which share of light its glossy lobes scatter, 0 to 1
    bool is_constant = false;     ///< emission and transparency are the same at all points and for all rays
    bool is_reciprocal = true;    ///< scatters as much from one direction to another as from that to the first
    bool depends_on_ray = false;  ///< asks how rays came that are not the camera's
};

struct Material {
    Program program;
    Program transparency;  ///< what of it shadow rays need; made by prepare()
    uint32_t index = 0;    ///< Blender's pass index
    MaterialTraits traits;
    std::optional<Shading> prototype;  ///< what shade() makes of any point but for its normals, where that is all

    bool emits() const { return traits.emits; }
};

/// Folds what is constant, drops what nothing depends on, and finds the traits; once, with a program that has passed
/// validate() and with all textures and tables in the scene.
void prepare(Material &material, const Scene &scene);

/// Runs the material's program at a point that a ray met. Shadow rays (ray.kinds is PM_RAY_SHADOW's bit alone) get the
/// transparency alone.
/// @param outgoing unit, towards where the ray came from
Shading shade(const Scene &scene, const SurfacePoint &hit, Vec3 outgoing, const RayState &ray);

/// Runs a material's program for a direction out of the scene; returns its emission.
Vec3 shade_world(const Scene &scene, const Material &material, Vec3 direction, const RayState &ray);

}  // namespace photon_maps
