// SPDX-License-Identifier: GPL-3.0-or-later
#include "program.h"

#include "evaluate.h"
#include "scene.h"
#include "shader_closures.h"

namespace photon_maps {

namespace {

/// Runs a program; what its closures do is up to the caller.
/// @param close called with each closure's instruction and its arguments
template <class Close>
void run(const ShaderPoint &point, const Program &program, Close &&close) {
    Registers registers;
    for (size_t i = 0; i < program.constants.size(); ++i) registers.set(i, program.constants[i]);
    const std::span arguments(program.arguments);
    for (const pm_instruction &instruction : program.instructions) {
        const Operands operands{registers, arguments.subspan(instruction.first_argument, instruction.argument_count)};
        if (is_closure(instruction.op))
            close(instruction, operands);
        else if (instruction.op == PM_OP_INPUT && instruction.option == PM_INPUT_NORMAL)
            registers.set(instruction.output, shading_normal(point));  // the one that nearly all have, and many alone
        else
            evaluate(point, instruction, operands, registers);
    }
}

}  // namespace

Shading shade(const Scene &scene, const SurfacePoint &hit, Vec3 outgoing, const RayState &ray) {
    const Material &material = *hit.material;
    const bool is_shadow = ray.kinds == 1u << PM_RAY_SHADOW;
    const bool is_known = material.prototype && !is_shadow;
    Shading shading = is_known ? *material.prototype : Shading();
    shading.outgoing = outgoing;
    shading.normal = hit.normal;
    shading.smooth_normal = hit.shading_normal;
    shading.is_backfacing = hit.is_backfacing;
    if (is_known) {
        for (Closure &closure : shading.closures.values()) closure.normal = hit.shading_normal;
        return shading;
    }
    const ShaderPoint point{scene, material, &hit, outgoing, ray};
    if (is_shadow) {
        run(point, material.transparency, [&](const pm_instruction &instruction, const Operands &arguments) {
            add_transparency(shading, instruction, arguments);
        });
    } else {
        run(point, material.program, [&](const pm_instruction &instruction, const Operands &arguments) {
            add_closure(shading, point, instruction, arguments);
        });
    }
    shading.transparency = min(shading.transparency, {1, 1, 1});
    shading.emission = min(shading.emission, {max_radiance, max_radiance, max_radiance});
    shading.holdout = std::min(shading.holdout, 1.0f);
    return shading;
}

Vec3 shade_world(const Scene &scene, const Material &material, Vec3 direction, const RayState &ray) {
    Vec3 emission;
    const ShaderPoint point{scene, material, nullptr, -direction, ray};
    run(point, material.program, [&](const pm_instruction &instruction, const Operands &arguments) {
        emission += world_radiance(instruction, arguments);
    });
    return min(emission, {max_radiance, max_radiance, max_radiance});
}

}  // namespace photon_maps
