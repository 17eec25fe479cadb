// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors in single precision: points, directions, RGB triples; and affine transforms.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace photon_maps {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A point, a direction or an RGB triple.
struct Vec3 {
    float x = 0, y = 0, z = 0;

    constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr Vec3 &operator+=(Vec3 b) {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vec3 &operator*=(Vec3 b) {
        x *= b.x;
        y *= b.y;
        z *= b.z;
        return *this;
    }
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr float length_squared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { return a * (1 / length(a)); }
constexpr float max_component(Vec3 a) { return std::max(a.x, std::max(a.y, a.z)); }
constexpr float average(Vec3 a) { return (a.x + a.y + a.z) / 3; }
constexpr Vec3 min(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
constexpr Vec3 max(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
constexpr Vec3 mix(Vec3 a, Vec3 b, float share) { return a * (1 - share) + b * share; }
inline Vec3 abs(Vec3 a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// An orthonormal basis whose z is a given unit vector (Duff et al. 2017, JCGT 6(1)).
struct Frame {
    Vec3 x, y, z;

    explicit Frame(Vec3 unit_z) : z(unit_z) {
        const float sign = std::copysign(1.0f, z.z);
        const float a = -1 / (sign + z.z);
        const float b = z.x * z.y * a;
        x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
        y = {b, sign + z.y * z.y * a, -z.y};
    }
    Vec3 to_world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

/// A 3x4 affine transform by its columns: world = x*p.x + y*p.y + z*p.z + origin.
struct Transform {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

    /// Reads 12 floats, row-major.
    static Transform from_rows(const float *m) {
        return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
    }
    constexpr Vec3 vector(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
    constexpr Vec3 point(Vec3 p) const { return vector(p) + origin; }
    constexpr float determinant() const { return dot(x, cross(y, z)); }
    /// A normal by the cofactor matrix: right under mirrored and non-uniform scale; not normalised.
    constexpr Vec3 normal(Vec3 n) const {
        const Vec3 v = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
        return determinant() < 0 ? -v : v;
    }
    /// The vector that vector() takes to v; 0 if the transform flattens.
    constexpr Vec3 inverse_vector(Vec3 v) const {
        const float d = determinant();
        return d == 0 ? Vec3() : Vec3{dot(cross(y, z), v), dot(cross(z, x), v), dot(cross(x, y), v)} / d;
    }
    constexpr Vec3 inverse_point(Vec3 p) const { return inverse_vector(p - origin); }
    /// The normal that normal() takes to n, but for its length.
    constexpr Vec3 inverse_normal(Vec3 n) const { return {dot(x, n), dot(y, n), dot(z, n)}; }
};

}  // namespace photon_maps
