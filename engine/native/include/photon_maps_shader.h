/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The operations of a material's shader (pm_instruction): what each reads, writes and means. A register holds three
 * floats; a number is the same three times, so that number and colour need no conversion, but for the way from three
 * to one (PM_OP_LUMINANCE, PM_OP_AVERAGE, PM_OP_COMPONENT). All of it is as Blender's node of the same name does it.
 */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

typedef enum pm_op {
    /* --- Inputs: no arguments --- */
    PM_OP_INPUT = 0,     /* option: pm_input. Writes the value */
    PM_OP_ATTRIBUTE = 1, /* option: id of pm_attribute. Writes the value and, in the next register, alpha; 0 and 0 where
                            the mesh has none */

    /* --- Numbers and vectors, each component by itself --- */
    PM_OP_MATH = 2,            /* option: pm_math; arguments: as many as it has */
    PM_OP_VECTOR = 3,          /* option: pm_vector */
    PM_OP_CLAMP = 4,           /* value, least, greatest */
    PM_OP_MAP_RANGE = 5,       /* value, from min, from max, to min, to max, steps; option: pm_map_range. Not clamped */
    PM_OP_MIX = 6,             /* factor, a, b: a (1 - factor) + b factor; option 1: the factor is clamped to 0 ... 1 */
    PM_OP_BLEND = 7,           /* factor, a, b; option: pm_blend. The factor is clamped, the result is not */
    PM_OP_COMPONENT = 8,       /* vector; option: 0 to 2. Writes that component three times */
    PM_OP_COMBINE = 9,         /* x, y, z */
    PM_OP_LUMINANCE = 10,      /* colour to number, by Rec. 709 */
    PM_OP_AVERAGE = 11,        /* vector to number */
    PM_OP_CONVERT = 12,        /* colour; option: pm_convert */
    PM_OP_HUE_SATURATION = 13, /* hue, saturation, value, factor, colour */
    PM_OP_BRIGHT_CONTRAST = 14, /* colour, bright, contrast */
    PM_OP_GAMMA = 15,           /* colour, gamma */
    PM_OP_INVERT = 16,          /* factor, colour */
    PM_OP_TABLE = 17,           /* factor 0 to 1; option: table. Writes colour and, in the next register, alpha */
    PM_OP_CURVES = 18, /* factor, colour, least, greatest input; option: table. Each channel looks up its own column and
                          is continued by the end's slope; the factor mixes with the colour as it was */
    PM_OP_MAPPING = 19,   /* vector, location, rotation (Euler XYZ), scale; option: pm_mapping */
    PM_OP_ROTATE = 20,    /* vector, centre, axis, angle, rotation (Euler XYZ); option: pm_rotate */
    PM_OP_TRANSFORM = 21, /* vector; option: pm_transform */

    /* --- What depends on the view --- */
    PM_OP_FRESNEL = 22,      /* ior, normal */
    PM_OP_LAYER_WEIGHT = 23, /* blend, normal. Writes fresnel and, in the next register, facing */

    /* --- Normals --- */
    PM_OP_NORMAL_MAP =
        24,          /* strength, colour; option: pm_normal_space | id of the UV attribute << 8. Writes a unit normal */
    PM_OP_BUMP = 25, /* strength, distance, height, height at shift 1, height at shift 2, normal; option 1: inverted */

    /* --- Textures --- */
    PM_OP_TEXTURE = 26,  /* vector; option: texture. Writes colour and, in the next register, alpha */
    PM_OP_CHECKER = 27,  /* vector, colour 1, colour 2, scale. Writes colour and, in the next register, factor */
    PM_OP_GRADIENT = 28, /* vector; option: pm_gradient. Writes the factor */

    /* --- Closures: they write nothing. `weight` is what the tree above leaves, times the closure's colour --- */
    PM_OP_DIFFUSE = 40,     /* weight, roughness, normal */
    PM_OP_TRANSLUCENT = 41, /* weight, normal */
    PM_OP_SHEEN = 42,       /* weight, roughness, normal */
    PM_OP_GLOSSY = 43,      /* weight, roughness, normal; option: pm_distribution */
    PM_OP_METALLIC = 44,    /* weight, base colour, edge tint, roughness, normal (F82); option: pm_distribution */
    PM_OP_CONDUCTOR = 45,   /* weight, ior, extinction, roughness, normal; option: pm_distribution */
    PM_OP_GLASS = 46,       /* weight, colour, roughness, ior, normal; option: pm_distribution */
    PM_OP_REFRACTION = 47,  /* weight, roughness, ior, normal */
    PM_OP_TRANSPARENT = 48, /* weight */
    PM_OP_EMISSION = 49,    /* weight: radiance */
    PM_OP_HOLDOUT = 50,     /* weight */
    PM_OP_PRINCIPLED = 51,  /* weight, and then in the order of pm_principled; option: pm_distribution */
    PM_OP_COUNT = 52
} pm_op;

