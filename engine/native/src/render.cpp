// SPDX-License-Identifier: GPL-3.0-or-later
#include "render.h"

#include <chrono>

#include "parallel.h"
#include "radius.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t photon_stream = 0x70686f74, caustic_stream = 0x63617573, camera_stream = 0x63616d65;
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

Render::Render(Scene &scene, const Lights &lights, const Emission &emission, const Camera &camera,
               const RenderSettings &settings)
    : scene_(scene),
      lights_(lights),
      emission_(emission),
      camera_(camera),
      settings_(settings),
      pixel_sampler_(settings.pixel_filter, settings.pixel_filter_width),
      photon_count_(photon_count_for(settings, camera)),
      film_(camera.width, camera.height, settings.buffers) {}

bool Render::traces(PhotonPurpose purpose) const {
    const bool wants_photons = settings_.integrator == Integrator::photon_map && settings_.max_bounces > 0;
    if (!wants_photons || emission_.empty() || scene_.instances.empty()) return false;
    return purpose == PhotonPurpose::caustic ? settings_.use_caustics && emission_.has_casters()
                                             : settings_.use_indirect;
}

PhotonTracing Render::tracing(PhotonPurpose purpose, uint32_t index) const {
    const uint32_t stream = purpose == PhotonPurpose::caustic ? caustic_stream : photon_stream;
    return {purpose,          photon_count_ * index, photon_count_, settings_.max_bounces, hash(settings_.seed, stream),
            settings_.threads};
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

void Render::choose_radii() {
    // A radius by hand holds for both maps.
    Radii radii{settings_.kernel.radius, settings_.kernel.radius};
    const bool is_chosen = !(settings_.kernel.radius > 0);
    if (!traces(PhotonPurpose::global))
        radii.indirect = 0;
    else if (is_chosen)
        radii.indirect =
            choose_indirect_radius(scene_, emission_, camera_, tracing(PhotonPurpose::global, 0), &cancel_);
    if (!traces(PhotonPurpose::caustic))
        radii.caustic = 0;
    else if (is_chosen)
        radii.caustic = choose_caustic_radius(scene_, emission_, camera_, tracing(PhotonPurpose::caustic, 0), &cancel_);

    // A radius of the engine's own choice is no larger than lets a kernel meet a bearable number of edges.
    Kernel largest = settings_.kernel;
    largest.radius = std::max(radii.indirect, radii.caustic);
    if (largest.radius > 0) {
        const std::span<const FeatureEdge> edges = scene_.feature_edges();
        edges_ = EdgeIndex({edges.begin(), edges.end()}, largest.radius);
        constexpr double bearable_crowding = 1024;
        constexpr int most_halvings = 12;
        for (int halving = 0; is_chosen && edges_.crowding() > bearable_crowding && halving < most_halvings;
             ++halving) {
            throw_if_cancelled(&cancel_);
            largest.radius /= 2;
            edges_ = EdgeIndex({edges.begin(), edges.end()}, largest.radius);
        }
        coverage_.emplace(scene_, edges_, largest);
    }
    first_radii_ = {std::min(radii.indirect, largest.radius), std::min(radii.caustic, largest.radius)};
}

Render::Radii Render::radii_of_pass(uint32_t index) const {
    if (!settings_.use_progressive) return *first_radii_;
    return {shrunk_radius(first_radii_->indirect, index), shrunk_radius(first_radii_->caustic, index)};
}

PhotonMap Render::map_of(const std::vector<Photon> &photons) const {
    return PhotonMap(photons, settings_.threads, &cancel_);
}

TracedPhotons Render::trace(uint32_t index) {
    TracedPhotons photons;
    if (traces(PhotonPurpose::global))
        photons = trace_photons(scene_, emission_, tracing(PhotonPurpose::global, index), &cancel_);
    if (first_radii_->caustic > 0) {
        TracedPhotons aimed = trace_photons(scene_, emission_, tracing(PhotonPurpose::caustic, index), &cancel_);
        photons.photons[PM_PHOTONS_CAUSTIC] = std::move(aimed.photons[PM_PHOTONS_CAUSTIC]);
        photons.rays += aimed.rays;
    }
    return photons;
}

void Render::render_into(Film &pass_film, uint32_t index) {
    RenderStatistics spent;
    scene_.build(settings_.threads, &cancel_);

    // Choose the kernels before the first pass.
    if (!first_radii_) {
        const Stopwatch watch(spent.seconds_trace);
        choose_radii();
    }
    const Radii radii = radii_of_pass(index);

    // Pass 1: trace this pass's own photons; build the maps.
    TracedPhotons photons;
    {
        const Stopwatch watch(spent.seconds_trace);
        photons = trace(index);
    }
    PhotonMap indirect, caustic;
    {
        const Stopwatch watch(spent.seconds_build);
        if (radii.indirect > 0) indirect = map_of(photons[PM_PHOTONS_INDIRECT]);
        if (radii.caustic > 0) caustic = map_of(photons[PM_PHOTONS_CAUSTIC]);
    }

    // Pass 2: camera rays.
    {
        const Stopwatch watch(spent.seconds_gather);
        const auto gather = [&](const PhotonMap &map, float radius) -> PhotonGather {
            Kernel kernel = settings_.kernel;
            kernel.radius = radius;
            return {&map, &edges_, coverage_ ? &*coverage_ : nullptr, kernel};
        };
        const PhotonMaps maps{gather(indirect, radii.indirect), gather(caustic, radii.caustic)};
        const CameraPass pass{scene_,
                              lights_,
                              camera_,
                              pixel_sampler_,
                              settings_.integrator == Integrator::photon_map ? &maps : nullptr,
                              settings_.max_bounces,
                              hash(settings_.seed, camera_stream),
                              index,
                              settings_.film_transparent,
                              settings_.threads};
        spent.rays = render_camera_pass(pass, pass_film, &cancel_);
    }

    // Keep the photons for those who ask, and add up what the pass took.
    const size_t memory = scene_.memory_bytes() + edges_.memory_bytes() + film_.memory_bytes() +
                          pass_film.memory_bytes() + photons.size() * sizeof(Photon) + indirect.memory_bytes() +
                          caustic.memory_bytes() + (coverage_ ? coverage_->memory_bytes() : 0);
    RenderStatistics &total = statistics_;
    total.peak_memory_bytes = std::max(total.peak_memory_bytes, memory);
    total.photons_emitted += photon_count_ * (uint64_t{traces(PhotonPurpose::global)} + uint64_t{radii.caustic > 0});
    total.photons_stored += photons.size();
    total.caustic_photons += photons[PM_PHOTONS_CAUSTIC].size();
    total.rays += spent.rays + photons.rays;
    total.balance += photons.balance;
    if (film_.passes() == 0) {
        total.radius_first = radii.indirect;
        total.caustic_radius_first = radii.caustic;
    }
    total.radius_last = radii.indirect;
    total.caustic_radius_last = radii.caustic;
    total.seconds_trace += spent.seconds_trace;
    total.seconds_build += spent.seconds_build;
    total.seconds_gather += spent.seconds_gather;
    photons_ = std::move(photons.photons);
    last_radii_ = radii;
}

Vec3 Render::irradiance(const PhotonMap &map, pm_photon_kind kind, Vec3 point, Vec3 normal) const {
    Kernel kernel = settings_.kernel;
    kernel.radius = kind == PM_PHOTONS_CAUSTIC ? last_radii_.caustic : last_radii_.indirect;
    if (map.size() == 0 || !(kernel.radius > 0)) return {};
    return estimate_photons(map, edges_, {point, normal, normal}, kernel).value;
}

}  // namespace photon_maps
