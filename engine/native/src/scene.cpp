// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.h"

#include "closed_mesh.h"
#include "parallel.h"
#include "ray_state.h"
#include "validate.h"

namespace photon_maps {

namespace {

/// Embree's ray masks: bits of pm_ray, and for shadow rays whether an instance may let light through.
constexpr uint32_t opaque_shadow = 1u << PM_RAY_COUNT, transparent_shadow = 2u << PM_RAY_COUNT;

rtc::Ray to_embree(const Ray &ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.near,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.far,
            ray.kinds,
            0,
            0};
}

/// A triangle's corners as its mesh has them.
WorldTriangle stored_triangle(const Mesh &mesh, uint32_t triangle) {
    const Triangle &t = mesh.triangles[triangle];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

WorldTriangle to_world(const Instance &instance, const Mesh &mesh, const WorldTriangle &stored) {
    if (mesh.use_count == 1) return stored;
    const Transform &m = instance.transform;
    return {m.point(stored.a), m.point(stored.b), m.point(stored.c)};
}

/// Three roundings of the point's own and those of the instance's transform (Pharr, Jakob, Humphreys 2023, section
/// 6.8): of all the terms, which may cancel to a small coordinate.
float rounding_error(const Instance &instance, const Mesh &mesh, const WorldTriangle &stored) {
    const Vec3 v = max(abs(stored.a), max(abs(stored.b), abs(stored.c)));
    const Transform &m = instance.transform;
    const Vec3 terms = mesh.use_count == 1 ? v : abs(m.x) * v.x + abs(m.y) * v.y + abs(m.z) * v.z + abs(m.origin);
    return 8 * std::numeric_limits<float>::epsilon() * max_component(terms);
}

}  // namespace

Scene::~Scene() {
    // Embree's scenes go before the arrays they share.
    top_scene_.reset();
    mesh_scenes_.clear();
}

void Scene::freeze() {
    if (frozen_) return;
    count_uses();
    find_bounds();
    find_closed_meshes();
    for (Instance &instance : instances) instance.is_mirrored = instance.place.determinant() < 0;
    move_single_uses_to_world();
    frozen_ = true;
}

void Scene::build(int threads, const std::atomic<bool> *cancel) {
    const std::lock_guard lock(build_mutex_);
    if (built_) return;
    find_world_edges(threads, cancel);
    embree_->commit(make_embree_scenes(cancel), threads);
    built_ = true;
}

void Scene::count_uses() {
    for (Mesh &mesh : meshes) mesh.use_count = 0;
    for (const Instance &instance : instances) ++meshes[instance.mesh].use_count;
    // Embree inverts the transforms of instances; one that flattens its mesh gets a copy to be moved instead.
    for (Instance &instance : instances) {
        if (meshes[instance.mesh].use_count == 1 || std::isnormal(instance.transform.determinant())) continue;
        --meshes[instance.mesh].use_count;
        meshes.push_back(meshes[instance.mesh]);
        meshes.back().use_count = 1;
        instance.mesh = static_cast<uint32_t>(meshes.size() - 1);
    }
}

void Scene::find_closed_meshes() {
    for (const Instance &instance : instances) {
        Mesh &mesh = meshes[instance.mesh];
        const bool refracts =
            any_material(instance, [](const MaterialTraits &t) { return (t.lobes & glossy_transmission) != 0; });
        if (refracts && !mesh.is_closed)
            mesh.is_closed =
                photon_maps::is_closed(std::span(mesh.vertices).first(mesh.vertex_count()), mesh.triangles);
    }
}

void Scene::find_bounds() {
    std::vector<Bounds> object_bounds(meshes.size());
    for (size_t m = 0; m < meshes.size(); ++m)
        for (size_t v = 0; v < meshes[m].vertex_count(); ++v) object_bounds[m].add(meshes[m].vertices[v]);

    bounds_ = Bounds();
    for (uint32_t i = 0; i < instances.size(); ++i) {
        const Bounds &box = object_bounds[instances[i].mesh];
        if (box.empty()) continue;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vec3 p = instances[i].transform.point({corner & 1 ? box.upper.x : box.lower.x,
                                                         corner & 2 ? box.upper.y : box.lower.y,
                                                         corner & 4 ? box.upper.z : box.lower.z});
            if (!is_finite(p) || max_component(abs(p)) > max_coordinate)
                throw std::invalid_argument("instance " + std::to_string(i) + " reaches beyond 1e9 scene units");
            bounds_.add(p);
        }
    }
}

