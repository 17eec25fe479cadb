// SPDX-License-Identifier: GPL-3.0-or-later
// The photon pass against bare rtcIntersect1 on the very rays that the pass traces, in the same order; the photon map's
// build beside it; and what a second thread brings. In the Cornell box with a matte bumpy sphere, and with a glass
// ball, where photons that are to make caustics are traced by themselves, too.
#include <cstdint>

#include "boxes.h"
#include "photon_lists.h"
#include "photon_map.h"
#include "photon_trace.h"
#include "program.h"
#include "recorded_rays.h"

using namespace photon_maps;

namespace {

constexpr uint64_t photon_count = 1 << 18;
constexpr uint32_t max_bounces = 32, seed = 1;

/// A photon pass by a number of threads.
using Pass = std::function<TracedPhotons(int)>;

/// What is measured of a pass, by one thread and by two.
struct Measured {
    bench::Times bare, pass, build;
};

void print_rates(const char *what, double work, const Measured (&by)[2], bench::Times Measured::*part) {
    const bench::Times &one = by[0].*part, &two = by[1].*part;
    std::printf("%-30s %-28s %-28s %s\n", what, bench::rate(work * 1e-6, one.cpu).text(2).c_str(),
                bench::rate(work * 1e-6, two.cpu).text(2).c_str(), bench::ratio(one.wall, two.wall).text(2).c_str());
}

/// @param name of the pass in the table's rows
void measure(const std::string &name, const Pass &pass, pm_photon_kind kind, Embree &embree, int rounds) {
    uint64_t rays_of_pass = 0;
    const RecordedRays recorded = rays_of([&] { rays_of_pass = pass(1).rays; }, embree);
    bench::require(rays_of_pass == recorded.size(), "rays of the pass were missed");
    const TracedPhotons traced = pass(1);
    const std::vector<Photon> &photons = traced[kind];
    std::printf("%s: %zu rays, %zu photons stored, %zu in the map\n", name.c_str(), recorded.size(), traced.size(),
                photons.size());

    PhotonLists lists(photons, 2 * rounds);
    const auto build = [&](int threads) { PhotonMap(lists.take(), threads, nullptr); };
    const std::vector<bench::Times> times =
        bench::run_by_turns(rounds, {[&] { trace_bare(recorded, 1); }, [&] { pass(1); }, [&] { build(1); },
                                     [&] { trace_bare(recorded, 2); }, [&] { pass(2); }, [&] { build(2); }});
    const Measured by[2] = {{times[0], times[1], times[2]}, {times[3], times[4], times[5]}};
    std::printf("%-30s %-28s %-28s %s\n", "", "1 thread: M/s per core", "2 threads: M/s per core",
                "2 threads in wall time: times as fast");
    const auto rays = static_cast<double>(recorded.size());
    print_rates("bare rtcIntersect1, rays", rays, by, &Measured::bare);
    print_rates("photon pass, rays", rays, by, &Measured::pass);
    print_rates("photon map, photons", static_cast<double>(photons.size()), by, &Measured::build);
    bench::print_row(name + ": rays a second, over bare ones", bench::ratio(by[0].bare.cpu, by[0].pass.cpu));
    bench::print_row(name + ": the same by two threads", bench::ratio(by[1].bare.cpu, by[1].pass.cpu));
    bench::print_row(name + ": time of the map's build, over the pass's",
                     bench::ratio(by[0].build.cpu, by[0].pass.cpu));
    bench::print_row(name + ": the same by two threads, wall time", bench::ratio(by[1].build.wall, by[1].pass.wall));
    bench::print_row(name + ": wall time by one thread, over two", bench::ratio(by[0].pass.wall, by[1].pass.wall));
    bench::print_row(name + ": the same of the map's build", bench::ratio(by[0].build.wall, by[1].build.wall));
}

/// Measures the passes of a box.
void run(const std::shared_ptr<Embree> &embree, boxes::Content content, const std::string &name, int rounds) {
    Scene scene(embree);
    boxes::fill(scene, content);
    const Lights lights(scene, {boxes::lamp()}, {});
    const Emission emission(scene, lights);
    const auto pass = [&](PhotonPurpose purpose) {
        return [&, purpose](int threads) {
            const bool is_global = purpose == PhotonPurpose::global;
            return trace_photons(scene, emission, {purpose, 0, photon_count, max_bounces, seed, threads, is_global},
                                 nullptr);
        };
    };
    measure("photons in a box with " + name, pass(PhotonPurpose::global), PM_PHOTONS_INDIRECT, *embree, rounds);
    if (emission.has_casters())
        measure("caustic photons of " + name, pass(PhotonPurpose::caustic), PM_PHOTONS_CAUSTIC, *embree, rounds);
}

}  // namespace

/// Usage: PHOTON_MAPS_EMBREE=libembree4.so photon_pass_bench [rounds]
int main(int argc, char **argv) {
    bench::run_with_embree(argc, argv, [](const std::shared_ptr<Embree> &embree, int rounds) {
        run(embree, boxes::Content::bumpy_sphere, "a matte sphere", rounds);
        run(embree, boxes::Content::glass_ball, "a glass ball", rounds);
    });
}
