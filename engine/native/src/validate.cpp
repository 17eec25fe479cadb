// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate.h"

#include <algorithm>
#include <cmath>

#include "convert.h"

namespace photon_maps {

namespace {

constexpr float min_radius = 1e-12f;    // its square is still a normal number
constexpr float least_extent = 1e-15f;  // likewise

/// A finite number in [low, high].
void require_range(float value, float low, float high, const std::string &name) {
    require(value >= low && value <= high,
            name + " is " + std::to_string(value) + ", outside " + std::to_string(low) + " to " + std::to_string(high));
}

void require_coordinates(std::span<const float> values, const std::string &name) {
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float v) { return !(std::abs(v) <= max_coordinate); });
    if (bad == values.end()) return;
    throw InvalidArgument(name + ": number " + std::to_string(bad - values.begin()) + " is " + std::to_string(*bad) +
                          ", not finite or beyond 1e9");
}

void require_indices(std::span<const uint32_t> indices, size_t limit, const std::string &name) {
    const auto bad = std::find_if(indices.begin(), indices.end(), [limit](uint32_t i) { return i >= limit; });
    if (bad == indices.end()) return;
    throw InvalidArgument(name + ": entry " + std::to_string(bad - indices.begin()) + " is " + std::to_string(*bad) +
                          ", but there are only " + std::to_string(limit));
}

float column_length(const float *transform, int column) {
    return std::hypot(transform[column], transform[4 + column], transform[8 + column]);
}

}  // namespace

void require_struct_size(size_t given, size_t expected, const char *name) {
    require(given == expected, std::string(name) + " has struct_size " + std::to_string(given) + ", expected " +
                                   std::to_string(expected) + ": the caller was built for another version");
}

void validate_count(uint64_t count, const std::string &name) {
    require(count < 0xffffffffu, "there may be at most 2^32 - 2 " + name + ", not " + std::to_string(count));
}

void validate(const pm_mesh &mesh) {
    require_struct_size(mesh.struct_size, sizeof(pm_mesh), "pm_mesh");
    validate_count(mesh.vertex_count, "vertices");
    require(mesh.triangle_count < 0xffffffffu / 3, "a mesh may have at most 2^32 / 3 triangles");
    require(mesh.vertices || mesh.vertex_count == 0, "the mesh's vertices are null");
    require(mesh.triangles || mesh.triangle_count == 0, "the mesh's triangles are null");
    require_coordinates({mesh.vertices, 3 * mesh.vertex_count}, "vertices");
    require_indices({mesh.triangles, 3 * mesh.triangle_count}, mesh.vertex_count, "triangles");
    if (mesh.corner_normals) require_coordinates({mesh.corner_normals, 9 * mesh.triangle_count}, "corner_normals");
    require(mesh.attributes || mesh.attribute_count == 0, "the mesh's attributes are null");
    for (uint32_t a = 0; a < mesh.attribute_count; ++a) {
        const pm_attribute &attribute = mesh.attributes[a];
        const std::string name = "attribute " + std::to_string(a);
        require_struct_size(attribute.struct_size, sizeof(pm_attribute), "pm_attribute");
        require(attribute.domain <= PM_DOMAIN_FACE, name + ": unknown domain " + std::to_string(attribute.domain));
        require(attribute.channels >= 1 && attribute.channels <= 4, name + ": channels are 1 to 4");
        const size_t count = value_count(mesh, attribute);
        require(attribute.values || count == 0, name + ": values are null");
        require_coordinates({attribute.values, count}, name);
    }
}

void validate(const pm_instances &instances, std::span<const uint32_t> mesh_slots, size_t material_count) {
    require_struct_size(instances.struct_size, sizeof(pm_instances), "pm_instances");
    const size_t count = instances.count;
    validate_count(count, "instances");
    validate_count(instances.slot_material_count, "slot_materials");
    require(count == 0 || (instances.meshes && instances.transforms && instances.first_slots),
            "an array of the instances is null");
    require(instances.slot_materials || instances.slot_material_count == 0, "slot_materials is null");
    require_indices({instances.meshes, count}, mesh_slots.size(), "meshes of the instances");
    require_coordinates({instances.transforms, 12 * count}, "transforms of the instances");
    require_indices({instances.slot_materials, instances.slot_material_count}, material_count, "slot_materials");
    for (size_t i = 0; i < count; ++i) {
        const size_t end = size_t{instances.first_slots[i]} + mesh_slots[instances.meshes[i]];
        require(end <= instances.slot_material_count, "instance " + std::to_string(i) + " needs " +
                                                          std::to_string(end) + " entries of slot_materials, of " +
                                                          std::to_string(instances.slot_material_count));
    }
}

