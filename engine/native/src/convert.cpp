// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert.h"

#include "memory_limit.h"
#include "parallel.h"

namespace photon_maps {

namespace {

std::vector<Vec3> points(const float *values, size_t count) {
    std::vector<Vec3> result(count);
    for (size_t i = 0; i < count; ++i) result[i] = vec3(values + 3 * i);
    return result;
}

/// Turns a transform's columns into unit vectors.
Transform rigid(const Transform &t) { return {normalize(t.x), normalize(t.y), normalize(t.z), t.origin}; }

}  // namespace

size_t value_count(const pm_mesh &mesh, const pm_attribute &attribute) {
    const size_t elements = attribute.domain == PM_DOMAIN_VERTEX ? mesh.vertex_count
                            : attribute.domain == PM_DOMAIN_FACE ? mesh.triangle_count
                                                                 : 3 * mesh.triangle_count;
    return elements * attribute.channels;
}

size_t pixel_size(const pm_image &image) {
    return image.channels * (image.type == PM_PIXEL_UINT8 ? 1u : image.type == PM_PIXEL_FLOAT16 ? 2u : 4u);
}

Mesh to_mesh(const pm_mesh &source) {
    Mesh mesh;
    mesh.vertices = points(source.vertices, source.vertex_count);
    mesh.vertices.emplace_back();  // for Embree's reads past the last one
    const size_t count = source.triangle_count;
    mesh.triangles.resize(count);
    for (size_t t = 0; t < count; ++t)
        for (size_t corner = 0; corner < 3; ++corner) mesh.triangles[t][corner] = source.triangles[3 * t + corner];
    if (source.slots) mesh.slots.assign(source.slots, source.slots + count);
    if (source.corner_normals) mesh.corner_normals = points(source.corner_normals, 3 * count);
    for (uint32_t a = 0; a < source.attribute_count; ++a) {
        const pm_attribute &attribute = source.attributes[a];
        mesh.attributes.push_back({attribute.id, static_cast<pm_domain>(attribute.domain), attribute.channels, {}});
        mesh.attributes.back().values.assign(attribute.values, attribute.values + value_count(source, attribute));
    }
    return mesh;
}

Lamp to_lamp(const pm_light &source) {
    Lamp lamp;
    lamp.type = static_cast<LightType>(source.type);
    lamp.transform = Transform::from_rows(source.transform);
    lamp.power = vec3(source.power);
    // A size whose square drowns is none.
    constexpr float least_size = 1e-12f;
    const bool is_area = source.type == PM_LIGHT_RECTANGLE || source.type == PM_LIGHT_ELLIPSE;
    lamp.width = is_area || source.size[0] >= least_size ? source.size[0] : 0;
    lamp.height = source.size[1];
    lamp.spot_angle = source.spot_angle;
    lamp.spot_blend = source.spot_blend;
    // Less than a degree is noise without end; Cycles stops there, too.
    lamp.spread = std::max(source.spread, pi / 180);
    lamp.soft_falloff = source.soft_falloff != 0;
    lamp.visibility = source.visibility;
    return lamp;
}

Camera to_camera(const pm_camera &source) {
    Camera camera;
    camera.type = static_cast<pm_camera_type>(source.type);
    camera.transform = rigid(Transform::from_rows(source.transform));
    camera.left = source.window[0];
    camera.right = source.window[1];
    camera.bottom = source.window[2];
    camera.top = source.window[3];
    camera.frame_width = source.resolution[0];
    camera.frame_height = source.resolution[1];
    camera.x = source.region[0];
    camera.y = source.region[1];
    camera.width = source.region[2];
    camera.height = source.region[3];
    camera.stride = source.stride;
    camera.clip_start = source.clip_start;
    camera.clip_end = source.clip_end;
    camera.aperture_radius = source.aperture_radius;
    camera.focus_distance = source.focus_distance;
    camera.aperture_rotation = source.aperture_rotation;
    camera.aperture_ratio = source.aperture_ratio;
    camera.aperture_blades = source.aperture_blades;
    return camera;
}

View to_view(const pm_camera &source) {
    const Transform t = rigid(Transform::from_rows(source.transform));
    View view;
    view.world_to_camera = {{t.x.x, t.y.x, t.z.x},
                            {t.x.y, t.y.y, t.z.y},
                            {t.x.z, t.y.z, t.z.z},
                            {-dot(t.x, t.origin), -dot(t.y, t.origin), -dot(t.z, t.origin)}};
    view.type = static_cast<pm_camera_type>(source.type);
    view.left = source.window[0];
    view.right = source.window[1];
    view.bottom = source.window[2];
    view.top = source.window[3];
    return view;
}

pm_photon to_pm_photon(const Photon &photon) {
    const Vec3 d = unpack_direction(photon.direction), n = unpack_normal(photon.normal);
    const Vec3 p = photon.position, f = photon.flux;
    return {{p.x, p.y, p.z}, {d.x, d.y, d.z}, {n.x, n.y, n.z}, {f.x, f.y, f.z}, photon.bounce()};
}

RenderSettings to_settings(const pm_settings &source) {
    RenderSettings settings;
    settings.integrator = static_cast<Integrator>(source.integrator);
    settings.photon_count = source.photon_count;
    settings.kernel = {static_cast<pm_filter>(source.filter), source.radius, source.cone_k};
    settings.nearest_count = source.estimate == PM_ESTIMATE_NEAREST ? source.nearest_count : 0;
    settings.is_nested = source.estimate == PM_ESTIMATE_ADAPTIVE;
    settings.mean_direction = source.brdf_direction == PM_BRDF_MEAN;
    settings.max_bounces = source.max_bounces;
    settings.use_caustics = source.use_caustics != 0;
    settings.use_indirect = source.use_indirect != 0;
    settings.use_final_gather = source.use_final_gather != 0 && settings.use_indirect;
    settings.use_shadow_photons = source.use_shadow_photons != 0;
    settings.use_photon_guiding = source.use_photon_guiding != 0;
    settings.seed = source.seed;
    settings.use_progressive = source.use_progressive != 0;
    settings.pixel_filter = static_cast<PixelFilter>(source.pixel_filter);
    settings.pixel_filter_width = source.pixel_filter_width;
    settings.film_transparent = source.film_transparent != 0;
    settings.keep_photons = source.keep_photons != 0;
    settings.stop_error = source.stop_error;
    settings.use_auto = source.use_auto != 0;
    settings.light_samples = source.light_samples;
    settings.memory_limit = memory_limit_or_usual(source.memory_limit);
    settings.threads = thread_count(source.threads);
    settings.buffers = source.passes;
    return settings;
}

std::vector<Instance> to_instances(const pm_instances &source) {
    std::vector<Instance> instances;
    instances.reserve(source.count);
    for (size_t i = 0; i < source.count; ++i) {
        const Transform place = Transform::from_rows(source.transforms + 12 * i);
        Instance &instance = instances.emplace_back();
        instance.mesh = source.meshes[i];
        instance.first_slot = source.first_slots[i];
        instance.transform = instance.place = place;
        if (source.visibility) instance.visibility = source.visibility[i];
        if (!source.properties) continue;
        const float *p = source.properties + 6 * i;
        instance.color = {{p[0], p[1], p[2]}, p[3]};
        instance.index = p[4];
        instance.random = p[5];
    }
    return instances;
}

Material to_material(const pm_material &source) {
    Material material;
    material.index = source.index;
    Program &program = material.program;
    program.constants = points(source.constants, source.constant_count);
    program.instructions.assign(source.instructions, source.instructions + source.instruction_count);
    program.arguments.assign(source.arguments, source.arguments + source.argument_count);
    return material;
}

Image to_image(const pm_image &source) {
    Image image{static_cast<pm_pixel_type>(source.type), source.width, source.height, source.channels, {}, {}};
    const auto *pixels = static_cast<const std::byte *>(source.pixels);
    image.pixels.assign(pixels, pixels + pixel_size(source) * source.width * source.height);
    if (source.decode)
        for (size_t i = 0; i < 256; ++i)
            image.decode[i] = {source.decode[3 * i], source.decode[3 * i + 1], source.decode[3 * i + 2]};
    return image;
}

Texture to_texture(const pm_texture &source) {
    Texture texture{static_cast<pm_interpolation>(source.interpolation),
                    static_cast<pm_extension>(source.extension),
                    static_cast<pm_projection>(source.projection),
                    static_cast<pm_alpha>(source.alpha),
                    source.blend,
                    {source.images, source.images + source.tile_count},
                    {}};
    if (source.tiles) texture.tiles.assign(source.tiles, source.tiles + source.tile_count);
    return texture;
}

Table to_table(const pm_table &source) {
    Table table{source.is_stepped != 0, {}};
    for (size_t i = 0; i < source.entry_count; ++i) {
        const float *entry = source.entries + 4 * i;
        table.entries.push_back({vec3(entry), entry[3]});
    }
    return table;
}

}  // namespace photon_maps
