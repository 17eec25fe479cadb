// SPDX-License-Identifier: GPL-3.0-or-later
// Normals of shaders, and what depends on the angle to them.
#pragma once

#include "photon_maps_shader.h"
#include "shader_inputs.h"
#include "shader_ops.h"

namespace photon_maps {

/// PM_OP_NORMAL_MAP. In tangent space by the triangle's own tangents, which Mikkelsen (2008) averages over neighbours.
/// @param option pm_normal_space | id of the UV attribute << 8
Vec3 normal_map(const ShaderPoint &point, uint32_t option, float strength, Vec3 color);

/// PM_OP_BUMP: the normal by the gradient that heights have along the surface (Mikkelsen 2010, "Bump mapping
/// unparametrized surfaces on the GPU").
Vec3 bump(const ShaderPoint &point, bool is_inverted, const Operands &arguments);

/// PM_OP_FRESNEL: what a smooth dielectric reflects.
float fresnel(const ShaderPoint &point, float ior, Vec3 normal);
/// PM_OP_LAYER_WEIGHT's first output and its second.
float layer_fresnel(const ShaderPoint &point, float blend, Vec3 normal);
float layer_facing(const ShaderPoint &point, float blend, Vec3 normal);

}  // namespace photon_maps
