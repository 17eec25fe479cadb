// SPDX-License-Identifier: GPL-3.0-or-later
#include "caster.h"

#include <cstdint>
#include <map>
#include <utility>

namespace photon_maps {

namespace {

/// Surfaces whose shares of glossy light lie within a factor of two: others are not put into one sphere.
constexpr int class_count = 8;
constexpr float least_specular = 1.0f / (1 << class_count);

/// Cells of a grid that the surfaces of the meshes of a single use may fill, all together, and the cells along each
/// axis of one mesh at most.
constexpr float all_cells = 1 << 18;
constexpr float most_cells_along = 16;

/// Some glossy surface and the sphere that holds it.
struct Piece {
    Vec3 center;
    float radius = 0;
    float specular = 0;
    float area = 0;
};

/// Neighbouring pieces in one sphere, and the two halves that it could be divided into.
struct Cluster {
    size_t begin, end;  // of the pieces
    Piece whole;
    size_t halves = 0;  // index of the first, the second follows; 0: not divided
    float cost = 0;     // what aiming at it, or at its best division, covers
    bool is_divided = false;
    bool is_taken = true;
};

float specular_of(const MaterialTraits &traits) {
    if ((traits.lobes & glossy_lobes) == 0) return 0;
    return std::clamp(traits.specular, least_specular, 1.0f);
}

int class_of(float specular) { return std::min(static_cast<int>(-std::log2(specular)), class_count - 1); }

/// Largest factor by which a transform stretches, or a little more where it shears (Gershgorin's circles).
float stretch(const Transform &t) {
    const float xy = std::abs(dot(t.x, t.y)), yz = std::abs(dot(t.y, t.z)), zx = std::abs(dot(t.z, t.x));
    return std::sqrt(
        max_component({length_squared(t.x) + xy + zx, length_squared(t.y) + xy + yz, length_squared(t.z) + yz + zx}));
}

/// Calls back with each glossy triangle, in the space of the mesh as it is stored, and its share.
template <class Callback>
void for_each_glossy(const Scene &scene, uint32_t instance, const Callback &callback) {
    const Mesh &mesh = scene.meshes[scene.instances[instance].mesh];
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const float specular = specular_of(scene.material(instance, t).traits);
        const Triangle &corners = mesh.triangles[t];
        if (specular > 0)
            callback(WorldTriangle{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]},
                     specular);
    }
}

bool is_glossy_anywhere(const Scene &scene, const Instance &instance) {
    const auto first = scene.slot_materials.begin() + instance.first_slot;
    const auto count = static_cast<ptrdiff_t>(scene.meshes[instance.mesh].slot_count);
    return std::any_of(first, first + count,
                       [&](uint32_t material) { return specular_of(scene.materials[material].traits) > 0; });
}

/// The glossy triangles of one class that fall into one cell of a grid.
struct Cell {
    Bounds bounds;
    Piece piece;
};

/// Divides the glossy surfaces of an instance by class and by the cells of a grid, in the space of the stored mesh.
std::vector<Piece> divide_mesh(const Scene &scene, uint32_t instance, int cells_along) {
    Bounds bounds;
    for_each_glossy(scene, instance, [&](const WorldTriangle &t, float) {
        for (const Vec3 corner : {t.a, t.b, t.c}) bounds.add(corner);
    });
    const float scale = static_cast<float>(cells_along) / std::max(max_component(bounds.upper - bounds.lower), 1e-30f);
    const auto cell_along = [&](float offset) { return std::min(static_cast<int>(offset * scale), cells_along - 1); };
    std::map<std::pair<int, int>, Cell> cells;  // by class and number
    const auto cell_of = [&](const WorldTriangle &t, float specular) -> Cell & {
        const Vec3 at = max((t.a + t.b + t.c) / 3 - bounds.lower, Vec3());
        const int number = (cell_along(at.x) * cells_along + cell_along(at.y)) * cells_along + cell_along(at.z);
        return cells[{class_of(specular), number}];
    };

    // The box of each cell, then the sphere about its middle.
    for_each_glossy(scene, instance, [&](const WorldTriangle &t, float specular) {
        Cell &cell = cell_of(t, specular);
        for (const Vec3 corner : {t.a, t.b, t.c}) cell.bounds.add(corner);
        cell.piece.center = cell.bounds.center();
        cell.piece.specular = std::max(cell.piece.specular, specular);
        cell.piece.area += length(cross(t.b - t.a, t.c - t.a)) / 2;
    });
    for_each_glossy(scene, instance, [&](const WorldTriangle &t, float specular) {
        Piece &piece = cell_of(t, specular).piece;
        for (const Vec3 corner : {t.a, t.b, t.c}) piece.radius = std::max(piece.radius, length(corner - piece.center));
    });
    std::vector<Piece> pieces;
    for (const auto &[key, cell] : cells) pieces.push_back(cell.piece);
    return pieces;
}

