// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_inputs.h"

#include "shader_math.h"

namespace photon_maps {

namespace {

constexpr float bump_filter_width = 0.1f;

const Instance &instance_of(const ShaderPoint &point) { return point.scene.instances[point.hit->instance]; }

Vec3 position(const ShaderPoint &point, uint32_t shift) {
    if (!point.hit) return -point.outgoing;
    return shift == 0 ? point.hit->position : point.hit->position + surface_step(point, shift).offset;
}

/// Cycles' axes of a camera: it looks along +z, a panoramic one along +x.
Vec3 to_camera_axes(const View &view, Vec3 v) {
    return view.type == PM_CAMERA_EQUIRECTANGULAR ? Vec3{-v.z, -v.x, v.y} : Vec3{v.x, v.y, -v.z};
}
Vec3 from_camera_axes(const View &view, Vec3 v) {
    return view.type == PM_CAMERA_EQUIRECTANGULAR ? Vec3{-v.y, v.z, -v.x} : Vec3{v.x, v.y, -v.z};
}

/// In the camera's own axes; directions out of the scene are directions.
Vec3 in_view(const ShaderPoint &point, uint32_t shift) {
    const Transform &to_camera = point.scene.view.world_to_camera;
    const Vec3 p = position(point, shift);
    return point.hit ? to_camera.point(p) : to_camera.vector(p);
}

Vec3 window_position(const ShaderPoint &point, uint32_t shift) {
    const View &view = point.scene.view;
    const Vec3 p = in_view(point, shift);
    float x = p.x, y = p.y;
    if (view.type == PM_CAMERA_PERSPECTIVE) {
        x = safe_divide(p.x, -p.z);
        y = safe_divide(p.y, -p.z);
    } else if (view.type == PM_CAMERA_EQUIRECTANGULAR) {
        x = std::atan2(p.x, -p.z);
        y = std::asin(std::clamp(safe_normalize(p).y, -1.0f, 1.0f));
    }
    return {(x - view.left) / (view.right - view.left), (y - view.bottom) / (view.top - view.bottom), 0};
}

/// Texture Coordinate's Normal; a step along the surface leads to another smooth normal.
Vec3 object_normal(const ShaderPoint &point, uint32_t shift) {
    if (!point.hit || shift == 0) return to_object_normal(point, shading_normal(point));
    const SurfacePoint &hit = *point.hit;
    const SurfaceStep step = surface_step(point, shift);
    const SurfacePoint moved =
        point.scene.surface_point(hit.instance, hit.triangle, hit.u + step.du, hit.v + step.dv, -point.outgoing);
    return to_object_normal(point, moved.shading_normal);
}

Vec3 parametric(const ShaderPoint &point, uint32_t shift) {
    if (!point.hit) return {};
    const SurfaceStep step = surface_step(point, shift);
    const float u = point.hit->u + step.du, v = point.hit->v + step.dv;
    return {1 - u - v, u, 0};
}

Vec3 reflection(const ShaderPoint &point) {
    if (!point.hit) return point.outgoing;
    const Vec3 normal = shading_normal(point);
    return normal * (2 * dot(normal, point.outgoing)) - point.outgoing;
}

Vec3 geometry(const ShaderPoint &point, pm_input kind, uint32_t shift) {
    switch (kind) {
        case PM_INPUT_POSITION:
            return position(point, shift);
        case PM_INPUT_NORMAL:
            return shading_normal(point);
        case PM_INPUT_GEOMETRIC_NORMAL:
            return point.hit ? point.hit->normal : point.outgoing;
        case PM_INPUT_INCOMING:
            return point.outgoing;
        case PM_INPUT_PARAMETRIC:
            return parametric(point, shift);
        case PM_INPUT_BACKFACING:
            return splat(point.hit && point.hit->is_backfacing ? 1 : 0);
        case PM_INPUT_OBJECT_POSITION:
            return point.hit ? instance_of(point).place.inverse_point(position(point, shift)) : position(point, shift);
        case PM_INPUT_OBJECT_NORMAL:
            return object_normal(point, shift);
        case PM_INPUT_CAMERA_POSITION:
            return to_camera_axes(point.scene.view, in_view(point, shift));
        case PM_INPUT_WINDOW:
            return window_position(point, shift);
        default:
            return reflection(point);
    }
}

Vec3 object_info(const ShaderPoint &point, pm_input kind) {
    if (kind == PM_INPUT_MATERIAL_INDEX) return splat(static_cast<float>(point.material.index));
    if (!point.hit) return {};
    const Instance &instance = instance_of(point);
    switch (kind) {
        case PM_INPUT_OBJECT_LOCATION:
            return instance.place.origin;
        case PM_INPUT_OBJECT_COLOR:
            return instance.color.color;
        case PM_INPUT_OBJECT_ALPHA:
            return splat(instance.color.alpha);
        case PM_INPUT_OBJECT_INDEX:
            return splat(instance.index);
        default:
            return splat(instance.random);
    }
}

float light_path(const RayState &ray, pm_input kind) {
    const auto is = [&](pm_ray k) { return ray.kinds >> k & 1u ? 1.0f : 0.0f; };
    switch (kind) {
        case PM_INPUT_IS_CAMERA_RAY:
            return is(PM_RAY_CAMERA);
        case PM_INPUT_IS_SHADOW_RAY:
            return is(PM_RAY_SHADOW);
        case PM_INPUT_IS_DIFFUSE_RAY:
            return is(PM_RAY_DIFFUSE);
        case PM_INPUT_IS_GLOSSY_RAY:
            return is(PM_RAY_GLOSSY);
        case PM_INPUT_IS_SINGULAR_RAY:
            return ray.is_singular ? 1 : 0;
        case PM_INPUT_IS_REFLECTION_RAY:
            return ray.is_reflection ? 1 : 0;
        case PM_INPUT_IS_TRANSMISSION_RAY:
            return is(PM_RAY_TRANSMISSION);
        case PM_INPUT_RAY_LENGTH:
            return ray.length;
        case PM_INPUT_RAY_DEPTH:
            return ray.depth;
        case PM_INPUT_DIFFUSE_DEPTH:
            return ray.diffuse_depth;
        case PM_INPUT_GLOSSY_DEPTH:
            return ray.glossy_depth;
        case PM_INPUT_TRANSPARENT_DEPTH:
            return ray.transparent_depth;
        case PM_INPUT_TRANSMISSION_DEPTH:
            return ray.transmission_depth;
        default:
            return 0;
    }
}

/// One value of an attribute: numbers are repeated, pairs end in 0, the fourth is alpha.
Rgba value_at(const Attribute &attribute, size_t element) {
    const float *v = &attribute.values[element * attribute.channels];
    if (attribute.channels == 1) return {splat(v[0]), 1};
    if (attribute.channels == 2) return {{v[0], v[1], 0}, 1};
    return {{v[0], v[1], v[2]}, attribute.channels == 4 ? v[3] : 1};
}

enum Space : uint32_t { world_space, object_space, camera_space };

/// A vector, point or normal as one transform takes it there, or back.
Vec3 through(const Transform &t, uint32_t kind, Vec3 v) {
    return kind == 0 ? t.vector(v) : kind == 1 ? t.point(v) : safe_normalize(t.normal(v));
}
Vec3 back_through(const Transform &t, uint32_t kind, Vec3 v) {
    return kind == 0 ? t.inverse_vector(v) : kind == 1 ? t.inverse_point(v) : safe_normalize(t.inverse_normal(v));
}

}  // namespace

SurfaceStep surface_step(const ShaderPoint &point, uint32_t shift) {
    if (shift == 0 || !point.hit) return {};
    const SurfacePoint &hit = *point.hit;
    const WorldTriangle t = point.scene.world_triangle(hit.instance, hit.triangle);
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac);
    const float squared = length_squared(normal);
    const float wanted =
        point.ray.footprint > 0 ? bump_filter_width * point.ray.footprint : 1e-3f * std::sqrt(std::sqrt(squared));
    const Frame frame(hit.normal);
    // Less than the position's error is no step.
    const Vec3 offset = (shift == 1 ? frame.x : frame.y) * std::max(wanted, 64 * hit.error);
    if (!(squared > 0)) return {offset};
    return {offset, dot(offset, cross(ac, normal)) / squared, dot(offset, cross(normal, ab)) / squared};
}

