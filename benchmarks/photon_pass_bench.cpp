// SPDX-License-Identifier: GPL-3.0-or-later
// The photon pass against bare rtcIntersect1 on the very rays that the pass traces, in the same order; and what a
// second thread brings. The scene is the Cornell box with a bumpy sphere of 80,000 triangles for its two boxes.
#include <cstdint>
#include <exception>
#include <stdexcept>

#include "measure.h"
#include "parallel.h"
#include "photon_map.h"
#include "photon_maps_shader.h"
#include "photon_trace.h"

using namespace photon_maps;

namespace {

constexpr uint64_t photon_count = 1 << 18;
constexpr uint32_t max_bounces = 32, seed = 1;
constexpr int rounds = 7;

// --- The scene, in metres, y upwards ---

void add_object(Scene &scene, std::vector<Vec3> vertices, std::vector<Triangle> triangles, Vec3 albedo) {
    const auto number = static_cast<uint32_t>(scene.meshes.size());
    vertices.emplace_back();  // Embree reads 16 bytes at each
    Mesh &mesh = scene.meshes.emplace_back();
    mesh.vertices = std::move(vertices);
    mesh.triangles = std::move(triangles);
    mesh.slot_count = 1;
    Material &material = scene.materials.emplace_back();
    material.program = {.constants = {albedo, {}},
                        .instructions = {{PM_OP_INPUT, PM_INPUT_NORMAL, 0, 2, 0, 0}, {PM_OP_DIFFUSE, 0, 0, 3, 0, 3}},
                        .arguments = {0, 1, 2},
                        .register_count = 3};
    prepare(material, scene);
    scene.slot_materials.push_back(number);
    Instance &instance = scene.instances.emplace_back();
    instance.mesh = instance.first_slot = number;
}

void add_wall(Scene &scene, Vec3 corner, Vec3 along, Vec3 up, Vec3 albedo) {
    add_object(scene, {corner, corner + along, corner + along + up, corner + up}, {{0, 1, 2}, {0, 2, 3}}, albedo);
}

/// A sphere of 200 x 200 quads whose radius waves.
void add_bumpy_sphere(Scene &scene, Vec3 center, float radius, Vec3 albedo) {
    constexpr uint32_t size = 200;
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    for (uint32_t i = 0; i <= size; ++i) {
        const float polar = pi * static_cast<float>(i) / size;
        for (uint32_t j = 0; j < size; ++j) {
            const float azimuth = 2 * pi * static_cast<float>(j) / size;
            const float bumps = 1 + 0.08f * std::sin(12 * polar) * std::sin(12 * azimuth);
            const Vec3 direction{std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                 std::sin(polar) * std::sin(azimuth)};
            vertices.push_back(center + direction * (radius * bumps));
        }
    }
    for (uint32_t i = 0; i < size; ++i) {
        for (uint32_t j = 0; j < size; ++j) {
            const uint32_t next = (j + 1) % size;
            const uint32_t a = i * size + j, b = i * size + next, c = a + size, d = b + size;
            triangles.push_back({a, b, c});
            triangles.push_back({b, d, c});
        }
    }
    add_object(scene, std::move(vertices), std::move(triangles), albedo);
}

void fill_scene(Scene &scene) {
    constexpr Vec3 white{0.725f, 0.71f, 0.68f}, red{0.63f, 0.065f, 0.05f}, green{0.14f, 0.45f, 0.091f};
    add_wall(scene, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, white);  // floor
    add_wall(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, white);  // ceiling
    add_wall(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white);  // back
    add_wall(scene, {-1, 0, -1}, {0, 0, 2}, {0, 2, 0}, red);    // left
    add_wall(scene, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, green);   // right
    add_bumpy_sphere(scene, {0, 0.8f, -0.1f}, 0.6f, white);
    scene.freeze();
    scene.build(thread_count(0), nullptr);
}

Lamp ceiling_lamp() {
    constexpr float width = 0.5f, height = 0.4f;
    Lamp lamp{LightType::rectangle, {}, Vec3{17, 12, 6} * (pi * width * height)};
    lamp.transform = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 1.98f, 0}};
    lamp.width = width;
    lamp.height = height;
    return lamp;
}

// --- The rays of a pass ---

using Intersect = decltype(rtc::Functions::rtcIntersect1);

/// What a pass asks of Embree. rtcIntersect1 brings no context along, so there is one for the program.
struct Recording {
    Intersect intersect = nullptr;
    rtc::Scene scene = nullptr;
    std::vector<rtc::Ray> rays;
    uint64_t hits = 0;
};

