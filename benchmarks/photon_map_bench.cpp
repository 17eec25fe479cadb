// SPDX-License-Identifier: GPL-3.0-or-later
// The photon map against nanoflann (libnanoflann-dev): building it, summing the photons within a radius, and finding
// the k nearest. Both do the same work on the same queries, on one thread.
#include <memory>
#include <nanoflann.hpp>
#include <random>

#include "estimate.h"
#include "measure.h"
#include "photon_lists.h"
#include "photon_map.h"

using namespace photon_maps;

namespace {

constexpr int rounds = 5;
constexpr size_t leaf_size = 16;  // of nanoflann: the fastest here of 8, 16 and 32

/// What nanoflann asks of its points.
struct Dataset {
    const std::vector<Photon> &photons;

    size_t kdtree_get_point_count() const { return photons.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return photons[i].position[static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box &) const {
        return false;
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Dataset>, Dataset, 3, uint32_t>;

/// A result set that sums photons as estimate_photons does, without storing them.
struct FluxSum {
    using DistanceType = float;
    const std::vector<Photon> &photons;
    const Query &query;
    float radius;
    Vec3 flux{};
    uint32_t count = 0;

    bool full() const { return true; }
    float worstDist() const { return radius * radius; }
    bool addPoint(float distance_squared, uint32_t i) {
        const float radius_squared = radius * radius;
        const Photon &photon = photons[i];
        if (distance_squared >= radius_squared) return true;
        if (std::abs(dot(photon.position - query.position, query.normal)) >= plane_tolerance * radius) return true;
        if (dot(unpack_normal(photon.normal), query.normal) <= normal_tolerance) return true;
        flux += photon.flux * (1 - distance_squared / radius_squared);
        ++count;
        return true;
    }
};

// --- Photons and queries ---

/// A query, and the density of photons around it, 1/m2.
struct Place {
    Query query;
    float density;

    float radius_holding(double photons) const { return std::sqrt(static_cast<float>(photons) / (pi * density)); }
};

/// A point of the unit cube's walls, by face and two coordinates; normals point inwards.
Query on_wall(int face, float u, float v) {
    const float side = face % 2 == 0 ? 0.0f : 1.0f, inward = face % 2 == 0 ? 1.0f : -1.0f;
    const Vec3 positions[] = {{side, u, v}, {u, side, v}, {u, v, side}};
    const Vec3 normals[] = {{inward, 0, 0}, {0, inward, 0}, {0, 0, inward}};
    return {positions[face / 2], normals[face / 2], normals[face / 2]};
}

struct Scene {
    const char *name;
    std::vector<Photon> photons;
    std::vector<Place> places;  ///< row by row, as pixels ask for them
};

/// Photons evenly on the walls of a cube; with `cluster`, half of photons and places on a tenth by a tenth of its
/// floor.
Scene make_scene(const char *name, size_t photon_count, bool cluster) {
    constexpr float patch = 0.1f;
    Scene scene{name, {}, {}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    const size_t clustered = cluster ? photon_count / 2 : 0;
    for (size_t i = 0; i < photon_count; ++i) {
        const float u = uniform(random), v = uniform(random);
        const Query at = i < clustered ? on_wall(4, 0.45f + patch * u, 0.45f + patch * v)
                                       : on_wall(static_cast<int>(random() % 6), u, v);
        const Vec3 flux{uniform(random), uniform(random), uniform(random)};
        scene.photons.push_back({at.position, flux, pack_normal(at.normal, 0), pack_direction(-at.normal)});
    }
    const auto even_density = static_cast<float>(photon_count - clustered) / 6;
    const float cluster_density = even_density + static_cast<float>(clustered) / (patch * patch);
    const auto in_cluster = [&](float t) { return t >= 0.45f && t < 0.45f + patch; };
    const auto add_raster = [&](int face, int size, float origin, float extent) {
        const float step = extent / static_cast<float>(size);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const float u = origin + step * (static_cast<float>(x) + uniform(random));
                const float v = origin + step * (static_cast<float>(y) + uniform(random));
                const bool dense = cluster && face == 4 && in_cluster(u) && in_cluster(v);
                scene.places.push_back({on_wall(face, u, v), dense ? cluster_density : even_density});
            }
        }
    };
    for (int face = 0; face < 6; ++face) add_raster(face, cluster ? 140 : 200, 0, 1);
    if (cluster) add_raster(4, 342, 0.45f, patch);
    return scene;
}

/// Runs of 500 places, one run in `step`: nanoflann would take minutes for all.
std::vector<Place> some_of(const std::vector<Place> &places, size_t step) {
    std::vector<Place> some;
    for (size_t i = 0; i < places.size(); ++i)
        if (i / 500 % step == 0) some.push_back(places[i]);
    return some;
}

// --- The work of both ---

void report(const Scene &scene, const char *what, double work, const bench::Times &ours, const bench::Times &theirs) {
    std::printf("  %-30s %-28s %-28s %s\n", what, bench::rate(work * 1e-3, ours.cpu).text(1).c_str(),
                bench::rate(work * 1e-3, theirs.cpu).text(1).c_str(),
                bench::ratio(theirs.cpu, ours.cpu).text(2).c_str());
    bench::print_row("times as fast as nanoflann, " + std::string(scene.name) + " " + what,
                     bench::ratio(theirs.cpu, ours.cpu));
}

void compare_sums(const PhotonMap &map, const Tree &tree, const Scene &scene, double photons) {
    const std::vector<Place> places = some_of(scene.places, 4);
    const EdgeIndex no_edges;
    uint64_t found = 0, found_nanoflann = 0;
    const auto times = bench::run_by_turns(
        rounds, {[&] {
                     found = 0;
                     for (const Place &place : places) {
                         const Kernel kernel{PM_FILTER_EPANECHNIKOV, place.radius_holding(photons), 1};
                         found += estimate_photons(map, no_edges, place.query, kernel).photons;
                     }
                 },
                 [&] {
                     found_nanoflann = 0;
                     for (const Place &place : places) {
                         FluxSum sum{scene.photons, place.query, place.radius_holding(photons)};
                         const Vec3 p = place.query.position;
                         const float point[3] = {p.x, p.y, p.z};
                         tree.findNeighbors(sum, point, nanoflann::SearchParams());
                         found_nanoflann += sum.count;
                     }
                 }});
    const auto difference = std::abs(static_cast<double>(found) - static_cast<double>(found_nanoflann));
    // A photon on the very edge of a kernel may be in or out by a rounding.
    bench::require(difference <= 1e-5 * static_cast<double>(found), "nanoflann found other photons within the radius");
    char what[64];
    std::snprintf(what, sizeof what, "queries: estimate of %.0f",
                  static_cast<double>(found) / static_cast<double>(places.size()));
    report(scene, what, static_cast<double>(places.size()), times[0], times[1]);
}

void compare_nearest(const PhotonMap &map, const Tree &tree, const Scene &scene, size_t k) {
    const std::vector<Place> places = some_of(scene.places, k > 100 ? 24 : 8);
    std::vector<Neighbor> neighbors;
    std::vector<uint32_t> indices(k);
    std::vector<float> distances(k);
    const auto furthest = [&] {
        return std::ranges::max_element(neighbors, {}, &Neighbor::distance_squared)->distance_squared;
    };
    std::vector<float> unlimited, guessed, nanoflann_found;  // squared distance of the k-th
    const auto times =
        bench::run_by_turns(rounds, {[&] {
                                         unlimited.clear();
                                         for (const Place &place : places) {
                                             map.nearest(place.query.position, k, infinity, neighbors);
                                             unlimited.push_back(furthest());
                                         }
                                     },
                                     // Limited by what the query before needed, as an estimate by the k nearest would.
                                     [&] {
                                         guessed.clear();
                                         float limit = infinity;
                                         for (const Place &place : places) {
                                             map.nearest(place.query.position, k, limit, neighbors);
                                             if (neighbors.size() < k)
                                                 map.nearest(place.query.position, k, infinity, neighbors);
                                             guessed.push_back(furthest());
                                             limit = std::sqrt(guessed.back()) * 1.15f;
                                         }
                                     },
                                     [&] {
                                         nanoflann_found.clear();
                                         for (const Place &place : places) {
                                             const Vec3 p = place.query.position;
                                             const float point[3] = {p.x, p.y, p.z};
                                             nanoflann::KNNResultSet<float, uint32_t> result(k);
                                             result.init(indices.data(), distances.data());
                                             tree.findNeighbors(result, point, nanoflann::SearchParams());
                                             nanoflann_found.push_back(distances[k - 1]);
                                         }
                                     }});
    bench::require(unlimited == nanoflann_found && guessed == nanoflann_found, "nanoflann found others as the nearest");
    const auto count = static_cast<double>(places.size());
    const std::string nearest = "queries: " + std::to_string(k) + " nearest";
    report(scene, nearest.c_str(), count, times[0], times[2]);
    report(scene, (nearest + ", guessed").c_str(), count, times[1], times[2]);
}

void run(const Scene &scene) {
    std::unique_ptr<PhotonMap> map;
    std::unique_ptr<Tree> tree;
    const Dataset dataset{scene.photons};
    constexpr int build_rounds = 3;
    PhotonLists lists(scene.photons, build_rounds);
    const auto times =
        bench::run_by_turns(build_rounds, {[&] { map = std::make_unique<PhotonMap>(lists.take(), 1, nullptr); },
                                           [&] {
                                               const nanoflann::KDTreeSingleIndexAdaptorParams params(leaf_size);
                                               tree = std::make_unique<Tree>(3, dataset, params);
                                               tree->buildIndex();
                                           }});
    const auto photons = static_cast<double>(scene.photons.size());
    std::printf("%s: %.0f photons, %.1f bytes each in the map\n", scene.name, photons,
                static_cast<double>(map->memory_bytes()) / photons);
    std::printf("  %-30s %-28s %-28s %s\n", "thousands a second of", "photon map", "nanoflann", "times as fast");
    report(scene, "photons: build", photons, times[0], times[1]);
    for (const size_t count : {50, 200}) {
        compare_sums(*map, *tree, scene, static_cast<double>(count));
        compare_nearest(*map, *tree, scene, count);
    }
}

}  // namespace

/// Usage: photon_map_bench [photons in millions]
int main(int argc, char **argv) {
    const double millions = argc > 1 ? std::atof(argv[1]) : 2;
    bench::require(millions >= 0.01 && millions <= 100, "photons in millions: a number from 0.01 to 100 is expected");
    bench::print_machine();
    const auto photons = static_cast<size_t>(1e6 * millions);
    run(make_scene("even", photons, false));
    run(make_scene("clustered", photons, true));
}
