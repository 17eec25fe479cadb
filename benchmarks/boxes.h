// SPDX-License-Identifier: GPL-3.0-or-later
// The Cornell box with something in it, in metres, y upwards: the scene of the programs that trace rays.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "camera.h"
#include "emission.h"
#include "parallel.h"
#include "photon_maps_shader.h"

namespace photon_maps::boxes {

/// What stands in the box.
enum class Content {
    bumpy_sphere,  ///< of 80,000 triangles, matte
    glass_ball,    ///< of as many, smooth
    blocks         ///< the two of the Cornell box: edges that kernels meet
};

constexpr Vec3 white{0.725f, 0.71f, 0.68f}, red{0.63f, 0.065f, 0.05f}, green{0.14f, 0.45f, 0.091f};

/// A material of one closure, whose arguments are constants but for the last one, the normal.
inline Material material_of(pm_op closure, std::vector<Vec3> constants) {
    const auto normal = static_cast<uint32_t>(constants.size());
    Material material;
    material.program.constants = std::move(constants);
    material.program.instructions = {{PM_OP_INPUT, PM_INPUT_NORMAL, 0, normal, 0, 0},
                                     {closure, 0, 0, normal + 1, 0, normal + 1}};
    for (uint32_t i = 0; i <= normal; ++i) material.program.arguments.push_back(i);
    material.program.register_count = normal + 1;
    return material;
}
inline Material matte(Vec3 albedo) { return material_of(PM_OP_DIFFUSE, {albedo, {}}); }
inline Material glass(float ior) { return material_of(PM_OP_GLASS, {{1, 1, 1}, {1, 1, 1}, {}, {ior, ior, ior}}); }

inline void add_object(Scene &scene, Mesh mesh, Material material) {
    const auto number = static_cast<uint32_t>(scene.meshes.size());
    mesh.vertices.emplace_back();  // Embree reads 16 bytes at each
    mesh.slot_count = 1;
    scene.meshes.push_back(std::move(mesh));
    prepare(scene.materials.emplace_back(std::move(material)), scene);
    scene.slot_materials.push_back(number);
    Instance &instance = scene.instances.emplace_back();
    instance.mesh = instance.first_slot = number;
}

inline void add_wall(Scene &scene, Vec3 corner, Vec3 along, Vec3 up, Vec3 albedo) {
    Mesh mesh;
    mesh.vertices = {corner, corner + along, corner + along + up, corner + up};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    add_object(scene, std::move(mesh), matte(albedo));
}

/// A sphere of 200 x 200 quads.
/// @param bumps share of the radius by which it waves; without any it has smooth normals
inline Mesh sphere(Vec3 center, float radius, float bumps) {
    constexpr uint32_t size = 200;
    Mesh mesh;
    for (uint32_t i = 0; i <= size; ++i) {
        const float polar = pi * static_cast<float>(i) / size;
        for (uint32_t j = 0; j < size; ++j) {
            const float azimuth = 2 * pi * static_cast<float>(j) / size;
            const float share = 1 + bumps * std::sin(12 * polar) * std::sin(12 * azimuth);
            const Vec3 direction{std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                 std::sin(polar) * std::sin(azimuth)};
            mesh.vertices.push_back(center + direction * (radius * share));
        }
    }
    for (uint32_t i = 0; i < size; ++i) {
        for (uint32_t j = 0; j < size; ++j) {
            const uint32_t next = (j + 1) % size;
            const uint32_t a = i * size + j, b = i * size + next, c = a + size, d = b + size;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({b, d, c});
        }
    }
    if (bumps == 0)
        for (const Triangle &triangle : mesh.triangles)
            for (const uint32_t corner : triangle)
                mesh.corner_normals.push_back(normalize(mesh.vertices[corner] - center));
    return mesh;
}

/// A block on the floor, turned about the vertical; one wall for each side but the lowest.
/// @param turned cosine and sine of the angle
inline void add_block(Scene &scene, Vec3 foot, float width, float height, Vec2 turned) {
    const float half = width / 2;
    const Vec3 x{turned.x * half, 0, turned.y * half}, z{-turned.y * half, 0, turned.x * half}, up{0, height, 0};
    add_wall(scene, foot - x - z + up, x * 2, z * 2, white);
    for (const auto &[out, along] : {std::pair{x, z}, std::pair{-x, z}, std::pair{z, x}, std::pair{-z, x}})
        add_wall(scene, foot + out - along, along * 2, up, white);
}

/// Fills and builds an empty scene: the box is open in front.
inline void fill(Scene &scene, Content content) {
    add_wall(scene, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, white);  // floor
    add_wall(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, white);  // ceiling
    add_wall(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white);  // back
    add_wall(scene, {-1, 0, -1}, {0, 0, 2}, {0, 2, 0}, red);    // left
    add_wall(scene, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, green);   // right
    const Vec3 middle{0, 0.8f, -0.1f};
    switch (content) {
        case Content::bumpy_sphere:
            add_object(scene, sphere(middle, 0.6f, 0.08f), matte(white));
            break;
        case Content::glass_ball:
            add_object(scene, sphere(middle, 0.6f, 0), glass(1.5f));
            break;
        case Content::blocks:
            add_block(scene, {-0.35f, 0, -0.3f}, 0.58f, 1.2f, {0.956f, 0.292f});
            add_block(scene, {0.35f, 0, 0.3f}, 0.58f, 0.58f, {0.956f, -0.292f});
            break;
    }
    scene.freeze();
    scene.build(thread_count(0), nullptr);
}

/// The lamp under the ceiling.
inline Lamp lamp() {
    constexpr float width = 0.5f, height = 0.4f;
    Lamp lamp{LightType::rectangle, {}, Vec3{17, 12, 6} * (pi * width * height)};
    lamp.transform = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 1.98f, 0}};
    lamp.width = width;
    lamp.height = height;
    return lamp;
}

/// A camera in front that sees the whole box, in so many pixels along each side.
inline Camera camera(uint32_t side) {
    constexpr float half = 0.35f;
    Camera camera{};
    camera.transform.origin = {0, 1, 3.9f};
    camera.left = camera.bottom = -half;
    camera.right = camera.top = half;
    camera.frame_width = camera.frame_height = camera.width = camera.height = side;
    camera.clip_start = 0.01f;
    camera.clip_end = 100;
    return camera;
}

}  // namespace photon_maps::boxes
