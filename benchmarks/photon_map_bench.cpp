// SPDX-License-Identifier: GPL-3.0-or-later
// The photon map against nanoflann (libnanoflann-dev): CPU time to build, to sum the photons within a radius, and to
// find the k nearest. Both do the same work on the same queries, by turns in one process.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <nanoflann.hpp>
#include <random>
#include <vector>

#include "estimate.h"
#include "photon_map.h"

using namespace photon_maps;

namespace {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_of(const std::function<void()> &work) {
    const double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
}

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

/// A result set that sums photons as estimate_irradiance does, without storing them.
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
    std::vector<Query> queries;
    std::vector<float> densities;  ///< photons per area at each query
};

/// Photons evenly on the walls of a cube; with `cluster`, half of photons and queries on a tenth by a tenth of its
/// floor.
Scene make_scene(const char *name, size_t photon_count, bool cluster) {
    constexpr float patch = 0.1f;
    Scene scene{name, {}, {}, {}};
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
    const auto add_raster = [&](int face, int size, float origin, float extent, float density) {
        const float step = extent / static_cast<float>(size);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                scene.queries.push_back(on_wall(face, origin + step * (static_cast<float>(x) + uniform(random)),
                                                origin + step * (static_cast<float>(y) + uniform(random))));
                scene.densities.push_back(density);
            }
        }
    };
    for (int face = 0; face < 6; ++face) add_raster(face, cluster ? 140 : 200, 0, 1, even_density);
    if (cluster) add_raster(4, 342, 0.45f, patch, even_density + static_cast<float>(clustered) / (patch * patch));
    return scene;
}

