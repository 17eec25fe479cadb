// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_math.h"

namespace photon_maps {

namespace {

float power(float a, float b) {
    if (a < 0 && b != std::trunc(b)) return 0;
    if (b == 0) return 1;
    return a == 0 ? 0 : std::pow(a, b);
}

float logarithm(float a, float base) { return a <= 0 || base <= 0 ? 0 : safe_divide(std::log(a), std::log(base)); }

float sign(float a) { return a == 0 ? 0.0f : a < 0 ? -1.0f : 1.0f; }

/// The polynomial smooth minimum (Quilez), cubic.
float smooth_minimum(float a, float b, float distance) {
    if (distance == 0) return std::min(a, b);
    const float h = std::max(distance - std::abs(a - b), 0.0f) / distance;
    return std::min(a, b) - h * h * h * distance / 6;
}

float wrap(float value, float greatest, float least) {
    const float range = greatest - least;
    return range != 0 ? value - range * std::floor((value - least) / range) : least;
}

float ping_pong(float a, float scale) {
    if (scale == 0) return 0;
    const float phase = (a - scale) / (2 * scale);
    return std::abs((phase - std::floor(phase)) * scale * 2 - scale);
}

float math(pm_math op, float a, float b, float c) {
    switch (op) {
        case PM_MATH_ADD:
            return a + b;
        case PM_MATH_SUBTRACT:
            return a - b;
        case PM_MATH_MULTIPLY:
            return a * b;
        case PM_MATH_DIVIDE:
            return safe_divide(a, b);
        case PM_MATH_MULTIPLY_ADD:
            return a * b + c;
        case PM_MATH_POWER:
            return power(a, b);
        case PM_MATH_LOGARITHM:
            return logarithm(a, b);
        case PM_MATH_SQRT:
            return std::sqrt(std::max(a, 0.0f));
        case PM_MATH_INVERSE_SQRT:
            return a > 0 ? 1 / std::sqrt(a) : 0;
        case PM_MATH_ABSOLUTE:
            return std::abs(a);
        case PM_MATH_EXPONENT:
            return std::exp(a);
        case PM_MATH_MINIMUM:
            return std::fmin(a, b);
        case PM_MATH_MAXIMUM:
            return std::fmax(a, b);
        case PM_MATH_LESS_THAN:
            return a < b ? 1 : 0;
        case PM_MATH_GREATER_THAN:
            return a > b ? 1 : 0;
        case PM_MATH_SIGN:
            return sign(a);
        case PM_MATH_COMPARE:
            return a == b || std::abs(a - b) <= std::max(c, std::numeric_limits<float>::epsilon()) ? 1 : 0;
        case PM_MATH_SMOOTH_MIN:
            return smooth_minimum(a, b, c);
        case PM_MATH_SMOOTH_MAX:
            return -smooth_minimum(-a, -b, c);
        case PM_MATH_ROUND:
            return std::floor(a + 0.5f);
        case PM_MATH_FLOOR:
            return std::floor(a);
        case PM_MATH_CEIL:
            return std::ceil(a);
        case PM_MATH_TRUNC:
            return std::trunc(a);
        case PM_MATH_FRACT:
            return a - std::floor(a);
        case PM_MATH_MODULO:
            return b != 0 ? std::fmod(a, b) : 0;
        case PM_MATH_FLOORED_MODULO:
            return b != 0 ? a - std::floor(a / b) * b : 0;
        case PM_MATH_WRAP:
            return wrap(a, b, c);
        case PM_MATH_SNAP:
            return std::floor(safe_divide(a, b)) * b;
        case PM_MATH_PINGPONG:
            return ping_pong(a, b);
        case PM_MATH_SINE:
            return std::sin(a);
        case PM_MATH_COSINE:
            return std::cos(a);
        case PM_MATH_TANGENT:
            return std::tan(a);
        case PM_MATH_ARCSINE:
            return std::asin(std::clamp(a, -1.0f, 1.0f));
        case PM_MATH_ARCCOSINE:
            return std::acos(std::clamp(a, -1.0f, 1.0f));
        case PM_MATH_ARCTANGENT:
            return std::atan(a);
        case PM_MATH_ARCTAN2:
            return a == 0 && b == 0 ? 0 : std::atan2(a, b);
        case PM_MATH_SINH:
            return std::sinh(a);
        case PM_MATH_COSH:
            return std::cosh(a);
        case PM_MATH_TANH:
            return std::tanh(a);
        case PM_MATH_RADIANS:
            return a * (pi / 180);
        case PM_MATH_DEGREES:
            return a * (180 / pi);
        case PM_MATH_COUNT:
            break;
    }
    return 0;
}

constexpr bool is_number(Vec3 v) { return v.x == v.y && v.y == v.z; }

Vec3 refract(Vec3 incident, Vec3 normal, float ratio) {
    const float cosine = dot(normal, incident);
    const float k = 1 - ratio * ratio * (1 - cosine * cosine);
    return k < 0 ? Vec3{} : incident * ratio - normal * (ratio * cosine + std::sqrt(k));
}

/// Hermite's step and Perlin's, of a share between 0 and 1.
float smooth_step(float t) { return t * t * (3 - 2 * t); }
float smoother_step(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float map_range(pm_map_range type, float value, float from_min, float from_max, float to_min, float to_max,
                float steps) {
    if (from_max == from_min) return 0;
    float factor = (value - from_min) / (from_max - from_min);
    switch (type) {
        case PM_MAP_RANGE_STEPPED:
            factor = steps > 0 ? std::floor(factor * (steps + 1)) / steps : 0;
            break;
        case PM_MAP_RANGE_SMOOTHSTEP:
            factor = smooth_step(saturate(factor));
            break;
        case PM_MAP_RANGE_SMOOTHERSTEP:
            factor = smoother_step(saturate(factor));
            break;
        case PM_MAP_RANGE_LINEAR:
        case PM_MAP_RANGE_COUNT:
            break;
    }
    return to_min + factor * (to_max - to_min);
}

/// By the transpose, which is a rotation's inverse.
Vec3 unrotated(const Transform &rotation, Vec3 v) {
    return {dot(rotation.x, v), dot(rotation.y, v), dot(rotation.z, v)};
}

/// Rodrigues' formula.
Vec3 rotate_about(Vec3 v, Vec3 unit_axis, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(unit_axis, v) * s + unit_axis * (dot(unit_axis, v) * (1 - c));
}

}  // namespace

Vec3 math(pm_math op, const Operands &arguments) {
    const size_t count = arguments.indices.size();
    const Vec3 a = arguments[0], b = count > 1 ? arguments[1] : Vec3(), c = count > 2 ? arguments[2] : Vec3();
    if (op == PM_MATH_MULTIPLY) return a * b;
    if (op == PM_MATH_ADD) return a + b;
    const float x = math(op, a.x, b.x, c.x);
    if (is_number(a) && is_number(b) && is_number(c)) return splat(x);
    return {x, math(op, a.y, b.y, c.y), math(op, a.z, b.z, c.z)};
}

Vec3 vector_math(pm_vector op, const Operands &arguments) {
    const Vec3 a = arguments[0];
    switch (op) {
        case PM_VECTOR_CROSS:
            return cross(a, arguments[1]);
        case PM_VECTOR_DOT:
            return splat(dot(a, arguments[1]));
        case PM_VECTOR_LENGTH:
            return splat(length(a));
        case PM_VECTOR_DISTANCE:
            return splat(length(a - arguments[1]));
        case PM_VECTOR_NORMALIZE:
            return safe_normalize(a);
        case PM_VECTOR_PROJECT: {
            const Vec3 onto = arguments[1];
            return onto * safe_divide(dot(a, onto), length_squared(onto));
        }
        case PM_VECTOR_REFLECT: {
            const Vec3 normal = safe_normalize(arguments[1]);
            return a - normal * (2 * dot(a, normal));
        }
        case PM_VECTOR_REFRACT:
            return refract(a, safe_normalize(arguments[1]), arguments.number(2));
        case PM_VECTOR_FACEFORWARD:
            return dot(arguments[2], arguments[1]) < 0 ? a : -a;
        case PM_VECTOR_COUNT:
            break;
    }
    return {};
}

Vec3 map_range(pm_map_range type, const Operands &a) {
    const auto component = [&](int i) { return map_range(type, a[0][i], a[1][i], a[2][i], a[3][i], a[4][i], a[5][i]); };
    return {component(0), component(1), component(2)};
}

Transform euler_rotation(Vec3 angles) {
    const float cx = std::cos(angles.x), cy = std::cos(angles.y), cz = std::cos(angles.z);
    const float sx = std::sin(angles.x), sy = std::sin(angles.y), sz = std::sin(angles.z);
    return {{cy * cz, cy * sz, -sy},
            {sy * sx * cz - cx * sz, sy * sx * sz + cx * cz, cy * sx},
            {sy * cx * cz + sx * sz, sy * cx * sz - sx * cz, cy * cx},
            {}};
}

Vec3 mapping(pm_mapping type, Vec3 vector, Vec3 location, Vec3 rotation, Vec3 scale) {
    const Transform turn = euler_rotation(rotation);
    switch (type) {
        case PM_MAPPING_POINT:
            return turn.vector(vector * scale) + location;
        case PM_MAPPING_TEXTURE:
            return safe_divide(unrotated(turn, vector - location), scale);
        case PM_MAPPING_VECTOR:
            return turn.vector(vector * scale);
        case PM_MAPPING_NORMAL:
            return safe_normalize(turn.vector(safe_divide(vector, scale)));
        case PM_MAPPING_COUNT:
            break;
    }
    return {};
}

Vec3 rotate(pm_rotate type, Vec3 vector, Vec3 center, Vec3 axis, float angle, Vec3 rotation) {
    const Vec3 v = vector - center;
    if (type == PM_ROTATE_EULER) return euler_rotation(rotation).vector(v) + center;
    if (type == PM_ROTATE_EULER_INVERSE) return unrotated(euler_rotation(rotation), v) + center;
    const float axis_length = length(axis);
    return axis_length != 0 ? rotate_about(v, axis / axis_length, angle) + center : vector;
}

}  // namespace photon_maps