typedef enum pm_input {
    PM_INPUT_POSITION = 0,         /* world */
    PM_INPUT_NORMAL = 1,           /* shading normal on the side that is seen */
    PM_INPUT_GEOMETRIC_NORMAL = 2, /* likewise */
    PM_INPUT_INCOMING = 3,         /* unit, from the point to where the ray came from */
    PM_INPUT_PARAMETRIC = 4,       /* barycentric coordinates as Blender gives them */
    PM_INPUT_BACKFACING = 5,       /* 1 where the back is seen */
    PM_INPUT_OBJECT_POSITION = 6,  /* Texture Coordinate: Object */
    PM_INPUT_OBJECT_NORMAL = 7,    /* Texture Coordinate: Normal */
    PM_INPUT_CAMERA_POSITION = 8,  /* Texture Coordinate: Camera */
    PM_INPUT_WINDOW = 9,           /* Texture Coordinate: Window */
    PM_INPUT_REFLECTION = 10,      /* Texture Coordinate: Reflection */
    PM_INPUT_OBJECT_LOCATION = 11,
    PM_INPUT_OBJECT_COLOR = 12,
    PM_INPUT_OBJECT_ALPHA = 13,
    PM_INPUT_OBJECT_INDEX = 14,
    PM_INPUT_OBJECT_RANDOM = 15,
    PM_INPUT_MATERIAL_INDEX = 16,
    PM_INPUT_IS_CAMERA_RAY = 17,
    PM_INPUT_IS_SHADOW_RAY = 18,
    PM_INPUT_IS_DIFFUSE_RAY = 19,
    PM_INPUT_IS_GLOSSY_RAY = 20,
    PM_INPUT_IS_SINGULAR_RAY = 21,
    PM_INPUT_IS_REFLECTION_RAY = 22,
    PM_INPUT_IS_TRANSMISSION_RAY = 23,
    PM_INPUT_RAY_LENGTH = 24,
    PM_INPUT_RAY_DEPTH = 25,
    PM_INPUT_DIFFUSE_DEPTH = 26,
    PM_INPUT_GLOSSY_DEPTH = 27,
    PM_INPUT_TRANSPARENT_DEPTH = 28,
    PM_INPUT_TRANSMISSION_DEPTH = 29,
    PM_INPUT_COUNT = 30
} pm_input;

typedef enum pm_math {
    PM_MATH_ADD = 0,
    PM_MATH_SUBTRACT = 1,
    PM_MATH_MULTIPLY = 2,
    PM_MATH_DIVIDE = 3, /* by 0: 0 */
    PM_MATH_MULTIPLY_ADD = 4,
    PM_MATH_POWER = 5,
    PM_MATH_LOGARITHM = 6,
    PM_MATH_SQRT = 7,
    PM_MATH_INVERSE_SQRT = 8,
    PM_MATH_ABSOLUTE = 9,
    PM_MATH_EXPONENT = 10,
    PM_MATH_MINIMUM = 11,
    PM_MATH_MAXIMUM = 12,
    PM_MATH_LESS_THAN = 13,
    PM_MATH_GREATER_THAN = 14,
    PM_MATH_SIGN = 15,
    PM_MATH_COMPARE = 16,
    PM_MATH_SMOOTH_MIN = 17,
    PM_MATH_SMOOTH_MAX = 18,
    PM_MATH_ROUND = 19,
    PM_MATH_FLOOR = 20,
    PM_MATH_CEIL = 21,
    PM_MATH_TRUNC = 22,
    PM_MATH_FRACT = 23,
    PM_MATH_MODULO = 24,
    PM_MATH_FLOORED_MODULO = 25,
    PM_MATH_WRAP = 26, /* value, greatest, least */
    PM_MATH_SNAP = 27,
    PM_MATH_PINGPONG = 28,
    PM_MATH_SINE = 29,
    PM_MATH_COSINE = 30,
    PM_MATH_TANGENT = 31,
    PM_MATH_ARCSINE = 32,
    PM_MATH_ARCCOSINE = 33,
    PM_MATH_ARCTANGENT = 34,
    PM_MATH_ARCTAN2 = 35,
    PM_MATH_SINH = 36,
    PM_MATH_COSH = 37,
    PM_MATH_TANH = 38,
    PM_MATH_RADIANS = 39,
    PM_MATH_DEGREES = 40,
    PM_MATH_COUNT = 41
} pm_math;

/* Vector Math where components meet; the rest is pm_math. */
typedef enum pm_vector {
    PM_VECTOR_CROSS = 0,
    PM_VECTOR_DOT = 1,
    PM_VECTOR_LENGTH = 2,
    PM_VECTOR_DISTANCE = 3,
    PM_VECTOR_NORMALIZE = 4,
    PM_VECTOR_PROJECT = 5,
    PM_VECTOR_REFLECT = 6,
    PM_VECTOR_REFRACT = 7, /* vector, normal, ior */
    PM_VECTOR_FACEFORWARD = 8,
    PM_VECTOR_COUNT = 9
} pm_vector;

