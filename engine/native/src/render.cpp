// SPDX-License-Identifier: GPL-3.0-or-later
#include "render.h"

#include <chrono>

#include "parallel.h"
#include "radius.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t camera_stream = 0x63616d65;
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
PhotonCounts photon_counts_for(const RenderSettings &settings, const Camera &camera) {
    const uint64_t pixels = uint64_t{camera.frame_width} * camera.frame_height;
    const uint64_t count =
        settings.photon_count != 0 ? settings.photon_count : std::clamp(pixels, min_photon_count, max_photon_count);
    return {count, count};
}

}  // namespace

Render::Render(Scene &scene, const Lights &lights, const Emission &emission, const Camera &camera,
               const RenderSettings &settings)
    : scene_(scene),
      lights_(lights),
      emission_(emission),
      camera_(camera),
      view_(camera),
      settings_(settings),
      pixel_sampler_(settings.pixel_filter, settings.pixel_filter_width),
      receives_(std::ranges::any_of(
          scene.slot_materials, [&](uint32_t m) { return (scene.materials[m].traits.lobes & diffuse_lobes) != 0; })),
      indirect_(settings.use_final_gather ? Indirect::gather : Indirect::photons),
      light_samples_(std::max(1u, settings.light_samples)),
      counts_(photon_counts_for(settings, camera)),
      film_(camera.width, camera.height, settings.buffers, is_nested()),
      left_out_(film_.tiles().count()) {
    if (film_.has(Buffer::error)) error_.emplace(camera.width, camera.height);
}

void Render::set_camera(const Camera &camera) {
    view_ = camera;
    film_ = Film(camera.width, camera.height, settings_.buffers, is_nested());
    if (error_) error_.emplace(camera.width, camera.height);
    left_out_.assign(film_.tiles().count(), false);
    statistics_ = {};
}

void Render::render_pass(uint32_t index) {
    RenderStatistics spent;
    std::optional<Film> pass_film;
    try {
        prepare(spent);
        pass_film.emplace(view_.width, view_.height, settings_.buffers, is_nested());
        render_into(*pass_film, index, spent);
    } catch (const Cancelled &) {
        cancel_ = false;
        throw;
    }
    film_.add(*pass_film, left_out_);
    if (error_) error_->add(film_, *pass_film, left_out_);
    leave_out_what_is_done();
}

/// Tiles whose noise is far below what the whole picture may have add little to it, and cost as much as others. Light
/// that seldom comes, such as a small caustic, may not have come to a tile yet: those around it must be as quiet.
void Render::leave_out_what_is_done() {
    constexpr uint32_t least_passes = 16;             // fewer do not know their own variance
    constexpr float done = 0.5f, too_blurred = 0.8f;  // of the target
    // Further passes are what takes blur away.
    if (!error_ || film_.passes() < least_passes || error_->blur() > too_blurred * settings_.stop_error) return;
    const uint32_t columns = film_.tiles().columns(), rows = film_.tiles().rows();
    const auto is_quiet = [&](uint32_t x, uint32_t y) {
        return error_->tile_noise(size_t{y} * columns + x) < done * settings_.stop_error;
    };
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            bool is_done = true;
            for (uint32_t v = std::max(y, 1u) - 1; v < std::min(y + 2, rows); ++v)
                for (uint32_t u = std::max(x, 1u) - 1; u < std::min(x + 2, columns); ++u) is_done &= is_quiet(u, v);
            if (is_done) left_out_[size_t{y} * columns + x] = true;
        }
}

Render::Radii Render::radii_of_pass(uint32_t index) const {
    if (!settings_.use_progressive) return *first_radii_;
    return {shrunk_radius(first_radii_->indirect, index), shrunk_radius(first_radii_->caustic, index)};
}

std::shared_ptr<const TracedPass> Render::trace_pass(uint32_t index, const Radii &radii, RenderStatistics &spent) {
    auto pass = std::make_shared<TracedPass>();
    {
        const Stopwatch watch(spent.seconds_trace);
        pass->photons = trace(index);
    }
    pass->photons_stored = pass->photons.size();
    pass->caustic_photons = pass->photons[PM_PHOTONS_CAUSTIC].size();
    const Stopwatch watch(spent.seconds_build);
    pass->maps = build_maps(pass->photons, radii, settings_.keep_photons);
    if (!settings_.keep_photons) pass->photons.photons = {};
    return pass;
}

