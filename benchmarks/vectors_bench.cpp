// SPDX-License-Identifier: GPL-3.0-or-later
// Queries of the photon map by each of the instruction sets that simd.h chooses from, on one thread. Which are held
// back is read once a process: each measurement is a process of its own, and they run by turns.
#include <unistd.h>

#include <array>
#include <memory>
#include <random>

#include "estimate.h"
#include "measure.h"
#include "nested_estimate.h"
#include "photon_map.h"
#include "processor.h"

using namespace photon_maps;

namespace {

constexpr int rounds = 15;
constexpr size_t photon_count = 1000000, query_count = 30000;
constexpr double photons_within = 200;  // a query's kernel, where nothing is turned away
constexpr Vec3 up{0, 0, 1};

constexpr std::array works{"estimate of 200 photons", "the same, by shading normals", "the same, by eight radii",
                           "200 nearest"};

/// What runs it, and what of the environment holds it back to that.
struct Level {
    const char *name, *environment;
};
constexpr std::array levels{Level{"SSE4.2", "PHOTON_MAPS_WITHOUT_AVX2=1"},
                            Level{"AVX2", "PHOTON_MAPS_WITHOUT_AVX512=1"}, Level{"AVX-512", ""}};

using Seconds = std::array<double, works.size()>;  ///< of CPU time

/// Photons evenly on a unit square.
PhotonMap make_map(std::mt19937 &random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<Photon> photons;
    for (size_t i = 0; i < photon_count; ++i) {
        const Vec3 position{uniform(random), uniform(random), 0}, flux{uniform(random), uniform(random), 1};
        const Vec3 from = normalize({uniform(random), uniform(random), 1});
        photons.push_back({position, flux, pack_normal(up, 0), pack_direction(-from)});
    }
    return {photons, 1, nullptr};
}

/// Does each of the works once, and writes what it took and what came of it, a line each.
void measure() {
    std::mt19937 random(1);
    const PhotonMap map = make_map(random);
    const EdgeIndex no_edges;
    const Kernel kernel{PM_FILTER_EPANECHNIKOV, static_cast<float>(std::sqrt(photons_within / (pi * photon_count))), 1};
    const LevelDiscs discs{kernel.radius * sqrt(level_areas()), broadcast(1)};
    std::vector<Query> queries;
    for (size_t i = 0; i < query_count; ++i) {  // row by row, as pixels ask for them
        const auto row = static_cast<float>(i / 200), column = static_cast<float>(i % 200);
        queries.push_back({{column / 200, row * 200 / query_count, 0}, up, up});
    }
    std::vector<Neighbor> neighbors;
    const auto smooth = [](Query query) {
        query.shading_normal = normalize({0.1f, 0.1f, 1});
        return query;
    };
    const std::array<std::function<float(const Query &)>, works.size()> asked{
        [&](const Query &query) { return estimate_photons(map, no_edges, query, kernel).value.x; },
        [&](const Query &query) { return estimate_photons(map, no_edges, smooth(query), kernel).value.x; },
        [&](const Query &query) { return estimate_levels(map, no_edges, query, kernel, discs).red[0]; },
        [&](const Query &query) {
            map.nearest(query.position, 200, infinity, neighbors);
            return std::ranges::max_element(neighbors, {}, &Neighbor::distance_squared)->distance_squared;
        }};
    for (const auto &ask : asked) {
        double sum = 0;
        const double begin = bench::seconds_on(CLOCK_PROCESS_CPUTIME_ID);
        for (const Query &query : queries) sum += double{ask(query)};
        std::printf("%.9g %a\n", bench::seconds_on(CLOCK_PROCESS_CPUTIME_ID) - begin, sum);
    }
}

/// Measures in a process of its own. @param results sums of the queries' results; where there are any they must agree
Seconds measured(const Level &level, const std::string &program, std::vector<double> &results) {
    const std::string command = std::string(level.environment) + " '" + program + "' measure";
    const std::unique_ptr<FILE, int (*)(FILE *)> output(popen(command.c_str(), "r"), pclose);
    bench::require(output != nullptr, "no process could be started");
    Seconds seconds{};
    std::vector<double> found(works.size());
    for (size_t i = 0; i < works.size(); ++i)
        bench::require(std::fscanf(output.get(), "%lf %la", &seconds[i], &found[i]) == 2, command + " failed");
    if (results.empty()) results = found;
    bench::require(results == found, std::string(level.name) + " finds something else");
    return seconds;
}

std::string own_path() {
    std::array<char, 4096> path{};
    bench::require(readlink("/proc/self/exe", path.data(), path.size() - 1) > 0, "the program does not find itself");
    return path.data();
}

/// Returns how many of the levels this processor has.
size_t offered() {
#if defined(__x86_64__)
    return has_avx512 ? 3 : has_avx2 ? 2 : 1;
#else
    return 1;
#endif
}

void compare() {
    bench::print_machine();
    const size_t count = offered();
    std::vector<double> results;
    std::array<std::array<std::vector<double>, levels.size()>, works.size()> seconds;
    for (int round = 0; round < rounds; ++round) {
        for (size_t level = 0; level < count; ++level) {
            const Seconds taken = measured(levels[level], own_path(), results);
            for (size_t work = 0; work < works.size(); ++work) seconds[work][level].push_back(taken[work]);
        }
    }
    for (size_t work = 0; work < works.size(); ++work) {
        const auto &taken = seconds[work];
        std::printf("%s: %s thousand a second by SSE4.2\n", works[work],
                    bench::rate(1e-3 * query_count, taken[0]).text(1).c_str());
        for (size_t level = 1; level < count; ++level) {
            const bench::Statistic ratio = bench::ratio(taken[level - 1], taken[level]);
            std::printf("  %-8s %s times as fast as %s\n", levels[level].name, ratio.text(3).c_str(),
                        levels[level - 1].name);
            bench::print_row(std::string(levels[level].name) + " over " + levels[level - 1].name + ", " + works[work],
                             ratio);
        }
    }
}

}  // namespace

int main(int argc, char **) {
    if (argc > 1) {
        measure();
    } else {
        compare();
    }
}