void run(const Scene &scene) {
    // 1. Build. nanoflann's leaf size is the best of those tried.
    std::unique_ptr<PhotonMap> map;
    const double build_ours =
        seconds_of([&] { map = std::make_unique<PhotonMap>(std::span(scene.photons), 1, nullptr); });
    const Dataset dataset{scene.photons};
    const auto sum_nanoflann = [&](const Tree &tree, double photons_wanted, size_t step) {
        double found = 0;
        for (size_t q = 0; q < scene.queries.size(); q += step) {
            const float radius = std::sqrt(static_cast<float>(photons_wanted) / (pi * scene.densities[q]));
            FluxSum result{scene.photons, scene.queries[q], radius};
            const Vec3 p = scene.queries[q].position;
            const float point[3] = {p.x, p.y, p.z};
            tree.findNeighbors(result, point, nanoflann::SearchParams());
            found += result.count;
        }
        return found;
    };
    std::unique_ptr<Tree> tree;
    double best_seconds = 1e30, build_nanoflann = 0;
    size_t best_leaf = 0;
    for (const size_t leaf : {16, 32}) {
        std::unique_ptr<Tree> candidate;
        const double build = seconds_of([&] {
            candidate = std::make_unique<Tree>(3, dataset, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
            candidate->buildIndex();
        });
        const double seconds = seconds_of([&] { sum_nanoflann(*candidate, 50, 1); });
        if (seconds > best_seconds) continue;
        best_seconds = seconds;
        best_leaf = leaf;
        build_nanoflann = build;
        tree = std::move(candidate);
    }
    // The k nearest take nanoflann so long that blocks of neighbouring queries are enough: one in eight.
    const auto is_sampled = [](size_t q) { return q / 1000 % 8 == 0; };
    const auto thousand_queries = static_cast<double>(scene.queries.size()) * 1e-3;
    std::printf("%s: %zu photons, %zu queries, %.1f bytes a photon; nanoflann's leaf size %zu\n", scene.name,
                scene.photons.size(), scene.queries.size(),
                static_cast<double>(map->memory_bytes()) / static_cast<double>(scene.photons.size()), best_leaf);
    std::printf("  %-34s %9.3f s    nanoflann %9.3f s    ratio %5.2f\n", "build", build_ours, build_nanoflann,
                build_nanoflann / build_ours);
    const auto report = [&](const char *what, double wanted, double ours, double theirs, double found) {
        std::printf("  %-18s %4.0f photons    %9.1f kq/s nanoflann %9.1f kq/s ratio %5.2f  (%.1f found)\n", what,
                    wanted, thousand_queries / ours, thousand_queries / theirs, theirs / ours,
                    found / thousand_queries * 1e-3);
    };

    constexpr int rounds = 2;
    const EdgeIndex no_edges;
    for (const double wanted : {50.0, 200.0}) {
        // 2. The sum within a radius.
        double ours = 1e30, theirs = 1e30, found = 0, found_nanoflann = 0;
        for (int round = 0; round < rounds; ++round) {
            ours = std::min(ours, seconds_of([&] {
                                found = 0;
                                for (size_t q = 0; q < scene.queries.size(); ++q) {
                                    const float radius =
                                        std::sqrt(static_cast<float>(wanted) / (pi * scene.densities[q]));
                                    const Kernel kernel{PM_FILTER_EPANECHNIKOV, radius, 1};
                                    found += estimate_irradiance(*map, no_edges, scene.queries[q], kernel).photons;
                                }
                            }));
            theirs = std::min(theirs, seconds_of([&] { found_nanoflann = sum_nanoflann(*tree, wanted, 1); }));
        }
        report("range sum", wanted, ours, theirs, found);
        if (std::abs(found - found_nanoflann) > 1e-5 * found)
            std::printf("  but nanoflann found %.0f\n", found_nanoflann);

        // 3. The k nearest: without a limit, and limited by what the query before needed.
        const auto k = static_cast<size_t>(wanted);
        double guessed = 1e30, unlimited = 1e30, checksum = 0, checksum_nanoflann = 0;
        theirs = 1e30;
        std::vector<Neighbor> neighbors;
        const auto furthest = [&] {
            return std::ranges::max_element(neighbors, {}, &Neighbor::distance_squared)->distance_squared;
        };
        std::vector<uint32_t> indices(k);
        std::vector<float> distances(k);
        for (int round = 0; round < rounds; ++round) {
            unlimited =
                std::min(unlimited, seconds_of([&] {
                             for (const Query &query : scene.queries) {
                                 map->nearest(query.position, k, std::numeric_limits<float>::infinity(), neighbors);
                             }
                         }));
            guessed = std::min(guessed, seconds_of([&] {
                                   checksum = 0;
                                   float limit = std::numeric_limits<float>::infinity();
                                   for (size_t q = 0; q < scene.queries.size(); ++q) {
                                       const Vec3 p = scene.queries[q].position;
                                       map->nearest(p, k, limit, neighbors);
                                       if (neighbors.size() < k) {
                                           map->nearest(p, k, std::numeric_limits<float>::infinity(), neighbors);
                                       }
                                       const float distance_squared = furthest();
                                       limit = std::sqrt(distance_squared) * 1.15f;
                                       if (is_sampled(q)) checksum += distance_squared;
                                   }
                               }));
            double sampled = 0;
            const double seconds = seconds_of([&] {
                checksum_nanoflann = 0;
                for (size_t q = 0; q < scene.queries.size(); ++q) {
                    if (!is_sampled(q)) continue;
                    const Vec3 p = scene.queries[q].position;
                    const float point[3] = {p.x, p.y, p.z};
                    nanoflann::KNNResultSet<float, uint32_t> result(k);
                    result.init(indices.data(), distances.data());
                    tree->findNeighbors(result, point, nanoflann::SearchParams());
                    checksum_nanoflann += distances[k - 1];
                    ++sampled;
                }
            });
            theirs = std::min(theirs, seconds * static_cast<double>(scene.queries.size()) / sampled);
        }
        report("nearest", wanted, unlimited, theirs, wanted * thousand_queries * 1e3);
        report("nearest, guessed", wanted, guessed, theirs, wanted * thousand_queries * 1e3);
        if (std::abs(checksum - checksum_nanoflann) > 1e-5 * checksum) std::printf("  but nanoflann found others\n");
    }
}

}  // namespace

/// Usage: photon_map_bench [photons in millions]
int main(int argc, char **argv) {
    const auto photons = static_cast<size_t>(1e6 * (argc > 1 ? std::atof(argv[1]) : 2));
    run(make_scene("even", photons, false));
    run(make_scene("clustered", photons, true));
}