void Scene::move_single_uses_to_world() {
    for (Instance &instance : instances) {
        Mesh &mesh = meshes[instance.mesh];
        if (mesh.use_count != 1) continue;
        for (Vec3 &vertex : mesh.vertices) vertex = instance.transform.point(vertex);
        for (Vec3 &normal : mesh.corner_normals) normal = instance.transform.normal(normal);
        instance.transform = Transform();
    }
}

void Scene::find_world_edges(int threads, const std::atomic<bool> *cancel) {
    feature_edges_.clear();
    std::vector<std::vector<FeatureEdge>> edges(meshes.size());
    parallel_for(threads, meshes.size(), cancel, [&](size_t m) {
        const Mesh &mesh = meshes[m];
        if (mesh.use_count > 0)
            edges[m] = find_feature_edges(std::span(mesh.vertices).first(mesh.vertex_count()), mesh.triangles, cancel);
    });
    for (const Instance &instance : instances) {
        for (const FeatureEdge &edge : edges[instance.mesh])
            feature_edges_.push_back(transformed(edge, instance.transform));
    }
}

Scene::SceneHandle Scene::new_scene(const std::atomic<bool> *cancel) const {
    const rtc::Functions &f = embree_->functions();
    SceneHandle scene(f.rtcNewScene(embree_->device()), {embree_.get()});
    embree_->check("creating a scene");
    // Without this flag rays slip between neighbouring triangles, and light leaks.
    f.rtcSetSceneFlags(scene.get(), rtc::SceneFlags::robust);
    f.rtcSetSceneBuildQuality(scene.get(), rtc::BuildQuality::medium);
    // Embree asks now and then whether to go on.
    const auto go_on = [](void *flag, double) { return !*static_cast<const std::atomic<bool> *>(flag); };
    if (cancel && !builds_are_joined)
        f.rtcSetSceneProgressMonitorFunction(scene.get(), go_on, const_cast<std::atomic<bool> *>(cancel));
    return scene;
}

void Scene::attach_triangles(rtc::Scene scene, const Mesh &mesh, uint32_t id, uint32_t mask) const {
    const rtc::Functions &f = embree_->functions();
    const rtc::Geometry geometry = f.rtcNewGeometry(embree_->device(), rtc::GeometryType::triangle);
    f.rtcSetSharedGeometryBuffer(geometry, rtc::BufferType::vertex, 0, rtc::Format::float3, mesh.vertices.data(), 0,
                                 sizeof(Vec3), mesh.vertex_count());
    f.rtcSetSharedGeometryBuffer(geometry, rtc::BufferType::index, 0, rtc::Format::uint3, mesh.triangles.data(), 0,
                                 sizeof(Triangle), mesh.triangles.size());
    f.rtcSetGeometryMask(geometry, mask);
    f.rtcCommitGeometry(geometry);
    f.rtcAttachGeometryByID(scene, geometry, id);
    f.rtcReleaseGeometry(geometry);
}

