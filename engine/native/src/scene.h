// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles and their instances, and the rays that ask for them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "embree.h"
#include "feature_edges.h"
#include "program.h"
#include "texture.h"
#include "vec.h"

namespace photon_maps {

using Triangle = std::array<uint32_t, 3>;

/// Values that vary over a mesh (pm_attribute).
struct Attribute {
    uint32_t id;
    pm_domain domain;
    uint32_t channels;
    std::vector<float> values;
};

/// Triangles in object space.
struct Mesh {
    std::vector<Vec3> vertices;  ///< with one more at the end than counted: Embree reads 16 bytes at each
    std::vector<Triangle> triangles;
    std::vector<uint32_t> slots;       ///< material slot of each triangle; empty: all 0
    std::vector<Vec3> corner_normals;  ///< three a triangle; empty: flat
    std::vector<Attribute> attributes;
    uint32_t slot_count = 0;  ///< one more than the largest slot; 0 without triangles
    uint32_t use_count = 0;   ///< instances that show it
    bool is_closed = false;   ///< encloses a body; known of meshes that refract

    size_t vertex_count() const { return vertices.size() - 1; }
};

/// A mesh where it stands.
struct Instance {
    uint32_t mesh = 0;
    uint32_t first_slot = 0;    ///< into Scene::slot_materials
    Transform transform{};      ///< identity once a mesh that is used only here has been moved into world space
    Transform place{};          ///< object to world, always
    bool is_mirrored = false;   ///< by `place`; known once the scene is frozen
    uint32_t visibility = ~0u;  ///< bits 1 << pm_ray
    Rgba color{};               ///< the object's, for shaders; as are the next two
    float index = 0, random = 0;
};

/// An axis-aligned box.
struct Bounds {
    Vec3 lower{infinity, infinity, infinity};
    Vec3 upper = -lower;

    void add(Vec3 p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    bool empty() const { return lower.x > upper.x; }
    Vec3 center() const { return empty() ? Vec3{} : lower * 0.5f + upper * 0.5f; }
    /// Of the sphere about the centre that holds the box.
    float radius() const { return empty() ? 0 : length(upper * 0.5f - lower * 0.5f); }
};

/// A ray from a point; `direction` need not be a unit vector, distances count in its length.
struct Ray {
    Vec3 origin, direction;
    float near = 0, far = infinity;
    uint32_t kinds = ~0u;  ///< bits 1 << pm_ray: surfaces that are visible to none of them are passed through
};

/// The view that shaders ask for.
struct View {
    Transform world_to_camera;  ///< the camera looks along its local -z, y up
    pm_camera_type type = PM_CAMERA_PERSPECTIVE;
    float left = -1, right = 1, bottom = -1, top = 1;  ///< the window, as pm_camera has it
};

/// What a ray met.
struct SurfacePoint {
    Vec3 position;
    Vec3 normal;          ///< geometric, unit, on the side the ray came from
    Vec3 shading_normal;  ///< unit, on the same side
    float distance;       ///< in lengths of the ray's direction
    float error;          ///< bound of the position's rounding error, in scene units
    uint32_t instance, triangle;
    float u, v;          ///< barycentric: weights of the triangle's second and third corner
    bool is_backfacing;  ///< the ray came from behind, by the triangle's winding
    const Material *material;

    /// Where a ray that leaves in a direction may start without meeting the surface again.
    Vec3 origin_towards(Vec3 direction) const {
        return position + normal * std::copysign(error, dot(direction, normal));
    }

    /// The point as it is seen from its other side.
    SurfacePoint turned() const {
        SurfacePoint back = *this;
        back.normal = -normal;
        back.shading_normal = -shading_normal;
        back.is_backfacing = !is_backfacing;
        return back;
    }
};

/// The triangle that an instance shows, in world space.
struct WorldTriangle {
    Vec3 a, b, c;
};

/// All of the scene's surfaces. Add and set, freeze, build; then ask from any number of threads.
class Scene {
  public:
    explicit Scene(std::shared_ptr<const Embree> embree) : embree_(std::move(embree)) {}
    Scene(const Scene &) = delete;
    Scene &operator=(const Scene &) = delete;
    ~Scene();

    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<uint32_t> slot_materials;
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<Table> tables;
    View view;

    /// Ends the changes: moves meshes of a single use into world space and finds the bounds. Again: does nothing.
    /// @throws std::invalid_argument if an instance reaches beyond the coordinates that single precision bears
    void freeze();
    bool frozen() const { return frozen_; }

    /// Builds Embree's structure of the frozen scene and finds the feature edges, once.
    /// @throws Cancelled once `cancel` is set; a later call starts afresh
    void build(int threads, const std::atomic<bool> *cancel);

    bool intersect(const Ray &ray, SurfacePoint &hit) const;
    /// The point of a triangle with barycentric coordinates u, v, as seen against a direction of travel; its distance
    /// is 0.
    SurfacePoint surface_point(uint32_t instance, uint32_t triangle, float u, float v, Vec3 travel) const;
    /// What share of light comes through along a shadow ray: all, nothing, or what transparent materials let pass.
    /// @param rays is raised by the rays that were traced
    Vec3 transmittance(const Ray &ray, uint64_t &rays) const;

    const Material &material(uint32_t instance, uint32_t triangle) const;
    const Mesh &mesh_of(const SurfacePoint &point) const { return meshes[instances[point.instance].mesh]; }
    WorldTriangle world_triangle(uint32_t instance, uint32_t triangle) const;
    /// Bound of the rounding error of a point computed on the triangle, in scene units.
    float position_error(uint32_t instance, uint32_t triangle) const;
    const Bounds &bounds() const { return bounds_; }
    /// Edges where surfaces stop or fold, in world space.
    std::span<const FeatureEdge> feature_edges() const { return feature_edges_; }
    /// Of all arrays; without Embree's structure.
    size_t memory_bytes() const;

  private:
    struct SceneReleaser {
        const Embree *embree;
        void operator()(rtc::Scene scene) const { embree->functions().rtcReleaseScene(scene); }
    };
    using SceneHandle = std::unique_ptr<std::remove_pointer_t<rtc::Scene>, SceneReleaser>;

    /// Fills all of a point but its distance.
    void find_point(uint32_t instance, uint32_t triangle, float u, float v, Vec3 travel, SurfacePoint &point) const;
    void count_uses();
    void move_single_uses_to_world();
    void find_bounds();
    void find_closed_meshes();
    bool any_material(const Instance &instance, bool (*has)(const MaterialTraits &)) const;
    uint32_t embree_mask(const Instance &instance) const;
    Vec3 transmittance_of_transparent(Ray ray, uint64_t &rays) const;
    void find_world_edges(int threads, const std::atomic<bool> *cancel);
    /// Returns those that are to be built, the instanced first.
    std::vector<rtc::Scene> make_embree_scenes(const std::atomic<bool> *cancel);
    SceneHandle new_scene(const std::atomic<bool> *cancel) const;
    void attach_triangles(rtc::Scene scene, const Mesh &mesh, uint32_t id, uint32_t mask) const;

    std::shared_ptr<const Embree> embree_;
    bool frozen_ = false, built_ = false;
    std::mutex build_mutex_;                ///< several renders may share the scene
    std::vector<SceneHandle> mesh_scenes_;  ///< of the meshes that are instanced
    SceneHandle top_scene_{nullptr, {nullptr}};
    std::vector<FeatureEdge> feature_edges_;
    bool has_transparent_ = false;  ///< instances that shadow rays may pass
    Bounds bounds_;
};

}  // namespace photon_maps