typedef enum pm_map_range {
    PM_MAP_RANGE_LINEAR = 0,
    PM_MAP_RANGE_STEPPED = 1,
    PM_MAP_RANGE_SMOOTHSTEP = 2,
    PM_MAP_RANGE_SMOOTHERSTEP = 3,
    PM_MAP_RANGE_COUNT = 4
} pm_map_range;

typedef enum pm_blend {
    PM_BLEND_MIX = 0,
    PM_BLEND_DARKEN = 1,
    PM_BLEND_MULTIPLY = 2,
    PM_BLEND_BURN = 3,
    PM_BLEND_LIGHTEN = 4,
    PM_BLEND_SCREEN = 5,
    PM_BLEND_DODGE = 6,
    PM_BLEND_ADD = 7,
    PM_BLEND_OVERLAY = 8,
    PM_BLEND_SOFT_LIGHT = 9,
    PM_BLEND_LINEAR_LIGHT = 10,
    PM_BLEND_DIFFERENCE = 11,
    PM_BLEND_EXCLUSION = 12,
    PM_BLEND_SUBTRACT = 13,
    PM_BLEND_DIVIDE = 14,
    PM_BLEND_HUE = 15,
    PM_BLEND_SATURATION = 16,
    PM_BLEND_COLOR = 17,
    PM_BLEND_VALUE = 18,
    PM_BLEND_COUNT = 19
} pm_blend;

typedef enum pm_convert {
    PM_CONVERT_RGB_TO_HSV = 0,
    PM_CONVERT_HSV_TO_RGB = 1,
    PM_CONVERT_RGB_TO_HSL = 2,
    PM_CONVERT_HSL_TO_RGB = 3,
    PM_CONVERT_COUNT = 4
} pm_convert;

typedef enum pm_mapping {
    PM_MAPPING_POINT = 0,
    PM_MAPPING_TEXTURE = 1,
    PM_MAPPING_VECTOR = 2,
    PM_MAPPING_NORMAL = 3,
    PM_MAPPING_COUNT = 4
} pm_mapping;

typedef enum pm_rotate {
    PM_ROTATE_AXIS_ANGLE = 0,
    PM_ROTATE_EULER = 1,
    PM_ROTATE_EULER_INVERSE = 2,
    PM_ROTATE_COUNT = 3
} pm_rotate;

/* Vector Transform: kind + 3 * (from + 3 * to), of a vector, point or normal (0 to 2) between world, object and camera
 * space (0 to 2). */
enum { PM_TRANSFORM_COUNT = 27 };

typedef enum pm_normal_space {
    PM_NORMAL_TANGENT = 0,
    PM_NORMAL_OBJECT = 1,
    PM_NORMAL_WORLD = 2,
    PM_NORMAL_SPACE_COUNT = 3
} pm_normal_space;

typedef enum pm_gradient {
    PM_GRADIENT_LINEAR = 0,
    PM_GRADIENT_QUADRATIC = 1,
    PM_GRADIENT_EASING = 2,
    PM_GRADIENT_DIAGONAL = 3,
    PM_GRADIENT_SPHERICAL = 4,
    PM_GRADIENT_QUADRATIC_SPHERE = 5,
    PM_GRADIENT_RADIAL = 6,
    PM_GRADIENT_COUNT = 7
} pm_gradient;

/* Microfacets: GGX, with or without the light of several scatterings among them. */
typedef enum pm_distribution {
    PM_DISTRIBUTION_GGX = 0,
    PM_DISTRIBUTION_MULTI_GGX = 1,
    PM_DISTRIBUTION_COUNT = 2
} pm_distribution;

/* Arguments of PM_OP_PRINCIPLED after the weight (argument 0 of the instruction). Alpha and emission are among them. */
typedef enum pm_principled {
    PM_PRINCIPLED_BASE_COLOR = 1,
    PM_PRINCIPLED_METALLIC = 2,
    PM_PRINCIPLED_ROUGHNESS = 3,
    PM_PRINCIPLED_IOR = 4,
    PM_PRINCIPLED_ALPHA = 5,
    PM_PRINCIPLED_NORMAL = 6,
    PM_PRINCIPLED_DIFFUSE_ROUGHNESS = 7,
    PM_PRINCIPLED_SPECULAR_LEVEL = 8,
    PM_PRINCIPLED_SPECULAR_TINT = 9,
    PM_PRINCIPLED_TRANSMISSION = 10,
    PM_PRINCIPLED_COAT = 11,
    PM_PRINCIPLED_COAT_ROUGHNESS = 12,
    PM_PRINCIPLED_COAT_IOR = 13,
    PM_PRINCIPLED_COAT_TINT = 14,
    PM_PRINCIPLED_COAT_NORMAL = 15,
    PM_PRINCIPLED_SHEEN = 16,
    PM_PRINCIPLED_SHEEN_ROUGHNESS = 17,
    PM_PRINCIPLED_SHEEN_TINT = 18,
    PM_PRINCIPLED_EMISSION = 19, /* radiance: colour times strength */
    PM_PRINCIPLED_ARGUMENT_COUNT = 20
} pm_principled;

#ifdef __cplusplus
}
#endif