std::vector<rtc::Scene> Scene::make_embree_scenes(const std::atomic<bool> *cancel) {
    top_scene_.reset();
    mesh_scenes_.clear();
    const rtc::Functions &f = embree_->functions();
    // Meshes with several uses get a scene of their own, to be instanced.
    for (const Mesh &mesh : meshes) {
        mesh_scenes_.push_back(mesh.use_count > 1 ? new_scene(cancel) : SceneHandle(nullptr, {embree_.get()}));
        if (mesh.use_count <= 1) continue;
        attach_triangles(mesh_scenes_.back().get(), mesh, 0, ~0u);
    }
    top_scene_ = new_scene(cancel);
    has_transparent_ = false;
    for (uint32_t i = 0; i < instances.size(); ++i) {
        const Mesh &mesh = meshes[instances[i].mesh];
        const uint32_t mask = embree_mask(instances[i]);
        has_transparent_ = has_transparent_ || (mask & transparent_shadow) != 0;
        if (mesh.use_count == 1) {
            attach_triangles(top_scene_.get(), mesh, i, mask);
            continue;
        }
        const Transform &t = instances[i].transform;
        const float rows[12] = {t.x.x, t.y.x,      t.z.x, t.origin.x, t.x.y, t.y.y,
                                t.z.y, t.origin.y, t.x.z, t.y.z,      t.z.z, t.origin.z};
        const rtc::Geometry geometry = f.rtcNewGeometry(embree_->device(), rtc::GeometryType::instance);
        f.rtcSetGeometryInstancedScene(geometry, mesh_scenes_[instances[i].mesh].get());
        f.rtcSetGeometryTransform(geometry, 0, rtc::Format::float3x4_row_major, rows);
        f.rtcSetGeometryMask(geometry, mask);
        f.rtcCommitGeometry(geometry);
        f.rtcAttachGeometryByID(top_scene_.get(), geometry, i);
        f.rtcReleaseGeometry(geometry);
    }
    embree_->check("reading the scene");

    std::vector<rtc::Scene> scenes;
    for (const SceneHandle &scene : mesh_scenes_)
        if (scene) scenes.push_back(scene.get());
    scenes.push_back(top_scene_.get());
    return scenes;
}

bool Scene::intersect(const Ray &ray, SurfacePoint &hit) const {
    rtc::RayHit rh{to_embree(ray), {}};
    rh.hit.geometry = rh.hit.instance = rtc::invalid_id;
    embree_->functions().rtcIntersect1(top_scene_.get(), &rh, nullptr);
    if (rh.hit.geometry == rtc::invalid_id) return false;

    // A mesh of a single use is a geometry of the top scene; others are met through their instance.
    const uint32_t instance = rh.hit.instance == rtc::invalid_id ? rh.hit.geometry : rh.hit.instance;
    find_point(instance, rh.hit.primitive, rh.hit.u, rh.hit.v, ray.direction, hit);
    hit.distance = rh.ray.tfar;
    return true;
}

SurfacePoint Scene::surface_point(uint32_t instance, uint32_t triangle, float u, float v, Vec3 travel) const {
    SurfacePoint point;
    find_point(instance, triangle, u, v, travel, point);
    point.distance = 0;
    return point;
}

void Scene::find_point(uint32_t instance_index, uint32_t triangle, float u, float v, Vec3 travel,
                       SurfacePoint &hit) const {
    hit.instance = instance_index;
    hit.triangle = triangle;
    hit.u = u;
    hit.v = v;
    const Instance &instance = instances[instance_index];
    const Mesh &mesh = meshes[instance.mesh];
    // Large meshes are out of the cache: their normals come while the vertices are awaited.
    if (!mesh.corner_normals.empty()) __builtin_prefetch(&mesh.corner_normals[3 * size_t{triangle}]);
    const uint32_t slot = mesh.slots.empty() ? 0 : mesh.slots[triangle];
    hit.material = &materials[slot_materials[instance.first_slot + slot]];

    // Position from the triangle, not from the distance: its error does not grow with the ray's length.
    const Triangle &corners = mesh.triangles[triangle];
    Vec3 a = mesh.vertices[corners[0]], b = mesh.vertices[corners[1]], c = mesh.vertices[corners[2]];
    hit.error = rounding_error(instance, mesh, {a, b, c});
    if (mesh.use_count != 1) {
        a = instance.transform.point(a);
        b = instance.transform.point(b);
        c = instance.transform.point(c);
    }
    const Vec3 ab = b - a, ac = c - a;
    hit.position = a + ab * u + ac * v;

    // Geometric normal towards the ray; a triangle so thin that it has none takes the ray's own direction.
    const Vec3 n = cross(ab, ac);
    const float n_length = length(n);
    hit.normal = n_length > 0 ? n / n_length : -normalize(travel);
    if (n_length > 0 && instance.is_mirrored) hit.normal = -hit.normal;  // mirrored: as in the object
    hit.is_backfacing = dot(hit.normal, travel) > 0;
    if (hit.is_backfacing) hit.normal = -hit.normal;

    // Shading normal on the same side.
    hit.shading_normal = hit.normal;
    if (!mesh.corner_normals.empty()) {
        const Vec3 *normals = &mesh.corner_normals[3 * size_t{triangle}];
        const Vec3 world_normal = instance.transform.normal(normals[0] * (1 - u - v) + normals[1] * u + normals[2] * v);
        const float squared = length_squared(world_normal);
        if (squared > 0) {
            hit.shading_normal = world_normal / std::sqrt(squared);
            if (dot(hit.shading_normal, hit.normal) < 0) hit.shading_normal = -hit.shading_normal;
        }
    }
}