std::vector<Piece> find_pieces(const Scene &scene) {
    std::vector<uint32_t> glossy;
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
        if (is_glossy_anywhere(scene, scene.instances[i])) glossy.push_back(i);
    const auto is_single = [&](uint32_t i) { return scene.meshes[scene.instances[i].mesh].use_count == 1; };
    const auto singles = static_cast<float>(std::max<ptrdiff_t>(1, std::ranges::count_if(glossy, is_single)));
    const float cells_along = std::clamp(std::sqrt(all_cells / (6 * singles)), 1.0f, most_cells_along);

    // Meshes of a single use in pieces; shared ones whole, once for all instances of the same materials.
    std::vector<Piece> pieces;
    std::map<std::pair<uint32_t, std::vector<uint32_t>>, std::vector<Piece>> by_mesh;
    for (const uint32_t i : glossy) {
        const Instance &instance = scene.instances[i];
        const auto first = scene.slot_materials.begin() + instance.first_slot;
        const auto slot_count = static_cast<ptrdiff_t>(scene.meshes[instance.mesh].slot_count);
        const auto [found, is_new] =
            by_mesh.try_emplace({instance.mesh, std::vector<uint32_t>(first, first + slot_count)});
        if (is_new) found->second = divide_mesh(scene, i, is_single(i) ? static_cast<int>(cells_along) : 1);
        const float scale = stretch(instance.transform);
        for (const Piece &piece : found->second)
            pieces.push_back({instance.transform.point(piece.center), piece.radius * scale, piece.specular,
                              piece.area * scale * scale});
    }
    return pieces;
}

/// The sphere about the box about the pieces' spheres that holds them all.
Cluster cluster_of(const std::vector<Piece> &pieces, size_t begin, size_t end) {
    Cluster cluster{begin, end, {}};
    Bounds bounds;
    for (size_t p = begin; p < end; ++p) {
        const Vec3 radius{pieces[p].radius, pieces[p].radius, pieces[p].radius};
        bounds.add(pieces[p].center - radius);
        bounds.add(pieces[p].center + radius);
        cluster.whole.specular = std::max(cluster.whole.specular, pieces[p].specular);
        cluster.whole.area += pieces[p].area;
    }
    cluster.whole.center = bounds.center();
    for (size_t p = begin; p < end; ++p)
        cluster.whole.radius =
            std::max(cluster.whole.radius, length(pieces[p].center - cluster.whole.center) + pieces[p].radius);
    cluster.cost = cluster.whole.specular * cluster.whole.radius * cluster.whole.radius;
    return cluster;
}

/// Divides the pieces of a cluster in the middle of the longest side: what lies apart is parted.
size_t divide(std::vector<Piece> &pieces, const Cluster &cluster) {
    Bounds centers;
    for (size_t p = cluster.begin; p < cluster.end; ++p) centers.add(pieces[p].center);
    const Vec3 size = centers.upper - centers.lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float middle = centers.center()[axis];
    const auto begin = pieces.begin() + static_cast<ptrdiff_t>(cluster.begin);
    const auto end = pieces.begin() + static_cast<ptrdiff_t>(cluster.end);
    const auto parted = std::partition(begin, end, [&](const Piece &p) { return p.center[axis] < middle; });
    if (parted == begin || parted == end) return (cluster.begin + cluster.end) / 2;  // all in one place
    return static_cast<size_t>(parted - pieces.begin());
}

/// A tree of clusters with a root for each class and at most `max_casters` leaves; halves come after their whole.
std::vector<Cluster> build_clusters(std::vector<Piece> &pieces) {
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece &a, const Piece &b) { return class_of(a.specular) < class_of(b.specular); });
    std::vector<Cluster> clusters;
    for (size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
        while (end < pieces.size() && class_of(pieces[end].specular) == class_of(pieces[begin].specular)) ++end;
        clusters.push_back(cluster_of(pieces, begin, end));
    }
    const auto cost_of_dividing = [](const Cluster &c) { return c.halves == 0 && c.end - c.begin > 1 ? c.cost : 0; };
    for (size_t leaves = clusters.size(); leaves < max_casters; ++leaves) {
        const auto widest = std::max_element(clusters.begin(), clusters.end(), [&](const auto &a, const auto &b) {
            return cost_of_dividing(a) < cost_of_dividing(b);
        });
        if (widest == clusters.end() || !(cost_of_dividing(*widest) > 0)) break;
        const size_t begin = widest->begin, end = widest->end, middle = divide(pieces, *widest);
        widest->halves = clusters.size();
        for (const auto &[from, to] : {std::pair{begin, middle}, std::pair{middle, end}}) {
            clusters.push_back(cluster_of(pieces, from, to));
            clusters.back().is_taken = false;
        }
    }
    return clusters;
}

/// A sphere a little larger than the cluster's, for rounding errors.
Caster caster_of(const Piece &whole) {
    const float error = 8 * std::numeric_limits<float>::epsilon() * (max_component(abs(whole.center)) + whole.radius);
    const float radius = std::max(whole.radius * 1.001f + error, std::numeric_limits<float>::min());
    // Seen from all sides a sheet shows half its area on average (Cauchy).
    const float share = std::min(1.0f, whole.area / (2 * pi * radius * radius));
    return {whole.center, radius, std::max(whole.specular * share, least_specular * least_specular)};
}

}  // namespace

std::vector<Caster> find_casters(const Scene &scene) {
    std::vector<Piece> pieces = find_pieces(scene);
    std::vector<Cluster> clusters = build_clusters(pieces);

    // From the leaves up, divide where the halves cover clearly less than the whole.
    constexpr float worth_dividing = 0.75f;
    for (size_t c = clusters.size(); c-- > 0;) {
        Cluster &cluster = clusters[c];
        if (cluster.halves == 0) continue;
        const float divided = clusters[cluster.halves].cost + clusters[cluster.halves + 1].cost;
        cluster.is_divided = divided < worth_dividing * cluster.cost;
        if (cluster.is_divided) cluster.cost = divided;
    }

    // From the roots down, take what is not divided.
    std::vector<Caster> casters;
    for (const Cluster &cluster : clusters) {
        if (!cluster.is_taken) continue;
        if (cluster.is_divided)
            clusters[cluster.halves].is_taken = clusters[cluster.halves + 1].is_taken = true;
        else
            casters.push_back(caster_of(cluster.whole));
    }
    return casters;
}

}  // namespace photon_maps