Vec3 to_object_normal(const ShaderPoint &point, Vec3 normal) {
    return point.hit ? safe_normalize(instance_of(point).place.inverse_normal(normal)) : normal;
}

Vec3 input(const ShaderPoint &point, pm_input kind, uint32_t shift) {
    if (kind <= PM_INPUT_REFLECTION) return geometry(point, kind, shift);
    if (kind <= PM_INPUT_MATERIAL_INDEX) return object_info(point, kind);
    return splat(light_path(point.ray, kind));
}

bool corner_values(const Mesh &mesh, uint32_t id, uint32_t triangle, std::array<Rgba, 3> &values) {
    for (const Attribute &attribute : mesh.attributes) {
        if (attribute.id != id) continue;
        for (size_t corner = 0; corner < 3; ++corner) {
            const size_t element = attribute.domain == PM_DOMAIN_VERTEX ? mesh.triangles[triangle][corner]
                                   : attribute.domain == PM_DOMAIN_FACE ? triangle
                                                                        : 3 * size_t{triangle} + corner;
            values[corner] = value_at(attribute, element);
        }
        return true;
    }
    values = {Rgba{{}, 0}, Rgba{{}, 0}, Rgba{{}, 0}};
    return false;
}

Rgba attribute(const ShaderPoint &point, uint32_t id, uint32_t shift) {
    if (!point.hit) return {{}, 0};
    const SurfacePoint &hit = *point.hit;
    std::array<Rgba, 3> corners;
    corner_values(point.scene.meshes[instance_of(point).mesh], id, hit.triangle, corners);
    const SurfaceStep step = surface_step(point, shift);
    const float u = hit.u + step.du, v = hit.v + step.dv, w = 1 - u - v;
    return {corners[0].color * w + corners[1].color * u + corners[2].color * v,
            corners[0].alpha * w + corners[1].alpha * u + corners[2].alpha * v};
}

Vec3 transform(const ShaderPoint &point, uint32_t option, Vec3 v) {
    const uint32_t kind = option % 3, from = option / 3 % 3, to = option / 9;
    if (from == to) return v;
    const View &view = point.scene.view;
    if (from == object_space && point.hit) v = through(instance_of(point).place, kind, v);
    if (from == camera_space) v = back_through(view.world_to_camera, kind, from_camera_axes(view, v));
    if (to == object_space && point.hit) v = back_through(instance_of(point).place, kind, v);
    if (to == camera_space) v = to_camera_axes(view, through(view.world_to_camera, kind, v));
    return v;
}

}  // namespace photon_maps
