// SPDX-License-Identifier: GPL-3.0-or-later
// A room as arrays for the C interface, and handles that release themselves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "check.h"
#include "photon_maps.h"
#include "photon_maps_shader.h"

namespace photon_maps::test {

template <auto Release>
struct Releaser {
    template <class Handle>
    void operator()(Handle *handle) const {
        Release(handle);
    }
};
using Device = std::unique_ptr<pm_device, Releaser<pm_device_release>>;
using Scene = std::unique_ptr<pm_scene, Releaser<pm_scene_release>>;
using Render = std::unique_ptr<pm_render, Releaser<pm_render_release>>;
using Snapshot = std::unique_ptr<pm_snapshot, Releaser<pm_snapshot_release>>;

constexpr std::array<float, 12> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// Arrays of a scene; as made, a unit cube seen from inside, lit by one lamp of every type and by its own walls.
struct Arrays {
    std::vector<float> vertices;
    std::vector<uint32_t> triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    std::vector<float> transforms{identity.begin(), identity.end()};
    std::vector<uint32_t> meshes = {0}, first_slots = {0}, slot_materials = {0};
    std::vector<float> constants = {0.7f, 0.5f, 0.3f, 0, 0, 0, 0.1f, 0.1f, 0.1f};
    std::vector<pm_instruction> instructions = {
        {PM_OP_INPUT, PM_INPUT_NORMAL, 0, 3, 0, 0}, {PM_OP_DIFFUSE, 0, 0, 4, 0, 3}, {PM_OP_EMISSION, 0, 0, 4, 3, 1}};
    std::vector<uint32_t> arguments = {0, 1, 3, 2};
    std::vector<pm_light> lights;
    uint32_t world = 0;
    pm_camera camera{};
    pm_settings settings{};

