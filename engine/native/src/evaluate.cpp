// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate.h"

#include "procedural.h"
#include "shader_color.h"
#include "shader_math.h"
#include "shader_normal.h"

namespace photon_maps {

namespace {

/// What an instruction writes; most write the first alone.
struct Values {
    Vec3 first, second;

    Values(Vec3 value) : first(value) {}
    Values(float value) : first(splat(value)) {}
    Values(const Rgba &value) : first(value.color), second(splat(value.alpha)) {}
    Values(Vec3 a, float b) : first(a), second(splat(b)) {}
};

void write(const pm_instruction &instruction, const Values &values, Registers &registers) {
    registers.set(instruction.output, values.first);
    // Where there is but one, the next register is still to be written by its own instruction.
    registers.set(instruction.output + 1, values.second);
}

Values checker(const Operands &a) {
    const bool is_first = is_first_check(a[0] * a.number(3));
    return {is_first ? a[1] : a[2], is_first ? 1.0f : 0.0f};
}

Values pure_values(const Scene &scene, const pm_instruction &instruction, const Operands &a) {
    const uint32_t option = instruction.option;
    switch (instruction.op) {
        case PM_OP_MATH:
            return math(static_cast<pm_math>(option), a);
        case PM_OP_VECTOR:
            return vector_math(static_cast<pm_vector>(option), a);
        case PM_OP_CLAMP:
            return min(max(a[0], a[1]), a[2]);
        case PM_OP_MAP_RANGE:
            return map_range(static_cast<pm_map_range>(option), a);
        case PM_OP_MIX: {
            const Vec3 t = option == 1 ? saturate(a[0]) : a[0];
            return a[1] * (splat(1) - t) + a[2] * t;
        }
        case PM_OP_BLEND:
            return blend(static_cast<pm_blend>(option), a.number(0), a[1], a[2]);
        case PM_OP_COMPONENT:
            return a[0][static_cast<int>(option)];
        case PM_OP_COMBINE:
            return Vec3{a.number(0), a.number(1), a.number(2)};
        case PM_OP_LUMINANCE:
            return luminance(a[0]);
        case PM_OP_AVERAGE:
            return average(a[0]);
        case PM_OP_CONVERT:
            return convert(static_cast<pm_convert>(option), a[0]);
        case PM_OP_HUE_SATURATION:
            return hue_saturation(a.number(0), a.number(1), a.number(2), a.number(3), a[4]);
        case PM_OP_BRIGHT_CONTRAST:
            return bright_contrast(a[0], a.number(1), a.number(2));
        case PM_OP_GAMMA:
            return gamma(a[0], a.number(1));
        case PM_OP_INVERT:
            return mix(a[1], splat(1) - a[1], a.number(0));
        case PM_OP_TABLE:
            return look_up(scene.tables[option], a.number(0));
        case PM_OP_CURVES:
            return curves(scene.tables[option], a.number(0), a[1], a.number(2), a.number(3));
        case PM_OP_MAPPING:
            return mapping(static_cast<pm_mapping>(option), a[0], a[1], a[2], a[3]);
        case PM_OP_ROTATE:
            return rotate(static_cast<pm_rotate>(option), a[0], a[1], a[2], a.number(3), a[4]);
        case PM_OP_TEXTURE:
            return look_up(scene.textures[option], scene.images, a[0], {});
        case PM_OP_CHECKER:
            return checker(a);
        case PM_OP_GRADIENT:
            return gradient(static_cast<pm_gradient>(option), a[0]);
        default:
            return Vec3();
    }
}

Values values(const ShaderPoint &point, const pm_instruction &instruction, const Operands &a) {
    const uint32_t option = instruction.option;
    switch (instruction.op) {
        case PM_OP_INPUT:
            return input(point, static_cast<pm_input>(option), instruction.shift);
        case PM_OP_ATTRIBUTE:
            return attribute(point, option, instruction.shift);
        case PM_OP_TRANSFORM:
            return transform(point, option, a[0]);
        case PM_OP_FRESNEL:
            return fresnel(point, a.number(0), a[1]);
        case PM_OP_LAYER_WEIGHT:
            return {splat(layer_fresnel(point, a.number(0), a[1])), layer_facing(point, a.number(0), a[1])};
        case PM_OP_NORMAL_MAP:
            return normal_map(point, option, a.number(0), a[1]);
        case PM_OP_BUMP:
            return bump(point, option == 1, a);
        case PM_OP_TEXTURE: {
            const Texture &texture = point.scene.textures[option];
            const bool is_box = texture.projection == PM_PROJECTION_BOX;
            const Vec3 normal = is_box ? to_object_normal(point, shading_normal(point)) : Vec3();
            return look_up(texture, point.scene.images, a[0], normal);
        }
        default:
            return pure_values(point.scene, instruction, a);
    }
}

}  // namespace

void evaluate(const ShaderPoint &point, const pm_instruction &instruction, const Operands &arguments,
              Registers &registers) {
    write(instruction, values(point, instruction, arguments), registers);
}

bool is_pure(const Scene &scene, const pm_instruction &instruction) {
    switch (instruction.op) {
        case PM_OP_INPUT:
        case PM_OP_ATTRIBUTE:
        case PM_OP_TRANSFORM:
        case PM_OP_FRESNEL:
        case PM_OP_LAYER_WEIGHT:
        case PM_OP_NORMAL_MAP:
        case PM_OP_BUMP:
            return false;
        case PM_OP_TEXTURE:
            return scene.textures[instruction.option].projection != PM_PROJECTION_BOX;
        default:
            return !is_closure(instruction.op);
    }
}

void evaluate_pure(const Scene &scene, const pm_instruction &instruction, const Operands &arguments,
                   Registers &registers) {
    write(instruction, pure_values(scene, instruction, arguments), registers);
}

}  // namespace photon_maps
