// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_ops.h"

#include <array>

namespace photon_maps {

namespace {

constexpr std::array<uint8_t, PM_MATH_COUNT> math_arguments = {
    2, 2, 2, 2, 3,     // add, subtract, multiply, divide, multiply add
    2, 2, 1, 1, 1, 1,  // power, logarithm, square root, inverse square root, absolute, exponent
    2, 2, 2, 2, 1, 3,  // minimum, maximum, less than, greater than, sign, compare
    3, 3,              // smooth minimum and maximum
    1, 1, 1, 1, 1,     // round, floor, ceil, trunc, fract
    2, 2, 3, 2, 2,     // modulo, floored modulo, wrap, snap, ping-pong
    1, 1, 1, 1, 1, 1,  // sine, cosine, tangent, and their inverses
    2, 1, 1, 1, 1, 1,  // arctan2, sinh, cosh, tanh, radians, degrees
};

constexpr std::array<uint8_t, PM_VECTOR_COUNT> vector_arguments = {2, 2, 1, 2, 1, 2, 2, 3, 3};

}  // namespace

std::optional<OpShape> shape_of(uint32_t op, uint32_t option) {
    switch (op) {
        case PM_OP_INPUT:
            return OpShape{0, 1, PM_INPUT_COUNT, true};
        case PM_OP_ATTRIBUTE:
            return OpShape{0, 2, 0, true};
        case PM_OP_MATH:
            return OpShape{option < PM_MATH_COUNT ? math_arguments[option] : 0u, 1, PM_MATH_COUNT, false};
        case PM_OP_VECTOR:
            return OpShape{option < PM_VECTOR_COUNT ? vector_arguments[option] : 0u, 1, PM_VECTOR_COUNT, false};
        case PM_OP_CLAMP:
            return OpShape{3, 1, 1, false};
        case PM_OP_MAP_RANGE:
            return OpShape{6, 1, PM_MAP_RANGE_COUNT, false};
        case PM_OP_MIX:
            return OpShape{3, 1, 2, false};
        case PM_OP_BLEND:
            return OpShape{3, 1, PM_BLEND_COUNT, false};
        case PM_OP_COMPONENT:
            return OpShape{1, 1, 3, false};
        case PM_OP_COMBINE:
            return OpShape{3, 1, 1, false};
        case PM_OP_LUMINANCE:
        case PM_OP_AVERAGE:
            return OpShape{1, 1, 1, false};
        case PM_OP_CONVERT:
            return OpShape{1, 1, PM_CONVERT_COUNT, false};
        case PM_OP_HUE_SATURATION:
            return OpShape{5, 1, 1, false};
        case PM_OP_BRIGHT_CONTRAST:
            return OpShape{3, 1, 1, false};
        case PM_OP_GAMMA:
        case PM_OP_INVERT:
            return OpShape{2, 1, 1, false};
        case PM_OP_TABLE:
            return OpShape{1, 2, 0, false};
        case PM_OP_CURVES:
            return OpShape{4, 1, 0, false};
        case PM_OP_MAPPING:
            return OpShape{4, 1, PM_MAPPING_COUNT, false};
        case PM_OP_ROTATE:
            return OpShape{5, 1, PM_ROTATE_COUNT, false};
        case PM_OP_TRANSFORM:
            return OpShape{1, 1, PM_TRANSFORM_COUNT, false};
        case PM_OP_FRESNEL:
            return OpShape{2, 1, 1, false};
        case PM_OP_LAYER_WEIGHT:
            return OpShape{2, 2, 1, false};
        case PM_OP_NORMAL_MAP:
            return OpShape{2, 1, 0, false};
        case PM_OP_BUMP:
            return OpShape{6, 1, 2, false};
        case PM_OP_TEXTURE:
            return OpShape{1, 2, 0, false};
        case PM_OP_CHECKER:
            return OpShape{4, 2, 1, false};
        case PM_OP_GRADIENT:
            return OpShape{1, 1, PM_GRADIENT_COUNT, false};
        case PM_OP_DIFFUSE:
            return OpShape{3, 0, 1, false};
        case PM_OP_TRANSLUCENT:
            return OpShape{2, 0, 1, false};
        case PM_OP_SHEEN:
            return OpShape{3, 0, 1, false};
        case PM_OP_GLOSSY:
            return OpShape{3, 0, PM_DISTRIBUTION_COUNT, false};
        case PM_OP_METALLIC:
        case PM_OP_CONDUCTOR:
        case PM_OP_GLASS:
            return OpShape{5, 0, PM_DISTRIBUTION_COUNT, false};
        case PM_OP_REFRACTION:
            return OpShape{4, 0, 1, false};
        case PM_OP_TRANSPARENT:
        case PM_OP_EMISSION:
        case PM_OP_HOLDOUT:
            return OpShape{1, 0, 1, false};
        case PM_OP_PRINCIPLED:
            return OpShape{PM_PRINCIPLED_ARGUMENT_COUNT, 0, PM_DISTRIBUTION_COUNT, false};
        default:
            return {};
    }
}

}  // namespace photon_maps
