// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of spheres and panes for the tests of photon emission.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "photon_maps_shader.h"
#include "scene.h"

namespace photon_maps::test {

/// Materials of the scenes, by index.
enum MaterialIndex : uint32_t { matte, glass, plastic, glow, sky };

/// A sphere of quads about the origin.
inline Mesh sphere_mesh(float radius, uint32_t rings = 24) {
    Mesh mesh;
    const uint32_t columns = 2 * rings;
    for (uint32_t j = 0; j <= rings; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const float theta = pi * static_cast<float>(j) / static_cast<float>(rings);
            const float phi = 2 * pi * static_cast<float>(i) / static_cast<float>(columns);
            mesh.vertices.push_back(
                Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} * radius);
        }
    }
    mesh.vertices.emplace_back();
    for (uint32_t j = 0; j < rings; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = j * columns + i, b = j * columns + (i + 1) % columns;
            mesh.triangles.push_back({a, a + columns, b + columns});
            mesh.triangles.push_back({a, b + columns, b});
        }
    }
    mesh.slot_count = 1;
    return mesh;
}

/// A rectangle about the origin, facing +z.
inline Mesh pane_mesh(float width, float height) {
    Mesh mesh;
    const float x = width / 2, y = height / 2;
    mesh.vertices = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}, {}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.slot_count = 1;
    return mesh;
}

/// One mesh of two; the second's triangles get a slot.
inline Mesh joined(const Mesh &a, const Mesh &b, Vec3 offset_of_b, uint32_t slot_of_b) {
    Mesh mesh;
    mesh.vertices.assign(a.vertices.begin(), a.vertices.end() - 1);
    for (size_t v = 0; v < b.vertex_count(); ++v) mesh.vertices.push_back(b.vertices[v] + offset_of_b);
    mesh.vertices.emplace_back();
    mesh.triangles = a.triangles;
    const auto shift = static_cast<uint32_t>(a.vertex_count());
    for (const Triangle &t : b.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    mesh.slots = a.slots;
    mesh.slots.resize(a.triangles.size());
    mesh.slots.insert(mesh.slots.end(), b.triangles.size(), slot_of_b);
    mesh.slot_count = std::max(a.slot_count, slot_of_b + 1);
    return mesh;
}

/// A material that emits: a constant, or by a program of one input, which is the radiance.
inline Material emissive(Vec3 radiance) {
    Material material;
    material.program.constants = {radiance};
    material.program.arguments = {0};
    material.program.instructions = {{PM_OP_EMISSION, 0, 0, 1, 0, 1}};
    material.program.register_count = 1;
    return material;
}
inline Material emissive(pm_input input) {
    Material material = emissive(Vec3());
    material.program.instructions = {{PM_OP_INPUT, input, 0, 1, 0, 0}, {PM_OP_EMISSION, 0, 0, 2, 0, 1}};
    material.program.arguments = {1};
    material.program.register_count = 2;
    return material;
}

/// A scene that is filled object by object; it holds the materials of MaterialIndex.
class TestScene {
  public:
    TestScene() : scene(std::make_shared<const Embree>(embree())) {
        scene.materials.resize(3);
        scene.materials.push_back(emissive({3, 2, 1}));
        scene.materials.push_back(emissive(PM_INPUT_NORMAL));
        for (Material &material : scene.materials) prepare(material, scene);
        scene.materials[matte].traits.lobes = diffuse_reflection;
        scene.materials[glass].traits.lobes = glossy_lobes;
        scene.materials[glass].traits.specular = 1;
        scene.materials[plastic].traits.lobes = diffuse_reflection | glossy_reflection;
        scene.materials[plastic].traits.specular = 0.04f;
    }

    /// Adds a mesh and returns its index.
    uint32_t add_mesh(Mesh mesh) {
        scene.meshes.push_back(std::move(mesh));
        return static_cast<uint32_t>(scene.meshes.size() - 1);
    }
    void add_instance(uint32_t mesh, const Transform &place, const std::vector<uint32_t> &materials) {
        Instance &instance = scene.instances.emplace_back();
        instance.mesh = mesh;
        instance.first_slot = static_cast<uint32_t>(scene.slot_materials.size());
        instance.transform = instance.place = place;
        scene.slot_materials.insert(scene.slot_materials.end(), materials.begin(), materials.end());
    }
    void add(Mesh mesh, Vec3 origin, uint32_t material) {
        Transform place;
        place.origin = origin;
        add_instance(add_mesh(std::move(mesh)), place, {material});
    }

    Scene scene;

  private:
    static std::string embree() {
        const char *path = std::getenv("PHOTON_MAPS_EMBREE");
        return path ? path : "";
    }
};

}  // namespace photon_maps::test
