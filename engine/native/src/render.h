// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of passes: photons, maps, camera rays; and what they cost.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>

#include "camera.h"
#include "camera_pass.h"
#include "film.h"
#include "map_cache.h"
#include "photon_snapshot.h"
#include "photon_trace.h"
#include "pilot_pixels.h"

namespace photon_maps {

struct RenderSettings {
    Integrator integrator;
    uint64_t photon_count;   ///< per pass and map; 0: planned, or as many as the frame has pixels, within bounds
    Kernel kernel;           ///< of the first pass; radius 0: chosen from pilot photons, for each map its own
    uint32_t nearest_count;  ///< of the photons around a point, within the kernel's radius; 0: all within it
    bool is_nested;          ///< caustics by nested radii, of which the film chooses
    bool mean_direction;     ///< surfaces that are not Lambertian scatter photons by their mean direction
    uint32_t max_bounces;
    bool use_caustics, use_indirect, use_final_gather, use_shadow_photons, use_photon_guiding;
    uint32_t seed;
    bool use_progressive;
    PixelFilter pixel_filter;
    float pixel_filter_width;
    bool film_transparent;
    int threads;
    uint32_t buffers;  ///< bit 1 << Buffer
    bool keep_photons;
    bool use_auto;           ///< counts and radii that are 0 follow from pilot passes
    uint32_t light_samples;  ///< as of CameraPass; 0: planned, or 1
    float stop_error;        ///< tiles far below it are left out of further passes; 0: none is
    size_t memory_limit;     ///< bytes that scene, picture and photons may take
};

struct RenderStatistics {
    uint64_t photons_emitted = 0, photons_stored = 0, caustic_photons = 0;
    uint64_t photons_stored_last = 0;  ///< of the latest pass
    RayCounts rays;
    size_t peak_memory_bytes = 0;
    float radius_first = 0, radius_last = 0;
    float caustic_radius_first = 0, caustic_radius_last = 0;
    FluxBalance balance;  ///< sum over the passes
    double seconds_trace = 0, seconds_build = 0, seconds_gather = 0;
};

/// One picture of a frozen scene, which must outlive it. The first pass builds the scene.
class Render {
  public:
    Render(Scene &scene, const Lights &lights, const Emission &emission, const Camera &camera,
           const RenderSettings &settings);

    /// Begins another picture, seen by another camera: counts and radii stay those chosen for the first one.
    void set_camera(const Camera &camera);
    /// Keeps pass 1 of the earliest passes in so many bytes, for other pictures, but in no more than a quarter of the
    /// memory limit; at first none.
    void keep_maps(size_t bytes) { map_cache_.set_limit(std::min(bytes, settings_.memory_limit / 4)); }

    /// Renders a pass, a function of scene, camera, settings and index alone, and adds it to the film.
    /// @throws Cancelled after cancel(); the film then holds the passes finished before
    void render_pass(uint32_t index);

    /// Traces the photons of a pass again, with what they came from; has_begun() must hold.
    /// @throws Cancelled after cancel()
    std::unique_ptr<const PhotonSnapshot> snapshot(uint32_t index);

    /// Makes the running pass, or the next one if none is running, throw Cancelled.
    void cancel() { cancel_ = true; }

    const Film &film() const { return film_; }
    /// Null unless the error buffer is wanted.
    const ErrorEstimate *error() const { return error_ ? &*error_ : nullptr; }
    /// Share of the picture's tiles that get no more samples.
    float done() const {
        return static_cast<float>(std::ranges::count(left_out_, true)) / static_cast<float>(left_out_.size());
    }
    const RenderStatistics &statistics() const { return statistics_; }
    /// Whether photon counts and radii are chosen.
    bool has_begun() const { return first_radii_.has_value(); }
    bool keeps_photons() const { return settings_.keep_photons; }
    PhotonCounts photon_counts() const { return counts_; }
    Indirect indirect() const { return indirect_; }
    uint32_t light_samples() const { return light_samples_; }
    /// Whether passes emit fewer photons than was asked for or planned, for more would not fit into memory.
    bool is_limited() const { return is_limited_; }
    /// What the plan was made from; zero before the first pass or without a plan.
    const PilotNoise &pilot_noise() const { return pilot_noise_; }

