// SPDX-License-Identifier: GPL-3.0-or-later
// Programs made shorter: what is known beforehand and what nothing depends on goes.
#pragma once

#include <functional>
#include <optional>

#include "program.h"

namespace photon_maps {

/// Returns an argument of an instruction if it is one of the program's constants.
std::optional<Vec3> constant_argument(const Program &program, const pm_instruction &instruction, size_t i);

/// Returns the program with everything computed that depends on constants alone.
Program folded(const Program &program, uint32_t material_index, const Scene &scene);

/// Returns the program with the closures that are wanted and what they depend on.
/// @param wanted of the program's own instructions
Program with_closures(const Program &program, const std::function<bool(const pm_instruction &)> &wanted);

}  // namespace photon_maps
