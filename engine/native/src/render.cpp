// SPDX-License-Identifier: GPL-3.0-or-later
#include "render.h"

#include <chrono>

#include "parallel.h"
#include "radius.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t photon_stream = 0x70686f74, camera_stream = 0x63616d65;
constexpr uint64_t min_photon_count = 1 << 16, max_photon_count = 1 << 22;

/// Adds the time that a scope takes.
class Stopwatch {
  public:
    explicit Stopwatch(double &seconds) : seconds_(seconds) {}
    Stopwatch(const Stopwatch &) = delete;
    Stopwatch &operator=(const Stopwatch &) = delete;
    ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  private:
    double &seconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// As many photons as pixels: error per time is flat between half and twice that.
uint64_t photon_count_for(const RenderSettings &settings, const Camera &camera) {
    if (settings.photon_count != 0) return settings.photon_count;
    return std::clamp(uint64_t{camera.frame_width} * camera.frame_height, min_photon_count, max_photon_count);
}

}  // namespace

Render::Render(Scene &scene, const Lights &lights, const Camera &camera, const RenderSettings &settings)
    : scene_(scene),
      lights_(lights),
      camera_(camera),
      settings_(settings),
      pixel_sampler_(settings.pixel_filter, settings.pixel_filter_width),
      photon_count_(photon_count_for(settings, camera)),
      film_(camera.width, camera.height, settings.buffers) {}

bool Render::needs_photons() const {
    return settings_.integrator == Integrator::photon_map && settings_.max_bounces > 0 && !lights_.empty() &&
           !scene_.instances.empty();
}

void Render::render_pass(uint32_t index) {
    Film pass_film(camera_.width, camera_.height, settings_.buffers);
    try {
        render_into(pass_film, index);
    } catch (const Cancelled &) {
        cancel_ = false;
        throw;
    }
    film_.add(pass_film);
}

void Render::choose_radius() {
    const PhotonTracing tracing{0, photon_count_, settings_.max_bounces, hash(settings_.seed, photon_stream),
                                settings_.threads};
    Kernel kernel = settings_.kernel;
    if (!(kernel.radius > 0)) kernel.radius = choose_first_radius(scene_, lights_, camera_, tracing, &cancel_);
    if (kernel.radius > 0) {
        const std::span<const FeatureEdge> edges = scene_.feature_edges();
        edges_ = EdgeIndex({edges.begin(), edges.end()}, kernel.radius);
        // A radius of the engine's own choice is no larger than lets a kernel meet a bearable number of edges.
        constexpr double bearable_crowding = 1024;
        constexpr int most_halvings = 12;
        const bool is_chosen = !(settings_.kernel.radius > 0);
        for (int halving = 0; is_chosen && edges_.crowding() > bearable_crowding && halving < most_halvings;
             ++halving) {
            throw_if_cancelled(&cancel_);
            kernel.radius /= 2;
            edges_ = EdgeIndex({edges.begin(), edges.end()}, kernel.radius);
        }
        coverage_.emplace(scene_, edges_, kernel);
    }
    first_radius_ = kernel.radius;
}

float Render::radius_of_pass(uint32_t index) const {
    return settings_.use_progressive ? shrunk_radius(*first_radius_, index) : *first_radius_;
}

PhotonMap Render::map_of(const std::vector<Photon> &photons) const {
    return PhotonMap(photons, settings_.threads, &cancel_);
}

void Render::render_into(Film &pass_film, uint32_t index) {
    PhotonMap map;
    TracedPhotons photons;
    float radius = 0;
    RenderStatistics spent;
    scene_.build(settings_.threads, &cancel_);
    if (needs_photons()) {
        // Choose the kernel before the first pass.
        if (!first_radius_) {
            const Stopwatch watch(spent.seconds_trace);
            choose_radius();
        }
        radius = radius_of_pass(index);

        // Pass 1: trace this pass's own photons; build the map of those with a bounce.
        {
            const Stopwatch watch(spent.seconds_trace);
            const PhotonTracing tracing{photon_count_ * index, photon_count_, settings_.max_bounces,
                                        hash(settings_.seed, photon_stream), settings_.threads};
            photons = trace_photons(scene_, lights_, tracing, &cancel_);
        }
        if (radius > 0) {
            const Stopwatch watch(spent.seconds_build);
            map = map_of(photons.indirect);
        }
    }

    // Pass 2: camera rays.
    {
        const Stopwatch watch(spent.seconds_gather);
        Kernel kernel = settings_.kernel;
        kernel.radius = radius;
        const PhotonGather gather{&map, &edges_, coverage_ ? &*coverage_ : nullptr, kernel};
        const CameraPass pass{scene_,
                              lights_,
                              camera_,
                              pixel_sampler_,
                              settings_.integrator == Integrator::photon_map ? &gather : nullptr,
                              settings_.max_bounces,
                              hash(settings_.seed, camera_stream),
                              index,
                              settings_.film_transparent,
                              settings_.threads};
        spent.rays = render_camera_pass(pass, pass_film, &cancel_);
    }

    // Keep the photons for those who ask, and add up what the pass took.
    const size_t photon_bytes = (photons.direct.size() + photons.indirect.size()) * sizeof(Photon);
    const size_t memory = scene_.memory_bytes() + edges_.memory_bytes() + film_.memory_bytes() +
                          pass_film.memory_bytes() + photon_bytes + map.memory_bytes() +
                          (coverage_ ? coverage_->memory_bytes() : 0);
    RenderStatistics &total = statistics_;
    total.peak_memory_bytes = std::max(total.peak_memory_bytes, memory);
    total.photons_emitted += needs_photons() ? photon_count_ : 0;
    total.photons_stored += photons.direct.size() + photons.indirect.size();
    total.rays += spent.rays + photons.rays;
    total.balance += photons.balance;
    if (film_.passes() == 0) total.radius_first = radius;
    total.radius_last = last_radius_ = radius;
    total.seconds_trace += spent.seconds_trace;
    total.seconds_build += spent.seconds_build;
    total.seconds_gather += spent.seconds_gather;
    photons_[PM_PHOTONS_DIRECT] = std::move(photons.direct);
    photons_[PM_PHOTONS_INDIRECT] = std::move(photons.indirect);
}

Vec3 Render::irradiance(const PhotonMap &map, Vec3 point, Vec3 normal) const {
    if (map.size() == 0 || !(last_radius_ > 0)) return {};
    Kernel kernel = settings_.kernel;
    kernel.radius = last_radius_;
    return estimate_irradiance(map, edges_, {point, normal, normal}, kernel).irradiance;
}

}  // namespace photon_maps