    Arrays() {
        for (unsigned corner = 0; corner < 8; ++corner)
            for (unsigned axis = 0; axis < 3; ++axis) vertices.push_back(corner >> axis & 1 ? 1.0f : 0.0f);
        for (uint32_t type = PM_LIGHT_POINT; type <= PM_LIGHT_ELLIPSE; ++type) {
            pm_light light{};
            light.struct_size = sizeof light;
            light.type = type;
            std::copy(identity.begin(), identity.end(), light.transform);
            light.transform[3] = light.transform[7] = 0.5f;
            light.transform[11] = 0.9f;
            light.power[0] = light.power[1] = light.power[2] = 1;
            light.size[0] = light.size[1] = 0.05f;
            light.spot_angle = light.spread = 1;
            lights.push_back(light);
        }
        camera = {
            sizeof camera, PM_CAMERA_PERSPECTIVE, {}, {-1, 1, -1, 1}, {8, 8}, {0, 0, 8, 8}, 0, 100, 0, 0, 0, 0, 0, 1};
        std::copy(identity.begin(), identity.end(), camera.transform);
        camera.transform[3] = camera.transform[7] = 0.4f;
        camera.transform[11] = 0.8f;
        settings.struct_size = sizeof settings;
        settings.photon_count = 500;
        settings.use_caustics = settings.use_indirect = 1;
        settings.filter = PM_FILTER_EPANECHNIKOV;
        settings.cone_k = settings.pixel_filter_width = 1;
        settings.nearest_count = 10;
        settings.max_bounces = 5;
        settings.use_progressive = 1;
        settings.threads = 2;
        settings.passes = (1u << PM_PASS_COUNT) - 1;
        settings.keep_photons = 1;
    }
};

/// Sets the parts of the method by the bits of a number.
inline void choose_parts(pm_settings &settings, uint64_t bits) {
    const auto bit = [bits](unsigned i) { return static_cast<uint32_t>(bits >> i & 1); };
    settings.integrator = bit(0) ? PM_PHOTON_MAP : bit(1) ? PM_PATH_TRACING : PM_REGULAR_SHADING;
    settings.estimate = bit(7) ? PM_ESTIMATE_ADAPTIVE : bit(2) ? PM_ESTIMATE_NEAREST : PM_ESTIMATE_RADIUS;
    settings.brdf_direction = bit(3);
    settings.use_final_gather = bit(4);
    settings.use_shadow_photons = bit(5);
    settings.use_photon_guiding = bit(6);
}

inline pm_mesh mesh_of(const Arrays &arrays) {
    pm_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = arrays.vertices.size() / 3;
    mesh.triangle_count = arrays.triangles.size() / 3;
    mesh.vertices = arrays.vertices.data();
    mesh.triangles = arrays.triangles.data();
    return mesh;
}

inline pm_instances instances_of(const Arrays &arrays) {
    pm_instances instances{};
    instances.struct_size = sizeof instances;
    instances.count = arrays.meshes.size();
    instances.slot_material_count = arrays.slot_materials.size();
    instances.meshes = arrays.meshes.data();
    instances.transforms = arrays.transforms.data();
    instances.first_slots = arrays.first_slots.data();
    instances.slot_materials = arrays.slot_materials.data();
    return instances;
}

inline pm_material material_of(const Arrays &arrays) {
    return {sizeof(pm_material),         0,
            arrays.constants.size() / 3, arrays.instructions.size(),
            arrays.arguments.size(),     arrays.constants.data(),
            arrays.instructions.data(),  arrays.arguments.data()};
}

/// Makes a render of the arrays; null and a status where a call refuses them.
inline Render make_render(pm_device *device, const Arrays &arrays, pm_status &status) {
    pm_scene *created = nullptr;
    status = pm_scene_create(device, &created);
    const Scene scene(created);
    const auto then = [&status](auto call) {
        if (status == PM_OK) status = call();
    };
    const pm_mesh mesh = mesh_of(arrays);
    const pm_instances instances = instances_of(arrays);
    const pm_material material = material_of(arrays);
    uint32_t index = 0;
    pm_render *render = nullptr;
    then([&] { return pm_scene_add_mesh(scene.get(), &mesh, &index); });
    then([&] { return pm_scene_set_materials(scene.get(), &material, 1); });
    then([&] { return pm_scene_set_instances(scene.get(), &instances); });
    then([&] { return pm_scene_set_lights(scene.get(), arrays.lights.data(), arrays.lights.size()); });
    then([&] { return pm_scene_set_world(scene.get(), arrays.world, ~0u); });
    then([&] { return pm_render_create(scene.get(), &arrays.camera, &arrays.settings, &render); });
    return Render(render);
}

inline bool all_finite(const std::vector<float> &values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

/// Loads Embree; null where that failed, which counts.
inline Device make_device(Checks &checks) {
    const char *path = std::getenv("PHOTON_MAPS_EMBREE");
    checks.that(path != nullptr && *path != '\0', "PHOTON_MAPS_EMBREE names the Embree library");
    pm_device *created = nullptr;
    checks.that(pm_device_create(path, &created) == PM_OK, pm_last_error());
    return Device(created);
}

/// Makes a snapshot and asks it everything; returns the photons of the pass.
inline uint64_t ask_snapshot(Checks &checks, pm_render *render, uint32_t index) {
    pm_snapshot *created = nullptr;
    checks.that(pm_snapshot_create(render, index, &created) == PM_OK, pm_last_error());
    const Snapshot snapshot(created);
    uint64_t stored = 0, received = 0;
    for (uint32_t kind = 0; kind <= PM_PHOTONS_SHADOW; ++kind) {
        uint64_t count = 0;
        checks.that(pm_snapshot_count(snapshot.get(), kind, &count) == PM_OK, pm_last_error());
        std::vector<pm_traced_photon> photons(count);
        checks.that(pm_snapshot_photons(snapshot.get(), kind, 0, count, photons.data()) == PM_OK, pm_last_error());
        if (kind != PM_PHOTONS_SHADOW) stored += count;
        std::vector<uint32_t> numbers;
        for (const pm_traced_photon &photon : photons) numbers.push_back(photon.number);
        if (kind == PM_PHOTONS_SHADOW || count == 0) continue;
        const uint32_t is_caustic = kind == PM_PHOTONS_CAUSTIC;
        std::vector<pm_photon_segment> segments(3);
        uint64_t segment_count = 0;
        checks.that(pm_snapshot_segments(snapshot.get(), is_caustic, numbers.data(), count, segments.data(), 3,
                                         &segment_count) == PM_OK,
                    pm_last_error());
        checks.that(segment_count >= count, "every photon came some way");
    }
    std::vector<pm_received> rows(1000);
    uint64_t row_count = 0;
    checks.that(pm_snapshot_received(snapshot.get(), rows.data(), rows.size(), &row_count) == PM_OK, pm_last_error());
    checks.that(row_count <= rows.size(), "there are few instances and lights");
    for (uint64_t i = 0; i < row_count; ++i) received += rows[i].stored;
    checks.that(received == stored, "instances received what is stored");
    pm_probe probe{};
    probe.struct_size = sizeof probe;
    const std::array<float, 3> origin = {0.5f, 0.4f, 0.6f}, down = {0, 0, -1};
    checks.that(pm_snapshot_probe(snapshot.get(), origin.data(), down.data(), &probe) == PM_OK, pm_last_error());
    for (const pm_map_probe &map : {probe.global_map, probe.caustic_map})
        checks.that(std::isfinite(map.irradiance[0]) && !(map.standard_error[0] < 0), "an estimate is a number");
    return stored;
}

}  // namespace photon_maps::test
