// SPDX-License-Identifier: GPL-3.0-or-later
// The estimate by eight radii against that by each one of them.
#include <random>
#include <string>

#include "check.h"
#include "nested_estimate.h"

using namespace photon_maps;

namespace {

constexpr std::array filters{PM_FILTER_NONE, PM_FILTER_CONE, PM_FILTER_GAUSSIAN, PM_FILTER_EPANECHNIKOV};
constexpr Vec3 up{0, 0, 1};
constexpr float largest_radius = 0.25f;

Vec3 random_direction(std::mt19937 &random) {
    std::normal_distribution<float> normal;
    return normalize({normal(random), normal(random), normal(random)});
}

/// Photons on and a little above a square, of any orientation, from anywhere.
std::vector<Photon> random_photons(std::mt19937 &random, size_t count) {
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<Photon> photons;
    for (size_t i = 0; i < count; ++i) {
        const Vec3 position{uniform(random), uniform(random), 0.03f * uniform(random)};
        const Vec3 normal = i % 3 == 0 ? random_direction(random) : up;
        photons.push_back({position,
                           {uniform(random), uniform(random), uniform(random)},
                           pack_normal(normal, 0),
                           pack_direction(random_direction(random))});
    }
    return photons;
}

/// A rectangle and a line across it, in the plane of the queries.
std::vector<FeatureEdge> plane_edges() {
    const std::array<Vec3, 4> corners{{{0.2f, 0.25f, 0}, {0.7f, 0.25f, 0}, {0.7f, 0.8f, 0}, {0.2f, 0.8f, 0}}};
    std::vector<FeatureEdge> edges;
    for (size_t i = 0; i < 4; ++i) edges.push_back({corners[i], corners[(i + 1) % 4], up});
    edges.push_back({{0.1f, 0.9f, 0}, {0.9f, 0.1f, 0}, -up});
    return edges;
}

LevelDiscs flat_discs(float radius) { return {radius * sqrt(level_areas()), broadcast(1)}; }

void check_against_each_radius(test::Checks &checks) {
    std::mt19937 random(31);
    std::uniform_real_distribution<float> uniform(0, 1);
    const PhotonMap map(random_photons(random, 40000), 1, nullptr);
    const EdgeIndex edges(plane_edges(), largest_radius), no_edges;
    Shading rough;
    rough.outgoing = rough.normal = up;
    Closure &closure = rough.closures.emplace_back();
    closure = {ClosureType::diffuse, {0.8f, 0.6f, 0.4f}, up};
    closure.roughness = 0.7f;
    std::array<int, level_count> found_photons{};
    int cut = 0;
    for (uint32_t round = 0; round < 240; ++round) {
        Query query{{uniform(random), uniform(random), 0}, up, up};
        if (round % 4 == 1) query.shading_normal = normalize(up + 0.7f * random_direction(random));
        if (round % 4 == 2) query.is_bent = true;
        if (round % 4 == 3) query.shading = &rough;
        Kernel kernel{filters[round / 4 % 4], largest_radius * (0.3f + 0.7f * uniform(random)), 1.1f};
        const EdgeIndex &index = round / 16 % 2 == 0 ? edges : no_edges;
        LevelDiscs discs = flat_discs(kernel.radius);
        if (round % 5 == 0) discs.share[3] = 0.7f;
        if (round % 7 == 0) discs.radius[6] = discs.radius[4];  // where less of it is covered a disc is smaller
        const Levels levels = estimate_levels(map, index, query, kernel, discs);
        for (size_t level = 0; level < level_count; ++level) {
            kernel.radius = discs.radius[level];
            const Estimate expected = estimate_photons(map, index, query, kernel);
            const std::string name = "level " + std::to_string(level) + " in round " + std::to_string(round);
            const double share = double{discs.share[level]};
            const Vec3 found = levels.color(level);
            for (int c = 0; c < 3; ++c)
                checks.near(double{found[c]}, double{expected.value[c]} / share, 1e-4 * double{expected.value[c]},
                            name);
            if (level == level_count - 1)
                checks.near(double{levels.density}, double{expected.density}, 1e-4 * double{expected.density}, name);
            found_photons[level] += expected.photons > 0;
            if (&index == &edges) cut += KernelRegion(edges, query.position, up, kernel).share() < 1;
        }
    }
    for (const int count : found_photons) checks.that(count > 100, "photons are found by every radius");
    checks.that(cut > 100, "edges cut discs");
}

/// Photons at random on a plane: the variance that a single gather tells is that of many gathers.
void check_variance(test::Checks &checks) {
    std::mt19937 random(37);
    std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
    std::poisson_distribution<int> number(2000);
    constexpr int rounds = 1500;
    std::array<double, level_count> told{}, sum{}, squares{};
    const Kernel kernel{PM_FILTER_EPANECHNIKOV, largest_radius, 1};
    for (int round = 0; round < rounds; ++round) {
        std::vector<Photon> photons(static_cast<size_t>(number(random)));
        for (Photon &photon : photons)
            photon = {{uniform(random), uniform(random), 0}, {3, 2, 1}, pack_normal(up, 0), pack_direction(-up)};
        const Levels levels = estimate_levels(PhotonMap(photons, 1, nullptr), EdgeIndex(), {{0, 0, 0}, up, up}, kernel,
                                              flat_discs(largest_radius));
        for (size_t level = 0; level < level_count; ++level) {
            const auto value = double{average(levels.color(level))};
            told[level] += double{levels.variance[level]} / rounds;
            sum[level] += value / rounds;
            squares[level] += value * value / rounds;
        }
    }
    for (size_t level = 0; level < level_count; ++level) {
        const double variance = squares[level] - sum[level] * sum[level];
        checks.near(told[level], variance, 0.2 * variance, "the variance of level " + std::to_string(level));
    }
}

void check_light_of_a_colour(test::Checks &checks) {
    Levels levels;
    levels.red = levels.green = levels.blue = broadcast(2);
    levels.variance = broadcast(4);
    levels.density = 7;
    Levels sum = Vec3{0.5f, 1, 1.5f} * levels;
    checks.that(sum.color(3) == Vec3{1, 2, 3} && sum.variance[3] == 4 && sum.density == 7, "a colour on average 1");
    sum += Vec3{2, 2, 2} * levels;
    checks.that(sum.color(7) == Vec3{5, 6, 7} && sum.variance[7] == 20 && sum.density == 14, "two lights");
}

}  // namespace

int main() {
    test::Checks checks;
    check_against_each_radius(checks);
    check_variance(checks);
    check_light_of_a_colour(checks);
    const Levels none = estimate_levels(PhotonMap(), EdgeIndex(), {{0, 0, 0}, up, up}, {}, flat_discs(1));
    checks.that(none.color(level_count - 1) == Vec3{} && none.density == 0, "an empty map");
    return checks.report();
}
