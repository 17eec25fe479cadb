// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and vectors of shaders, as Blender's nodes Math, Vector Math, Map Range, Mapping, Vector Rotate have them.
#pragma once

#include "photon_maps_shader.h"
#include "shader_ops.h"
#include "vec.h"

namespace photon_maps {

/// a / b; 0 where b is 0.
constexpr float safe_divide(float a, float b) { return b != 0 ? a / b : 0; }
constexpr Vec3 safe_divide(Vec3 a, Vec3 b) {
    return {safe_divide(a.x, b.x), safe_divide(a.y, b.y), safe_divide(a.z, b.z)};
}
/// A unit vector; `fallback` where there is no direction.
inline Vec3 safe_normalize(Vec3 v, Vec3 fallback = {}) {
    const float squared = length_squared(v);
    return squared > 0 && std::isfinite(squared) ? v / std::sqrt(squared) : fallback;
}
constexpr Vec3 splat(float v) { return {v, v, v}; }
/// Between 0 and 1; not a number becomes 0.
constexpr float saturate(float v) { return v > 0 ? std::min(v, 1.0f) : 0; }
constexpr Vec3 saturate(Vec3 v) { return {saturate(v.x), saturate(v.y), saturate(v.z)}; }
/// A function of the components, each by itself.
template <class Function>
constexpr Vec3 by_component(Function function, Vec3 a) {
    return {function(a.x), function(a.y), function(a.z)};
}
template <class Function>
constexpr Vec3 by_component(Function function, Vec3 a, Vec3 b) {
    return {function(a.x, b.x), function(a.y, b.y), function(a.z, b.z)};
}

/// PM_OP_MATH.
Vec3 math(pm_math op, const Operands &arguments);
/// PM_OP_VECTOR.
Vec3 vector_math(pm_vector op, const Operands &arguments);
/// PM_OP_MAP_RANGE.
Vec3 map_range(pm_map_range type, const Operands &arguments);
/// PM_OP_MAPPING.
Vec3 mapping(pm_mapping type, Vec3 vector, Vec3 location, Vec3 rotation, Vec3 scale);
/// PM_OP_ROTATE.
Vec3 rotate(pm_rotate type, Vec3 vector, Vec3 center, Vec3 axis, float angle, Vec3 rotation);

/// Returns the rotation by Euler angles: about x, then y, then z.
Transform euler_rotation(Vec3 angles);

}  // namespace photon_maps
