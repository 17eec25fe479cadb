// SPDX-License-Identifier: GPL-3.0-or-later
// One instruction of a shader that writes registers.
#pragma once

#include "shader_inputs.h"
#include "shader_ops.h"

namespace photon_maps {

/// Runs an instruction that is no closure.
/// @param registers those of `arguments`
void evaluate(const ShaderPoint &point, const pm_instruction &instruction, const Operands &arguments,
              Registers &registers);

/// Returns whether an instruction's value depends on its arguments alone.
bool is_pure(const Scene &scene, const pm_instruction &instruction);

/// Runs an instruction that is_pure().
void evaluate_pure(const Scene &scene, const pm_instruction &instruction, const Operands &arguments,
                   Registers &registers);

}  // namespace photon_maps
