// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_normal.h"

#include <optional>

#include "shader_math.h"

namespace photon_maps {

namespace {

/// Axes of a tangent space in the object's space, not normalised, as the corners' are mixed.
struct TangentSpace {
    Vec3 tangent, bitangent, normal;
};

/// The normals at a triangle's corners in the object's space, on the front.
std::array<Vec3, 3> corner_normals(const ShaderPoint &point, const Instance &instance) {
    const SurfacePoint &hit = *point.hit;
    const Mesh &mesh = point.scene.meshes[instance.mesh];
    const Vec3 front = hit.is_backfacing ? -hit.normal : hit.normal;
    const Vec3 flat = to_object_normal(point, front);
    std::array<Vec3, 3> normals = {flat, flat, flat};
    if (mesh.corner_normals.empty()) return normals;
    for (size_t corner = 0; corner < 3; ++corner) {
        const Vec3 given = mesh.corner_normals[3 * size_t{hit.triangle} + corner];
        normals[corner] = safe_normalize(instance.place.inverse_normal(instance.transform.normal(given)), flat);
    }
    return normals;
}

/// Where u grows, at right angles to each corner's normal, and what lies across by the side that the UV map shows.
/// @return nothing where the triangle has no UV map, or one without area
std::optional<TangentSpace> tangent_space(const ShaderPoint &point, uint32_t uv_id) {
    const SurfacePoint &hit = *point.hit;
    const Instance &instance = point.scene.instances[hit.instance];
    std::array<Rgba, 3> uv;
    if (!corner_values(point.scene.meshes[instance.mesh], uv_id, hit.triangle, uv)) return {};
    const WorldTriangle t = point.scene.world_triangle(hit.instance, hit.triangle);
    const Vec3 ab = instance.place.inverse_vector(t.b - t.a), ac = instance.place.inverse_vector(t.c - t.a);
    const Vec3 uv_ab = uv[1].color - uv[0].color, uv_ac = uv[2].color - uv[0].color;
    const float area = uv_ab.x * uv_ac.y - uv_ac.x * uv_ab.y;
    const float side = area < 0 ? -1.0f : 1.0f;
    const Vec3 along_u = (ab * uv_ac.y - ac * uv_ab.y) * side;
    if (area == 0 || !(length_squared(along_u) > 0)) return {};

    TangentSpace space;
    const std::array<Vec3, 3> normals = corner_normals(point, instance);
    const std::array<float, 3> weights = {1 - hit.u - hit.v, hit.u, hit.v};
    for (size_t corner = 0; corner < 3; ++corner) {
        const Vec3 n = normals[corner];
        space.tangent += safe_normalize(along_u - n * dot(n, along_u)) * weights[corner];
        space.normal += n * weights[corner];
    }
    space.bitangent = cross(space.normal, space.tangent) * side;
    return space;
}

/// Fresnel's equations for light that is not polarised; 1 where all of it is reflected.
float dielectric_reflectance(float cosine, float ior) {
    const float c = std::abs(cosine), squared = ior * ior - 1 + c * c;
    if (squared <= 0) return 1;
    const float g = std::sqrt(squared);
    const float a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return 0.5f * a * a * (1 + b * b);
}

bool is_back(const ShaderPoint &point) { return point.hit && point.hit->is_backfacing; }

}  // namespace

Vec3 normal_map(const ShaderPoint &point, uint32_t option, float strength, Vec3 color) {
    const Vec3 unperturbed = shading_normal(point);
    if (!point.hit) return unperturbed;
    const Transform &place = point.scene.instances[point.hit->instance].place;
    const Vec3 local = color * 2 - splat(1);
    Vec3 normal;
    if ((option & 0xff) == PM_NORMAL_TANGENT) {
        const std::optional<TangentSpace> space = tangent_space(point, option >> 8);
        if (!space) return unperturbed;
        normal = safe_normalize(space->tangent * (local.x * strength) + space->bitangent * (local.y * strength) +
                                space->normal * (1 + (local.z - 1) * saturate(strength)));
        normal = place.normal(normal);
    } else {
        normal = (option & 0xff) == PM_NORMAL_OBJECT ? place.normal(local) : local;
    }
    normal = safe_normalize(normal);
    if (is_back(point)) normal = -normal;
    if ((option & 0xff) != PM_NORMAL_TANGENT && strength != 1)
        normal = unperturbed + (normal - unperturbed) * std::max(strength, 0.0f);
    return safe_normalize(normal, unperturbed);
}

Vec3 bump(const ShaderPoint &point, bool is_inverted, const Operands &a) {
    const Vec3 normal = a[5];
    if (!point.hit) return normal;
    const float strength = std::max(a.number(0), 0.0f), distance = is_inverted ? -a.number(1) : a.number(1);
    const Vec3 step_1 = surface_step(point, 1).offset, step_2 = surface_step(point, 2).offset;
    const float step = length(step_1);
    const Vec3 along_1 = step_1 / step, along_2 = step_2 / step;
    const Vec3 r1 = cross(along_2, normal), r2 = cross(normal, along_1);
    const float determinant = dot(along_1, r1);
    const Vec3 gradient = (r1 * (a.number(3) - a.number(2)) + r2 * (a.number(4) - a.number(2))) / step;
    const Vec3 bumped =
        safe_normalize(normal * std::abs(determinant) - gradient * (determinant < 0 ? -distance : distance));
    if (bumped == Vec3()) return normal;
    return safe_normalize(bumped * strength + normal * (1 - strength), normal);
}

float fresnel(const ShaderPoint &point, float ior, Vec3 normal) {
    const float n = std::max(ior, 1e-5f);
    return dielectric_reflectance(dot(point.outgoing, normal), is_back(point) ? 1 / n : n);
}

float layer_fresnel(const ShaderPoint &point, float blend, Vec3 normal) {
    const float n = std::max(1 - blend, 1e-5f);
    return dielectric_reflectance(dot(point.outgoing, normal), is_back(point) ? n : 1 / n);
}

float layer_facing(const ShaderPoint &point, float blend, Vec3 normal) {
    const float cosine = std::abs(dot(point.outgoing, normal));
    if (blend == 0.5f) return 1 - cosine;
    const float b = std::clamp(blend, 0.0f, 1 - 1e-5f);
    return 1 - std::pow(cosine, b < 0.5f ? 2 * b : 0.5f / (1 - b));
}

}  // namespace photon_maps