Recording &recording() {
    static Recording the_recording;
    return the_recording;
}

void record(rtc::Scene scene, rtc::RayHit *ray, void *arguments) {
    Recording &r = recording();
    r.scene = scene;
    r.rays.push_back(ray->ray);
    r.intersect(scene, ray, arguments);
    r.hits += ray->hit.geometry != rtc::invalid_id;
}

/// Runs a pass on one thread with a recorder in the place of rtcIntersect1.
/// @param embree made without const
Recording rays_of(const std::function<TracedPhotons(int)> &pass, Embree &embree) {
    Intersect &intersect = const_cast<rtc::Functions &>(embree.functions()).rtcIntersect1;
    recording().intersect = intersect;
    intersect = record;
    const TracedPhotons photons = pass(1);
    intersect = recording().intersect;
    bench::require(photons.rays == recording().rays.size(), "rays of the pass were missed");
    bench::require(photons.size() == recording().hits, "a hit left no photon");
    return std::move(recording());
}

/// Traces the recorded rays and nothing else.
void trace_bare(const Recording &recorded, int threads) {
    constexpr size_t block = 2048;
    std::atomic<uint64_t> hits = 0;
    const size_t count = recorded.rays.size();
    parallel_for(threads, (count + block - 1) / block, nullptr, [&](size_t b) {
        uint64_t block_hits = 0;
        for (size_t i = b * block; i < std::min((b + 1) * block, count); ++i) {
            rtc::RayHit ray{recorded.rays[i], {}};
            ray.hit.geometry = ray.hit.instance = rtc::invalid_id;
            recorded.intersect(recorded.scene, &ray, nullptr);
            block_hits += ray.hit.geometry != rtc::invalid_id;
        }
        hits += block_hits;
    });
    bench::require(hits == recorded.hits, "bare rays hit something else");
}

void run(const char *path) {
    const auto embree = std::make_shared<Embree>(path);
    Scene scene(embree);
    fill_scene(scene);
    const Lights lights(scene, {ceiling_lamp()}, {});
    const Emission emission(scene, lights);
    const auto pass = [&](int threads) {
        return trace_photons(scene, emission,
                             {PhotonPurpose::global, 0, photon_count, max_bounces, seed, threads, true}, nullptr);
    };
    const Recording recorded = rays_of(pass, *embree);
    const auto rays = static_cast<double>(recorded.rays.size());
    const TracedPhotons photons = pass(1);
    const auto indirect = static_cast<double>(photons[PM_PHOTONS_INDIRECT].size());
    std::printf("%llu photons emitted, %.0f rays, %llu photons stored\n", static_cast<unsigned long long>(photon_count),
                rays, static_cast<unsigned long long>(recorded.hits));

    const auto build = [&](int threads) { PhotonMap(photons[PM_PHOTONS_INDIRECT], threads, nullptr); };
    const std::vector<bench::Times> times =
        bench::run_by_turns(rounds, {[&] { trace_bare(recorded, 1); }, [&] { pass(1); }, [&] { build(1); },
                                     [&] { trace_bare(recorded, 2); }, [&] { pass(2); }, [&] { build(2); }});
    const char *names[] = {"bare rtcIntersect1, rays", "photon pass, rays", "map of the indirect, photons"};
    const double work[] = {rays, rays, indirect};
    std::printf("%-30s %-28s %-28s %s\n", "", "1 thread: M/s per core", "2 threads: M/s per core",
                "2 threads in wall time: times as fast");
    for (size_t i = 0; i < 3; ++i) {
        std::printf("%-30s %-28s %-28s %s\n", names[i], bench::rate(work[i] * 1e-6, times[i].cpu).text(2).c_str(),
                    bench::rate(work[i] * 1e-6, times[i + 3].cpu).text(2).c_str(),
                    bench::ratio(times[i].wall, times[i + 3].wall).text(2).c_str());
    }
    std::printf("%-30s %-28s %s\n", "photon pass / bare", bench::ratio(times[0].cpu, times[1].cpu).text(2).c_str(),
                bench::ratio(times[3].cpu, times[4].cpu).text(2).c_str());
}

}  // namespace

/// Usage: PHOTON_MAPS_EMBREE=libembree4.so photon_pass_bench
int main() {
    const char *path = std::getenv("PHOTON_MAPS_EMBREE");
    bench::require(path, "set the environment variable PHOTON_MAPS_EMBREE to an Embree 4 library");
    bench::print_machine();
    try {
        run(path);
    } catch (const std::exception &error) {
        bench::require(false, error.what());
    }
}
