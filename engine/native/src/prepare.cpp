// SPDX-License-Identifier: GPL-3.0-or-later
// What is done to a material once, so that each of its many runs does less; and what can be said of it beforehand.
#include "fold.h"
#include "photon_maps_shader.h"
#include "scene.h"
#include "shader_ops.h"

namespace photon_maps {

namespace {

/// A closure's arguments as far as they are known beforehand.
struct KnownArguments {
    const Program &program;
    const pm_instruction &instruction;

    std::optional<Vec3> operator[](size_t i) const { return constant_argument(program, instruction, i); }
    bool is_constant(size_t i) const { return (*this)[i].has_value(); }
    /// May it be more than 0?
    bool may(size_t i) const { return !(*this)[i] || max_component(*(*this)[i]) > 0; }
    bool is_at_least(size_t i, float value) const { return (*this)[i] && (*this)[i]->x >= value; }
    /// About its share of 1.
    float about(size_t i, float otherwise = 0.5f) const {
        const std::optional<Vec3> value = (*this)[i];
        return value ? std::clamp(average(*value), 0.0f, 1.0f) : otherwise;
    }
};

float reflectance_head_on(std::optional<Vec3> ior) {
    const float n = ior ? ior->x : 1.5f;
    return n > 0 ? (n - 1) * (n - 1) / ((n + 1) * (n + 1)) : 0;
}

Lobes principled_lobes(const KnownArguments &a) {
    const bool is_metal = a.is_at_least(PM_PRINCIPLED_METALLIC, 1);
    const bool is_glass = a.is_at_least(PM_PRINCIPLED_TRANSMISSION, 1);
    const bool may_transmit = a.may(PM_PRINCIPLED_TRANSMISSION) && !is_metal;
    const auto ior = a[PM_PRINCIPLED_IOR];
    const bool may_reflect = a.may(PM_PRINCIPLED_SPECULAR_LEVEL) && !(ior && ior->x == 1);
    Lobes lobes = 0;
    if (!is_metal && !is_glass && a.may(PM_PRINCIPLED_BASE_COLOR)) lobes |= diffuse_reflection;
    if (a.may(PM_PRINCIPLED_SHEEN)) lobes |= diffuse_reflection;
    if (may_reflect || may_transmit || a.may(PM_PRINCIPLED_METALLIC) || a.may(PM_PRINCIPLED_COAT))
        lobes |= glossy_reflection;
    if (may_transmit) lobes |= glossy_transmission;
    return lobes;
}

float principled_specular(const KnownArguments &a) {
    const float base = a.about(PM_PRINCIPLED_BASE_COLOR), metallic = a.about(PM_PRINCIPLED_METALLIC);
    const float transmission = a.about(PM_PRINCIPLED_TRANSMISSION);
    const float dielectric =
        std::min(1.0f, 2 * a.about(PM_PRINCIPLED_SPECULAR_LEVEL) * reflectance_head_on(a[PM_PRINCIPLED_IOR]));
    const float coat = a.about(PM_PRINCIPLED_COAT) * reflectance_head_on(a[PM_PRINCIPLED_COAT_IOR]);
    const float glass = dielectric + (1 - dielectric) * base;
    const float body = metallic * base + (1 - metallic) * (transmission * glass + (1 - transmission) * dielectric);
    return a.about(PM_PRINCIPLED_ALPHA) * (coat + (1 - coat) * body);
}

Lobes lobes_of(const KnownArguments &a) {
    switch (a.instruction.op) {
        case PM_OP_DIFFUSE:
            return a.may(0) ? Lobes{diffuse_reflection} : 0;
        case PM_OP_SHEEN:
            return diffuse_reflection;
        case PM_OP_TRANSLUCENT:
            return diffuse_transmission;
        case PM_OP_GLOSSY:
        case PM_OP_METALLIC:
        case PM_OP_CONDUCTOR:
            return glossy_reflection;
        case PM_OP_GLASS:
            return glossy_reflection | glossy_transmission;
        case PM_OP_REFRACTION:
            return glossy_transmission;
        case PM_OP_PRINCIPLED:
            return a.may(PM_PRINCIPLED_ALPHA) ? principled_lobes(a) : 0;
        default:
            return 0;
    }
}

float specular_of(const KnownArguments &a) {
    switch (a.instruction.op) {
        case PM_OP_GLOSSY:
        case PM_OP_CONDUCTOR:
        case PM_OP_REFRACTION:
            return a.about(0);
        case PM_OP_METALLIC:
        case PM_OP_GLASS:
            return a.about(0) * a.about(1);
        case PM_OP_PRINCIPLED:
            return a.about(0) * principled_specular(a);
        default:
            return 0;
    }
}

bool emits(const KnownArguments &a) {
    return a.instruction.op == PM_OP_EMISSION ||
           (a.instruction.op == PM_OP_PRINCIPLED && a.may(PM_PRINCIPLED_EMISSION));
}

/// Lets light pass straight through.
bool is_transparent(const KnownArguments &a) {
    return a.instruction.op == PM_OP_TRANSPARENT ||
           (a.instruction.op == PM_OP_PRINCIPLED && !a.is_at_least(PM_PRINCIPLED_ALPHA, 1));
}

/// Are the closure's emission and transparency the same everywhere?
bool is_constant(const KnownArguments &a) {
    if (!emits(a) && !is_transparent(a) && a.instruction.op != PM_OP_HOLDOUT) return true;
    if (a.instruction.op != PM_OP_PRINCIPLED) return a.is_constant(0);
    if (!a.is_constant(0) || !a.is_constant(PM_PRINCIPLED_ALPHA)) return false;
    // What shines lies under coat and sheen, which reflect more at grazing angles.
    const bool is_covered = a.may(PM_PRINCIPLED_COAT) || a.may(PM_PRINCIPLED_SHEEN);
    return !emits(a) || (a.is_constant(PM_PRINCIPLED_EMISSION) && !is_covered);
}

/// Whether a closure's normal, its last argument, is another than the surface's.
bool has_own_normal(const Program &program, const pm_instruction &closure) {
    const uint32_t normal = program.arguments[closure.first_argument + closure.argument_count - 1];
    return std::ranges::none_of(program.instructions, [&](const pm_instruction &i) {
        return !is_closure(i.op) && i.output == normal && i.op == PM_OP_INPUT && i.option == PM_INPUT_NORMAL;
    });
}

/// Whether light goes as well one way as back. Layers take from those below by the side they are seen from, and so does
/// what rough closures add for light that they scatter several times; a normal that is not the surface's turns the
/// cosine of one direction alone.
bool is_reciprocal(const Program &program, const pm_instruction &instruction) {
    switch (instruction.op) {
        case PM_OP_INPUT:
            return instruction.option != PM_INPUT_INCOMING && instruction.option != PM_INPUT_REFLECTION &&
                   instruction.option != PM_INPUT_BACKFACING;
        case PM_OP_DIFFUSE:
        case PM_OP_TRANSLUCENT:
        case PM_OP_REFRACTION:
            return !has_own_normal(program, instruction);
        case PM_OP_FRESNEL:
        case PM_OP_LAYER_WEIGHT:
        case PM_OP_SHEEN:
        case PM_OP_GLOSSY:
        case PM_OP_METALLIC:
        case PM_OP_CONDUCTOR:
        case PM_OP_GLASS:
        case PM_OP_PRINCIPLED:
            return false;
        default:
            return true;
    }
}

MaterialTraits traits_of(const Program &program) {
    MaterialTraits traits;
    traits.is_constant = true;
    for (const pm_instruction &instruction : program.instructions) {
        traits.is_reciprocal &= is_reciprocal(program, instruction);
        traits.depends_on_ray |= instruction.op == PM_OP_INPUT && instruction.option > PM_INPUT_IS_CAMERA_RAY;
        if (!is_closure(instruction.op)) continue;
        const KnownArguments arguments{program, instruction};
        traits.emits |= emits(arguments);
        traits.is_transparent |= is_transparent(arguments) || instruction.op == PM_OP_HOLDOUT;
        traits.lobes |= lobes_of(arguments);
        traits.specular += specular_of(arguments);
        traits.is_constant &= is_constant(arguments);
    }
    traits.specular = std::min(traits.specular, 1.0f);
    traits.may_scatter = traits.lobes != 0;
    return traits;
}

/// Whether what the closure adds is the same at all points but for the shading normal.
bool is_known(const KnownArguments &a) {
    switch (a.instruction.op) {
        case PM_OP_DIFFUSE:
            return a.is_constant(0) && a[1] && a[1]->x <= 0 && !a.is_constant(2);
        case PM_OP_EMISSION:
        case PM_OP_TRANSPARENT:
        case PM_OP_HOLDOUT:
            return a.is_constant(0);
        default:
            return false;
    }
}

/// Returns what shade() makes of any point, if all closures are known and no instruction is left but the normal's.
std::optional<Shading> prototype_of(const Material &material, const Scene &scene) {
    const bool all_known = std::ranges::all_of(material.program.instructions, [&](const pm_instruction &instruction) {
        return is_closure(instruction.op) ? is_known({material.program, instruction})
                                          : instruction.op == PM_OP_INPUT && instruction.option == PM_INPUT_NORMAL;
    });
    if (!all_known) return {};
    SurfacePoint anywhere{};
    anywhere.normal = anywhere.shading_normal = {0, 0, 1};
    anywhere.material = &material;
    return shade(scene, anywhere, {0, 0, 1}, {});
}

}  // namespace

void prepare(Material &material, const Scene &scene) {
    const Program program = folded(material.program, material.index, scene);
    material.program =
        with_closures(program, [&](const pm_instruction &closure) { return KnownArguments{program, closure}.may(0); });
    material.transparency = with_closures(
        material.program, [&](const pm_instruction &closure) { return is_transparent({material.program, closure}); });
    material.traits = traits_of(material.program);
    material.prototype.reset();
    material.prototype = prototype_of(material, scene);
}

}  // namespace photon_maps
