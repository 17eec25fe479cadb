// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface to scenes: checks what comes in and turns it into the helper's own types.
#include <algorithm>

#include "api.h"
#include "convert.h"

pm_status pm_scene_create(pm_device *device, pm_scene **scene) {
    return pm::guarded([&] {
        pm::require_handle(device, "device");
        pm::require_handle(scene, "scene");
        auto created = std::make_unique<pm_scene>();
        created->state = std::make_shared<pm::SceneState>(device->embree);
        *scene = created.release();
    });
}

pm_status pm_scene_add_mesh(pm_scene *scene, const pm_mesh *mesh, uint32_t *index) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(mesh, "mesh");
        pm::require_handle(index, "index");
        pm::SceneState &state = scene->open();
        pm::validate(*mesh);
        uint32_t slots = mesh->triangle_count > 0 ? 1 : 0;
        if (mesh->slots && mesh->triangle_count > 0) {
            const uint32_t largest = *std::max_element(mesh->slots, mesh->slots + mesh->triangle_count);
            pm::require(largest < 0xffffffffu, "slots: 2^32 - 1 is no material slot");
            slots = largest + 1;
        }
        pm::Mesh copy = pm::to_mesh(*mesh);
        copy.slot_count = slots;
        state.scene.meshes.push_back(std::move(copy));
        *index = static_cast<uint32_t>(state.scene.meshes.size() - 1);
    });
}

pm_status pm_scene_set_instances(pm_scene *scene, const pm_instances *instances) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(instances, "instances");
        pm::SceneState &state = scene->open();
        std::vector<uint32_t> mesh_slots;
        for (const pm::Mesh &mesh : state.scene.meshes) mesh_slots.push_back(mesh.slot_count);
        pm::validate(*instances, mesh_slots, state.scene.materials.size());
        state.scene.instances = pm::to_instances(*instances);
        state.scene.slot_materials.assign(instances->slot_materials,
                                          instances->slot_materials + instances->slot_material_count);
    });
}

pm_status pm_scene_add_image(pm_scene *scene, const pm_image *image, uint32_t *index) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(image, "image");
        pm::require_handle(index, "index");
        pm::SceneState &state = scene->open();
        pm::validate(*image);
        state.scene.images.push_back(pm::to_image(*image));
        *index = static_cast<uint32_t>(state.scene.images.size() - 1);
    });
}

pm_status pm_scene_add_texture(pm_scene *scene, const pm_texture *texture, uint32_t *index) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(texture, "texture");
        pm::require_handle(index, "index");
        pm::SceneState &state = scene->open();
        pm::validate(*texture, state.scene.images.size());
        state.scene.textures.push_back(pm::to_texture(*texture));
        *index = static_cast<uint32_t>(state.scene.textures.size() - 1);
    });
}

pm_status pm_scene_add_table(pm_scene *scene, const pm_table *table, uint32_t *index) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(table, "table");
        pm::require_handle(index, "index");
        pm::SceneState &state = scene->open();
        pm::validate(*table);
        state.scene.tables.push_back(pm::to_table(*table));
        *index = static_cast<uint32_t>(state.scene.tables.size() - 1);
    });
}

pm_status pm_scene_set_materials(pm_scene *scene, const pm_material *materials, uint64_t count) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require(materials || count == 0, "materials is null");
        pm::validate_count(count, "materials");
        pm::SceneState &state = scene->open();
        if (!state.scene.instances.empty() || !state.scene.slot_materials.empty())
            throw pm::InvalidOperation("materials are set before the instances");
        if (state.world.material) throw pm::InvalidOperation("materials are set before the world");
        std::vector<pm::Material> converted;
        for (size_t i = 0; i < count; ++i) {
            pm::validate(materials[i], i, state.scene.textures.size(), state.scene.tables.size());
            converted.push_back(pm::to_material(materials[i]));
            pm::prepare(converted.back(), state.scene);
        }
        state.scene.materials = std::move(converted);
    });
}

pm_status pm_scene_set_lights(pm_scene *scene, const pm_light *lights, uint64_t count) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require(lights || count == 0, "lights is null");
        pm::validate_count(count, "lights");
        pm::SceneState &state = scene->open();
        std::vector<pm::Lamp> converted;
        for (size_t i = 0; i < count; ++i) {
            pm::validate(lights[i], i);
            converted.push_back(pm::to_lamp(lights[i]));
        }
        state.lamps = std::move(converted);
    });
}

pm_status pm_scene_set_world(pm_scene *scene, uint32_t material, uint32_t visibility) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::SceneState &state = scene->open();
        pm::require(material < state.scene.materials.size(),
                    "the world's material " + std::to_string(material) + " does not exist");
        state.world = {material, visibility};
    });
}

void pm_scene_release(pm_scene *scene) { const std::unique_ptr<pm_scene> owned(scene); }