    /// Photons of the last finished pass, if they are kept.
    const std::vector<Photon> &photons(pm_photon_kind kind) const {
        static const std::vector<Photon> none;
        return last_pass_ ? last_pass_->photons[kind] : none;
    }
    /// Irradiance at a point from photons like those of a kind, by that kind's radius.
    Vec3 irradiance(const PhotonMap &map, pm_photon_kind kind, Vec3 point, Vec3 normal) const;
    PhotonMap map_of(std::vector<Photon> photons) const;

  private:
    /// Kernel radii of a pass; 0 where there is no such map.
    struct Radii {
        float indirect = 0, caustic = 0;

        bool operator==(const Radii &) const = default;
    };

    bool traces(PhotonPurpose purpose) const;
    bool is_nested() const;
    bool is_guided() const;
    bool gathers_rough() const;
    bool marks_shadows() const;
    PhotonTracing tracing(PhotonPurpose purpose, uint32_t index) const;
    std::vector<PhotonTracing> tracings(uint32_t index) const;
    bool is_planned() const;
    void limit_counts();
    void choose_radii();
    void set_radii(Radii radii);
    void make_plan();
    /// A way to bring the light of diffuse bounces, the plan for it, and what tracing the pilot passes' photons cost.
    struct Choice {
        Pilot pilot;
        Plan plan;
        double pilot_cost;             ///< in rays
        std::vector<Indirect> rivals;  ///< ways that are not hopeless beside it, the usual one first
    };
    std::optional<Choice> choose_by_pilots(uint32_t first, std::span<const Indirect> ways, const PhotonCounts &usual);
    std::vector<Indirect> ways() const;
    std::vector<Pilot> run_pilot_passes(uint32_t first, std::span<const Indirect> ways);
    CameraPass camera_pass(const Camera &camera, const Maps &maps, const PhotonMaps &gathers, Indirect indirect,
                           uint32_t index) const;
    Radii radii_of_pass(uint32_t index) const;
    TracedPhotons trace(uint32_t index);
    std::shared_ptr<const TracedPass> trace_pass(uint32_t index, const Radii &radii, RenderStatistics &spent);
    Maps build_maps(TracedPhotons &photons, const Radii &radii, bool keeps_lists) const;
    PhotonImportance importance_of(const TracedPhotons &photons) const;
    PhotonMaps gathers_of(const Maps &maps, const Radii &radii) const;
    void prepare(RenderStatistics &spent);
    void render_into(Film &pass_film, uint32_t index, RenderStatistics &spent);
    void leave_out_what_is_done();

    Scene &scene_;
    const Lights &lights_;
    const Emission &emission_;
    Camera camera_;  ///< that counts and radii are chosen for
    Camera view_;    ///< of the picture
    RenderSettings settings_;
    PixelSampler pixel_sampler_;
    bool receives_;  ///< whether any surface may scatter light diffusely, so that photons are of use
    Indirect indirect_;
    uint32_t light_samples_;
    PhotonCounts counts_;
    bool is_limited_ = false;
    PilotNoise pilot_noise_;
    std::vector<FeatureEdge> kernel_bounds_;  ///< of the scene, while radii are chosen
    std::optional<Radii> first_radii_;        ///< of pass 0, once chosen
    std::shared_ptr<const EdgeIndex> edges_ = std::make_shared<EdgeIndex>();
    std::shared_ptr<const Coverage> coverage_;  ///< made along with the first radii, if there is a map
    Film film_;
    std::optional<ErrorEstimate> error_;
    std::vector<bool> left_out_;  ///< tiles that get no more samples
    RenderStatistics statistics_;
    MapCache map_cache_;
    std::shared_ptr<const TracedPass> last_pass_;  ///< if its photons are kept
    Radii last_radii_;
    std::atomic<bool> cancel_ = false;
};

}  // namespace photon_maps
