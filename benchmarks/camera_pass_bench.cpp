// SPDX-License-Identifier: GPL-3.0-or-later
// The camera pass in the Cornell box with its two blocks: its camera and shadow rays against bare calls of Embree on
// the same rays, what a second thread brings, and what part of the photons' gathering goes into the kernels' true area.
#include <cstdint>

#include "boxes.h"
#include "camera_pass.h"
#include "photon_trace.h"
#include "program.h"
#include "radius.h"
#include "recorded_rays.h"

using namespace photon_maps;

namespace {

constexpr uint32_t side = 256, max_bounces = 32, seed = 1;
constexpr uint64_t photon_count = uint64_t{side} * side;

/// All that camera passes ask for.
class Box {
  public:
    explicit Box(const std::shared_ptr<Embree> &embree) : scene(embree), camera(boxes::camera(side)) {
        boxes::fill(scene, boxes::Content::blocks);
        lights.emplace(scene, std::vector{boxes::lamp()}, World());
        const Emission emission(scene, *lights);
        const PhotonTracing tracing{PhotonPurpose::global, 0, photon_count, max_bounces, seed, 1};
        kernel.radius = choose_indirect_radius(scene, emission, camera, tracing, nullptr);
        const TracedPhotons traced = trace_photons(scene, emission, tracing, nullptr);
        map.emplace(traced[PM_PHOTONS_INDIRECT], 1, nullptr);
        const auto edge_span = scene.feature_edges();
        edges = EdgeIndex({edge_span.begin(), edge_span.end()}, kernel.radius);
        coverage.emplace(scene, edges, kernel);
    }

    /// Renders a pass.
    /// @param photons none: camera and shadow rays alone
    RayCounts render(int threads, const PhotonMap &photons) const {
        const PhotonMaps maps{{&photons, &edges, &*coverage, kernel, 0, false},
                              {&no_photons, &edges, &*coverage, kernel, 0, false}};
        const CameraPass pass{scene,
                              *lights,
                              camera,
                              sampler,
                              Integrator::photon_map,
                              &maps,
                              nullptr,
                              nullptr,
                              Indirect::photons,
                              false,
                              false,
                              max_bounces,
                              1,
                              seed,
                              0,
                              false,
                              threads};
        Film film(side, side, 1u << static_cast<uint32_t>(Buffer::combined));
        return render_camera_pass(pass, film, nullptr, std::vector<bool>(film.tiles().count()), nullptr);
    }

    /// What the pixels' centres see, row by row.
    std::vector<Query> queries() const {
        std::vector<Query> found;
        for (uint32_t i = 0; i < side * side; ++i) {
            const Vec2 pixel{static_cast<float>(i % side) + 0.5f, static_cast<float>(i / side) + 0.5f};
            SurfacePoint hit;
            if (scene.intersect(camera.ray(pixel, {}), hit))
                found.push_back({hit.position, hit.normal, hit.shading_normal});
        }
        return found;
    }

    Scene scene;
    Camera camera;
    std::optional<Lights> lights;
    std::optional<PhotonMap> map;
    PhotonMap no_photons;
    Kernel kernel;
    EdgeIndex edges;
    std::optional<Coverage> coverage;
    PixelSampler sampler{PixelFilter::box, 1};
};

void measure_passes(const Box &box, Embree &embree, int rounds) {
    RayCounts counts;
    const RecordedRays recorded = rays_of([&] { counts = box.render(1, box.no_photons); }, embree);
    bench::require(counts.rays == recorded.size(), "rays of the pass were missed");
    const auto times =
        bench::run_by_turns(rounds, {[&] { trace_bare(recorded, 1); }, [&] { box.render(1, box.no_photons); },
                                     [&] { box.render(1, *box.map); }, [&] { box.render(2, *box.map); }});
    const auto rays = static_cast<double>(recorded.size());
    const auto shadow_rays = static_cast<double>(counts.shadow_rays);
    std::printf(
        "%.0f rays of the camera and shadow rays, %.0f of them shadow rays; M/s per core: bare %s, in the pass "
        "without photons %s\n",
        rays, shadow_rays, bench::rate(rays * 1e-6, times[0].cpu).text(2).c_str(),
        bench::rate(rays * 1e-6, times[1].cpu).text(2).c_str());
    bench::print_row("camera and shadow rays: rays a second, over bare ones", bench::ratio(times[0].cpu, times[1].cpu));
    bench::print_row("camera pass with its photons: wall time by one thread, over two",
                     bench::ratio(times[2].wall, times[3].wall));
}

void measure_area(const Box &box, int rounds) {
    const std::vector<Query> queries = box.queries();
    const EdgeIndex no_edges;
    double sums[2];
    const auto estimate_all = [&](const EdgeIndex &edges, double &sum) {
        sum = 0;
        for (const Query &query : queries) sum += double{estimate_photons(*box.map, edges, query, box.kernel).value.x};
    };
    const auto times = bench::run_by_turns(
        rounds, {[&] { estimate_all(box.edges, sums[0]); }, [&] { estimate_all(no_edges, sums[1]); }});
    bench::require(sums[0] > sums[1], "estimates by the true area are not brighter");
    std::printf("%zu estimates among %zu edges, thousands a second: %s, without edges %s\n", queries.size(),
                box.edges.size(), bench::rate(static_cast<double>(queries.size()) * 1e-3, times[0].cpu).text(1).c_str(),
                bench::rate(static_cast<double>(queries.size()) * 1e-3, times[1].cpu).text(1).c_str());
    std::vector<double> shares;
    for (int round = 0; round < rounds; ++round) {
        const auto i = static_cast<size_t>(round);
        shares.push_back(1 - times[1].cpu[i] / times[0].cpu[i]);
    }
    bench::print_row("the kernels' true area: share of the estimates' time", bench::Statistic(shares));
}

}  // namespace

/// Usage: PHOTON_MAPS_EMBREE=libembree4.so camera_pass_bench [rounds]
int main(int argc, char **argv) {
    bench::run_with_embree(argc, argv, [](const std::shared_ptr<Embree> &embree, int rounds) {
        const Box box(embree);
        measure_passes(box, *embree, rounds);
        measure_area(box, rounds);
    });
}