CameraPass Render::camera_pass(const Camera &camera, const Maps &maps, const PhotonMaps &gathers, Indirect indirect,
                               uint32_t index) const {
    const bool has_maps = settings_.integrator == Integrator::photon_map && indirect != Indirect::all_paths;
    return {scene_,
            lights_,
            camera,
            pixel_sampler_,
            settings_.integrator,
            has_maps ? &gathers : nullptr,
            maps.importance ? &*maps.importance : nullptr,
            maps.shadow_photons ? &*maps.shadow_photons : nullptr,
            indirect,
            has_maps && gathers_rough(),
            settings_.integrator == Integrator::path_tracing ||
                (settings_.integrator == Integrator::photon_map && settings_.use_caustics),
            settings_.max_bounces,
            light_samples_,
            hash(settings_.seed, camera_stream),
            index,
            settings_.film_transparent,
            settings_.threads};
}

/// Builds what rays are traced through, and chooses kernels and photons before the first pass.
void Render::prepare(RenderStatistics &spent) {
    scene_.build(settings_.threads, &cancel_);
    if (first_radii_) return;
    const Stopwatch watch(spent.seconds_trace);
    const PhotonCounts counts = counts_;
    const Indirect indirect = indirect_;
    const uint32_t light_samples = light_samples_;
    try {
        limit_counts();
        choose_radii();
        make_plan();
        limit_counts();
    } catch (...) {  // a render that goes on after a cancel begins here again
        counts_ = counts;
        indirect_ = indirect;
        light_samples_ = light_samples;
        is_limited_ = false;
        first_radii_.reset();
        throw;
    }
    kernel_bounds_ = {};
    if (film_.nested() && !is_nested()) film_ = Film(view_.width, view_.height, settings_.buffers, is_nested());
}

void Render::render_into(Film &pass_film, uint32_t index, RenderStatistics &spent) {
    const Radii radii = radii_of_pass(index);

    // Pass 1: this pass's own photons and their maps, unless another picture had them.
    std::shared_ptr<const TracedPass> pass = map_cache_.find(index);
    size_t maps_memory = map_cache_.memory_bytes();
    if (!pass) {
        pass = trace_pass(index, radii, spent);
        maps_memory += pass->maps.memory_bytes;
        map_cache_.keep(index, pass);
    }
    const Maps &maps = pass->maps;

    // Pass 2: camera rays.
    {
        const Stopwatch watch(spent.seconds_gather);
        const PhotonMaps gathers = gathers_of(maps, radii);
        const CameraPass rays = camera_pass(view_, maps, gathers, indirect_, index);
        spent.rays = render_camera_pass(rays, pass_film, error_ ? &*error_ : nullptr, left_out_, &cancel_);
    }

    // Keep the photons for those who ask, and add up what the pass took.
    const size_t memory = scene_.memory_bytes() + edges_->memory_bytes() + film_.memory_bytes() +
                          pass_film.memory_bytes() + maps_memory + (coverage_ ? coverage_->memory_bytes() : 0) +
                          (error_ ? error_->memory_bytes() : 0);
    RenderStatistics &total = statistics_;
    total.peak_memory_bytes = std::max(total.peak_memory_bytes, memory);
    total.photons_emitted += (radii.indirect > 0 ? counts_.global : 0) + (radii.caustic > 0 ? counts_.caustic : 0);
    total.photons_stored += pass->photons_stored;
    total.photons_stored_last = pass->photons_stored;
    total.caustic_photons += pass->caustic_photons;
    total.rays += spent.rays;
    total.rays.rays += pass->photons.rays;
    total.balance += pass->photons.balance;
    if (film_.passes() == 0) {
        total.radius_first = radii.indirect;
        total.caustic_radius_first = radii.caustic;
    }
    total.radius_last = radii.indirect;
    total.caustic_radius_last = radii.caustic;
    total.seconds_trace += spent.seconds_trace;
    total.seconds_build += spent.seconds_build;
    total.seconds_gather += spent.seconds_gather;
    if (settings_.keep_photons) last_pass_ = pass;
    last_radii_ = radii;
}

}  // namespace photon_maps