void validate(const pm_light &light, size_t index) {
    const std::string name = "light " + std::to_string(index);
    require_struct_size(light.struct_size, sizeof(pm_light), "pm_light");
    require(light.type <= PM_LIGHT_ELLIPSE, name + ": unknown type " + std::to_string(light.type));
    require_coordinates(light.transform, name + ": transform");
    for (int column = 0; column < 3; ++column)
        require(column_length(light.transform, column) > least_extent,
                name + ": transform has no extent along an axis");
    validate_radiance(light.power, name + ": power");
    const bool is_area = light.type == PM_LIGHT_RECTANGLE || light.type == PM_LIGHT_ELLIPSE;
    const float max_size = light.type == PM_LIGHT_SUN ? pi : max_coordinate;
    for (const float v : light.size) require_range(v, 0, max_size, name + ": size");
    if (is_area) {
        require(light.size[0] >= least_extent && light.size[1] >= least_extent,
                name + ": an area light needs a size above 0");
        require_range(light.spread, 0, pi * 1.00001f, name + ": spread");
    }
    if (light.type == PM_LIGHT_SPOT) {
        require_range(light.spot_angle, 1e-4f, pi * 1.00001f, name + ": spot_angle");
        require_range(light.spot_blend, 0, 1, name + ": spot_blend");
    }
}

void validate(const pm_camera &camera) {
    require_struct_size(camera.struct_size, sizeof(pm_camera), "pm_camera");
    require(camera.type <= PM_CAMERA_EQUIRECTANGULAR, "camera: unknown type " + std::to_string(camera.type));
    require_coordinates(camera.transform, "camera: transform");
    for (int column = 0; column < 3; ++column)
        require(column_length(camera.transform, column) > least_extent,
                "camera: transform has no extent along an axis");
    require_coordinates(camera.window, "camera: window");
    require(camera.window[0] < camera.window[1] && camera.window[2] < camera.window[3], "camera: the window is empty");
    const auto [x, y, width, height] = std::to_array(camera.region);
    require(width > 0 && height > 0, "camera: the region is empty");
    require(camera.stride > 0, "camera: the stride is 0");
    const uint64_t stride = camera.stride;
    require(x + (width - 1) * stride < camera.resolution[0] && y + (height - 1) * stride < camera.resolution[1],
            "camera: the region, at its stride, reaches beyond the frame");
    require(camera.resolution[0] <= 65536 && camera.resolution[1] <= 65536,
            "camera: the resolution is beyond 65536 pixels");
    require(camera.clip_start >= 0 && camera.clip_end > camera.clip_start,
            "camera: clip_end must lie beyond clip_start, which may not be negative");
    require_range(camera.aperture_radius, 0, max_coordinate, "camera: aperture_radius");
    require(camera.aperture_radius == 0 || camera.focus_distance > 0, "camera: focus_distance must be above 0");
    require_range(camera.aperture_rotation, -max_coordinate, max_coordinate, "camera: aperture_rotation");
    require(camera.aperture_radius == 0 || (camera.aperture_ratio > 0 && std::isfinite(camera.aperture_ratio)),
            "camera: aperture_ratio must be above 0");
}

void validate(const pm_settings &settings) {
    require_struct_size(settings.struct_size, sizeof(pm_settings), "pm_settings");
    require(settings.integrator <= PM_REGULAR_SHADING, "unknown integrator " + std::to_string(settings.integrator));
    require(settings.photon_count <= 1'000'000'000, "photon_count is beyond 1e9");
    if (settings.radius != 0) require_range(settings.radius, min_radius, max_coordinate, "radius");
    require(settings.filter <= PM_FILTER_EPANECHNIKOV, "unknown filter " + std::to_string(settings.filter));
    require(settings.cone_k >= 1 && std::isfinite(settings.cone_k), "cone_k must be a finite number of at least 1");
    require(settings.estimate <= PM_ESTIMATE_ADAPTIVE, "unknown estimate " + std::to_string(settings.estimate));
    require(settings.nearest_count >= 1 && settings.nearest_count <= 1'000'000, "nearest_count must be from 1 to 1e6");
    require(settings.brdf_direction <= PM_BRDF_MEAN,
            "unknown brdf_direction " + std::to_string(settings.brdf_direction));
    require(settings.max_bounces <= 1024, "max_bounces is beyond 1024");
    require(settings.light_samples <= 1024, "light_samples is beyond 1024");
    require(settings.pixel_filter <= PM_PIXEL_BLACKMAN_HARRIS,
            "unknown pixel filter " + std::to_string(settings.pixel_filter));
    require_range(settings.pixel_filter_width, 0.01f, 100, "pixel_filter_width");
    require_range(settings.stop_error, 0, 1, "stop_error");
    require(settings.stop_error == 0 || ((settings.passes >> PM_PASS_ERROR) & 1) != 0,
            "stop_error needs PM_PASS_ERROR among the passes");
    require(settings.passes != 0 && settings.passes < (1u << PM_PASS_COUNT), "passes names unknown buffers, or none");
}

void validate_radiance(std::span<const float> radiance, const std::string &name) {
    for (const float v : radiance) require_range(v, 0, 1e15f, name);
}

}  // namespace photon_maps
