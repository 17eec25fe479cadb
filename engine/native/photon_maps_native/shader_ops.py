# SPDX-License-Identifier: GPL-3.0-or-later
"""What photon_maps_shader.h numbers: a shader's operations and their options."""

from __future__ import annotations

import enum


class Op(enum.IntEnum):
    """Operations; photon_maps_shader.h says what each reads and writes."""

    INPUT = 0
    ATTRIBUTE = 1
    MATH = 2
    VECTOR = 3
    CLAMP = 4
    MAP_RANGE = 5
    MIX = 6
    BLEND = 7
    COMPONENT = 8
    COMBINE = 9
    LUMINANCE = 10
    AVERAGE = 11
    CONVERT = 12
    HUE_SATURATION = 13
    BRIGHT_CONTRAST = 14
    GAMMA = 15
    INVERT = 16
    TABLE = 17
    CURVES = 18
    MAPPING = 19
    ROTATE = 20
    TRANSFORM = 21
    FRESNEL = 22
    LAYER_WEIGHT = 23
    NORMAL_MAP = 24
    BUMP = 25
    TEXTURE = 26
    CHECKER = 27
    GRADIENT = 28
    DIFFUSE = 40
    TRANSLUCENT = 41
    SHEEN = 42
    GLOSSY = 43
    METALLIC = 44
    CONDUCTOR = 45
    GLASS = 46
    REFRACTION = 47
    TRANSPARENT = 48
    EMISSION = 49
    HOLDOUT = 50
    PRINCIPLED = 51


class Input(enum.IntEnum):
    """What INPUT reads."""

    POSITION = 0
    NORMAL = 1
    GEOMETRIC_NORMAL = 2
    INCOMING = 3
    PARAMETRIC = 4
    BACKFACING = 5
    OBJECT_POSITION = 6
    OBJECT_NORMAL = 7
    CAMERA_POSITION = 8
    WINDOW = 9
    REFLECTION = 10
    OBJECT_LOCATION = 11
    OBJECT_COLOR = 12
    OBJECT_ALPHA = 13
    OBJECT_INDEX = 14
    OBJECT_RANDOM = 15
    MATERIAL_INDEX = 16
    IS_CAMERA_RAY = 17
    IS_SHADOW_RAY = 18
    IS_DIFFUSE_RAY = 19
    IS_GLOSSY_RAY = 20
    IS_SINGULAR_RAY = 21
    IS_REFLECTION_RAY = 22
    IS_TRANSMISSION_RAY = 23
    RAY_LENGTH = 24
    RAY_DEPTH = 25
    DIFFUSE_DEPTH = 26
    GLOSSY_DEPTH = 27
    TRANSPARENT_DEPTH = 28
    TRANSMISSION_DEPTH = 29


class Math(enum.IntEnum):
    """What MATH does, each component by itself."""

    ADD = 0
    SUBTRACT = 1
    MULTIPLY = 2
    DIVIDE = 3
    MULTIPLY_ADD = 4
    POWER = 5
    LOGARITHM = 6
    SQRT = 7
    INVERSE_SQRT = 8
    ABSOLUTE = 9
    EXPONENT = 10
    MINIMUM = 11
    MAXIMUM = 12
    LESS_THAN = 13
    GREATER_THAN = 14
    SIGN = 15
    COMPARE = 16
    SMOOTH_MIN = 17
    SMOOTH_MAX = 18
    ROUND = 19
    FLOOR = 20
    CEIL = 21
    TRUNC = 22
    FRACT = 23
    MODULO = 24
    FLOORED_MODULO = 25
    WRAP = 26
    SNAP = 27
    PINGPONG = 28
    SINE = 29
    COSINE = 30
    TANGENT = 31
    ARCSINE = 32
    ARCCOSINE = 33
    ARCTANGENT = 34
    ARCTAN2 = 35
    SINH = 36
    COSH = 37
    TANH = 38
    RADIANS = 39
    DEGREES = 40


class Vector(enum.IntEnum):
    """What VECTOR does."""

    CROSS = 0
    DOT = 1
    LENGTH = 2
    DISTANCE = 3
    NORMALIZE = 4
    PROJECT = 5
    REFLECT = 6
    REFRACT = 7
    FACEFORWARD = 8


class MapRange(enum.IntEnum):
    """Interpolations of MAP_RANGE."""

    LINEAR = 0
    STEPPED = 1
    SMOOTHSTEP = 2
    SMOOTHERSTEP = 3


class Blend(enum.IntEnum):
    """Blend modes of BLEND."""

    MIX = 0
    DARKEN = 1
    MULTIPLY = 2
    BURN = 3
    LIGHTEN = 4
    SCREEN = 5
    DODGE = 6
    ADD = 7
    OVERLAY = 8
    SOFT_LIGHT = 9
    LINEAR_LIGHT = 10
    DIFFERENCE = 11
    EXCLUSION = 12
    SUBTRACT = 13
    DIVIDE = 14
    HUE = 15
    SATURATION = 16
    COLOR = 17
    VALUE = 18


class Convert(enum.IntEnum):
    """Colour models of CONVERT."""

    RGB_TO_HSV = 0
    HSV_TO_RGB = 1
    RGB_TO_HSL = 2
    HSL_TO_RGB = 3


class Mapping(enum.IntEnum):
    """Types of MAPPING."""

    POINT = 0
    TEXTURE = 1
    VECTOR = 2
    NORMAL = 3


class Rotate(enum.IntEnum):
    """Types of ROTATE."""

    AXIS_ANGLE = 0
    EULER = 1
    EULER_INVERSE = 2


class NormalSpace(enum.IntEnum):
    """Spaces of NORMAL_MAP."""

    TANGENT = 0
    OBJECT = 1
    WORLD = 2


class Gradient(enum.IntEnum):
    """Types of GRADIENT."""

    LINEAR = 0
    QUADRATIC = 1
    EASING = 2
    DIAGONAL = 3
    SPHERICAL = 4
    QUADRATIC_SPHERE = 5
    RADIAL = 6


class Distribution(enum.IntEnum):
    """Microfacets: GGX, with or without the light of several scatterings among them."""

    GGX = 0
    MULTI_GGX = 1


class PrincipledArgument(enum.IntEnum):
    """Arguments of PRINCIPLED after the weight."""

    BASE_COLOR = 1
    METALLIC = 2
    ROUGHNESS = 3
    IOR = 4
    ALPHA = 5
    NORMAL = 6
    DIFFUSE_ROUGHNESS = 7
    SPECULAR_LEVEL = 8
    SPECULAR_TINT = 9
    TRANSMISSION = 10
    COAT = 11
    COAT_ROUGHNESS = 12
    COAT_IOR = 13
    COAT_TINT = 14
    COAT_NORMAL = 15
    SHEEN = 16
    SHEEN_ROUGHNESS = 17
    SHEEN_TINT = 18
    EMISSION = 19
