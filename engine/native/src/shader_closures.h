// SPDX-License-Identifier: GPL-3.0-or-later
// The instructions that end a shader: closures, with whatever the tree above made of their arguments.
#pragma once

#include "shader_inputs.h"
#include "shader_ops.h"

namespace photon_maps {

/// Radiance beyond this is cut.
constexpr float max_radiance = 1e15f;

/// Adds what a closure's instruction does to the point's shading. Weights that are negative or no number count as 0;
/// normals that are no direction give way to the point's own.
void add_closure(Shading &shading, const ShaderPoint &point, const pm_instruction &instruction,
                 const Operands &arguments);

/// Adds what a closure lets straight through, and nothing else.
void add_transparency(Shading &shading, const pm_instruction &instruction, const Operands &arguments);

/// Returns the radiance that a closure's instruction adds to the world.
Vec3 world_radiance(const pm_instruction &instruction, const Operands &arguments);

}  // namespace photon_maps
