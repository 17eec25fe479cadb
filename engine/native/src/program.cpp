// SPDX-License-Identifier: GPL-3.0-or-later
#include "program.h"

#include "photon_maps_shader.h"
#include "scene.h"
#include "surface.h"

namespace photon_maps {

void prepare(Material &material, const Scene &) {
    MaterialTraits traits;
    traits.may_scatter = false;
    traits.is_constant = true;
    for (const pm_instruction &instruction : material.program.instructions) {
        const Vec3 weight = material.program.constants[material.program.arguments[instruction.first_argument]];
        if (instruction.op == PM_OP_EMISSION && max_component(weight) > 0) traits.emits = true;
        if (instruction.op == PM_OP_DIFFUSE && max_component(weight) > 0) traits.lobes |= diffuse_reflection;
    }
    traits.may_scatter = traits.lobes != 0;
    material.traits = traits;
}

Shading shade(const Scene &, const SurfacePoint &hit, Vec3 outgoing, const RayState &) {
    Shading shading;
    shading.outgoing = outgoing;
    shading.normal = hit.normal;
    shading.is_backfacing = hit.is_backfacing;
    const Program &program = hit.material->program;
    for (const pm_instruction &instruction : program.instructions) {
        const Vec3 weight = program.constants[program.arguments[instruction.first_argument]];
        if (instruction.op == PM_OP_EMISSION) shading.emission += weight;
        if (instruction.op == PM_OP_DIFFUSE) add_diffuse(shading, weight, 0, hit.shading_normal);
    }
    return shading;
}

Vec3 shade_world(const Scene &, const Material &material, Vec3, const RayState &) {
    Vec3 emission;
    for (const pm_instruction &instruction : material.program.instructions)
        if (instruction.op == PM_OP_EMISSION)
            emission += material.program.constants[material.program.arguments[instruction.first_argument]];
    return emission;
}

}  // namespace photon_maps