Vec3 Scene::transmittance(const Ray &ray, uint64_t &rays) const {
    rtc::Ray r = to_embree(ray);
    r.mask = opaque_shadow;
    ++rays;
    embree_->functions().rtcOccluded1(top_scene_.get(), &r, nullptr);
    if (r.tfar < 0) return {};  // Embree marks a met ray by -infinity
    return has_transparent_ ? transmittance_of_transparent(ray, rays) : Vec3{1, 1, 1};
}

Vec3 Scene::transmittance_of_transparent(Ray ray, uint64_t &rays) const {
    Vec3 transmitted{1, 1, 1};
    RayState state;
    state.kinds = 1u << PM_RAY_SHADOW;
    const float unit = length(ray.direction);
    ray.kinds = transparent_shadow;
    SurfacePoint hit;
    for (; state.transparent_depth < max_transparent_depth; state = passed(state)) {
        ++rays;
        if (!intersect(ray, hit)) return transmitted;
        state.length += hit.distance * unit;
        transmitted *= shade(*this, hit, -ray.direction / unit, state).transparency;
        if (max_component(transmitted) <= 0) return {};
        ray.far -= hit.distance;
        ray.near = 0;
        ray.origin = hit.origin_towards(ray.direction);
    }
    return {};
}

bool Scene::any_material(const Instance &instance, bool (*has)(const MaterialTraits &)) const {
    const auto first = slot_materials.begin() + instance.first_slot;
    const auto count = static_cast<ptrdiff_t>(meshes[instance.mesh].slot_count);
    return std::any_of(first, first + count, [&](uint32_t material) { return has(materials[material].traits); });
}

uint32_t Scene::embree_mask(const Instance &instance) const {
    const bool casts_shadow = instance.visibility & 1u << PM_RAY_SHADOW;
    const bool is_transparent = any_material(instance, [](const MaterialTraits &t) { return t.is_transparent; });
    const uint32_t shadow = is_transparent ? transparent_shadow : opaque_shadow;
    return (instance.visibility & ((1u << PM_RAY_COUNT) - 1)) | (casts_shadow ? shadow : 0);
}

const Material &Scene::material(uint32_t instance, uint32_t triangle) const {
    const Instance &i = instances[instance];
    const Mesh &mesh = meshes[i.mesh];
    const uint32_t slot = mesh.slots.empty() ? 0 : mesh.slots[triangle];
    return materials[slot_materials[i.first_slot + slot]];
}

WorldTriangle Scene::world_triangle(uint32_t instance, uint32_t triangle) const {
    const Instance &i = instances[instance];
    const Mesh &mesh = meshes[i.mesh];
    return to_world(i, mesh, stored_triangle(mesh, triangle));
}

float Scene::position_error(uint32_t instance, uint32_t triangle) const {
    const Instance &i = instances[instance];
    const Mesh &mesh = meshes[i.mesh];
    return rounding_error(i, mesh, stored_triangle(mesh, triangle));
}

}  // namespace photon_maps
