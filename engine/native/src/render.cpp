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

/// Whether all that scatters or shines is the same to rays of every kind but the camera's. Photons come the way of
/// shadow rays and stay where a diffuse ray would have met their source.
bool is_seen_alike(const Scene &scene, const WorldLight &world) {
    constexpr uint32_t kinds = 1u << PM_RAY_DIFFUSE | 1u << PM_RAY_GLOSSY | 1u << PM_RAY_TRANSMISSION;
    const auto is_same = [&](const Instance &instance) {
        return (instance.visibility & kinds) == 0 || (instance.visibility & kinds) == kinds;
    };
    const auto asks = [&](uint32_t material) { return scene.materials[material].traits.depends_on_ray; };
    return std::ranges::all_of(scene.instances, is_same) && std::ranges::none_of(scene.slot_materials, asks) &&
           !world.depends_on_ray();
}

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
      is_seen_alike_(is_seen_alike(scene, lights.world_light())),
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

bool Render::traces(PhotonPurpose purpose) const {
    const bool wants_photons =
        (settings_.integrator == Integrator::photon_map || is_guided()) && settings_.max_bounces > 0;
    if (!wants_photons || emission_.empty() || scene_.instances.empty() || !receives_) return false;
    if (purpose == PhotonPurpose::caustic)
        return settings_.use_caustics && emission_.has_casters() && indirect_ != Indirect::all_paths;
    return settings_.use_indirect && indirect_ != Indirect::paths && indirect_ != Indirect::all_paths;
}

/// Whether caustics are gathered by nested radii, as far as is known.
bool Render::is_nested() const {
    if (first_radii_ && first_radii_->caustic == 0) return false;
    return settings_.is_nested && settings_.integrator == Integrator::photon_map && traces(PhotonPurpose::caustic);
}

/// Whether photons bring caustics to rough reflections. Their mean direction would tell nothing of a lobe.
bool Render::gathers_rough() const {
    return is_seen_alike_ && !settings_.mean_direction && traces(PhotonPurpose::caustic) && first_radii_->caustic > 0;
}

/// Whether photons tell camera paths where to go on diffusely.
bool Render::is_guided() const {
    const bool goes_on = settings_.integrator == Integrator::path_tracing ||
                         (settings_.integrator == Integrator::photon_map && indirect_ != Indirect::photons);
    return settings_.use_photon_guiding && goes_on;
}

bool Render::marks_shadows() const {
    return settings_.use_shadow_photons && settings_.integrator == Integrator::photon_map;
}

PhotonTracing Render::tracing(PhotonPurpose purpose, uint32_t index) const {
    const uint32_t stream = purpose == PhotonPurpose::caustic ? caustic_stream : photon_stream;
    const bool is_global = purpose == PhotonPurpose::global;
    const uint64_t count = is_global ? counts_.global : counts_.caustic;
    return {purpose,
            count * index,
            count,
            settings_.max_bounces,
            hash(settings_.seed, stream),
            settings_.threads,
            settings_.keep_photons || (is_global && indirect_ == Indirect::gather),
            is_global && marks_shadows()};
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

PhotonMap Render::map_of(const std::vector<Photon> &photons) const {
    return PhotonMap(photons, settings_.threads, &cancel_);
}

/// What a pass traces, for the maps that there are.
std::vector<PhotonTracing> Render::tracings(uint32_t index) const {
    std::vector<PhotonTracing> wanted;
    if (first_radii_->indirect > 0) {
        wanted.push_back(tracing(PhotonPurpose::global, index));
        if (indirect_ == Indirect::gather) --wanted.back().max_bounces;  // the gathering ray is a bounce more
    }
    if (first_radii_->caustic > 0) wanted.push_back(tracing(PhotonPurpose::caustic, index));
    return wanted;
}

TracedPhotons Render::trace(uint32_t index) {
    TracedPhotons photons;
    for (const PhotonTracing &wanted : tracings(index)) {
        TracedPhotons traced = trace_photons(scene_, emission_, wanted, &cancel_);
        if (wanted.purpose == PhotonPurpose::global) {
            photons = std::move(traced);
            continue;
        }
        photons.photons[PM_PHOTONS_CAUSTIC] = std::move(traced.photons[PM_PHOTONS_CAUSTIC]);
        photons.rays += traced.rays;
        photons.caustic_rays = traced.rays;
    }
    return photons;
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

/// Builds what pass 2 asks of the photons, whose lists end here unless they are kept.
Maps Render::build_maps(TracedPhotons &photons, const Radii &radii, bool keeps_lists) const {
    Maps maps;
    if (is_guided() && radii.indirect > 0) maps.importance = importance_of(photons);
    if (marks_shadows() && radii.indirect > 0) maps.shadow_photons.emplace(photons.shadow_photons, radii.indirect / 2);
    const size_t beside = (maps.importance ? maps.importance->memory_bytes() : 0) +
                          (maps.shadow_photons ? maps.shadow_photons->memory_bytes() : 0) +
                          photons.shadow_photons.size() * sizeof(ShadowPhoton);
    photons.shadow_photons = {};
    const auto count_memory = [&](size_t listed) {
        maps.memory_bytes = std::max(maps.memory_bytes, beside + listed * sizeof(Photon) + maps.global.memory_bytes() +
                                                            maps.caustic.memory_bytes());
    };
    count_memory(photons.size());
    const auto build = [&](PhotonMap &map, pm_photon_kind kind, const std::vector<Photon> &list) {
        map = map_of(list);
        count_memory(photons.size());
        if (!keeps_lists) photons.photons[kind] = {};  // the map has copies
    };
    if (settings_.integrator != Integrator::photon_map) return maps;
    if (radii.indirect > 0 && indirect_ == Indirect::gather) {
        // Where the rays of a final gather end, photons bring the lights' own light too.
        std::vector<Photon> all = photons[PM_PHOTONS_DIRECT];
        all.insert(all.end(), photons[PM_PHOTONS_INDIRECT].begin(), photons[PM_PHOTONS_INDIRECT].end());
        count_memory(photons.size() + all.size());
        build(maps.global, PM_PHOTONS_INDIRECT, all);
    } else if (radii.indirect > 0) {
        build(maps.global, PM_PHOTONS_INDIRECT, photons[PM_PHOTONS_INDIRECT]);
    }
    if (radii.caustic > 0) build(maps.caustic, PM_PHOTONS_CAUSTIC, photons[PM_PHOTONS_CAUSTIC]);
    return maps;
}

/// What paths do not find by light sampling nor in a map: in path tracing caustics too.
PhotonImportance Render::importance_of(const TracedPhotons &photons) const {
    // Photons that only tell where to go are not summed: their cubes need not shrink.
    PhotonImportance importance(2 * first_radii_->indirect);
    importance.add(photons[PM_PHOTONS_INDIRECT]);
    if (settings_.integrator == Integrator::path_tracing) importance.add(photons[PM_PHOTONS_CAUSTIC]);
    return importance;
}

PhotonMaps Render::gathers_of(const Maps &maps, const Radii &radii) const {
    const auto gather = [&](const PhotonMap &map, float radius) -> PhotonGather {
        Kernel kernel = settings_.kernel;
        kernel.radius = radius;
        return {&map, edges_.get(), coverage_.get(), kernel, settings_.nearest_count, settings_.mean_direction};
    };
    return {gather(maps.global, radii.indirect), gather(maps.caustic, radii.caustic)};
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
