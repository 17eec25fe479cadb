// SPDX-License-Identifier: GPL-3.0-or-later
// A path from the camera as it grows, step by step.
#pragma once

#include <optional>

#include "camera_path.h"
#include "mis.h"
#include "path_word.h"
#include "ray_state.h"

namespace photon_maps {

/// What the eye sees directly, in mirrors or through glass asks every source while they are few: choosing among them
/// costs more in noise than the rays saved are worth.
constexpr size_t few_sources = 8;

/// The steps of one path. Those that ask the lights are in path_lights.cpp, the others in camera_path.cpp.
class CameraPath {
  public:
    CameraPath(const CameraPass &pass, const Ray &ray, bool is_probe, const Sequence &sequence, RayCounts &counts,
               Levels *levels, PixelSample &sample)
        : pass_(pass),
          is_probe_(is_probe),
          sequence_(sequence),
          counts_(counts),
          levels_(levels),
          sample_(sample),
          ray_(ray) {
        state_.kinds = ray_.kinds = 1u << PM_RAY_CAMERA;
    }

    /// Adds to the sample what the path brings.
    void follow() {
        while (step()) {
        }
    }

  private:
    /// Where the current ray was drawn: what light sampling would have done there instead.
    struct Origin {
        float pdf = 0;  ///< of the ray; 0: only this ray could bring that light
        Vec3 position, normal;
        bool both_sides = false, asked_all = false;
    };

    bool step();
    void add_lamps(const SurfacePoint *hit);
    void add_world();
    void describe(const SurfacePoint &hit, const Shading &shading, float depth);
    void sample_lights(const SurfacePoint &hit, const Shading &shading);
    void sample_source(const SurfacePoint &hit, const Shading &shading, const LightChoice::Choice &choice,
                       const std::array<float, 4> &u, float share);
    Vec3 transmittance(const Ray &shadow, const SurfacePoint &hit, size_t source);
    RayState receiver(const Shading &shading) const;
    float other_pdf(const Shading &shading, Part part, bool transmits, size_t source, Vec3 direction) const;
    void meet_emitters(const SurfacePoint &hit, const Shading &shading);
    void gather(const SurfacePoint &hit, const Shading &shading);
    void gather_all(const SurfacePoint &hit, const Shading &shading);
    void add_photons(const PhotonGather &map, const SurfacePoint &hit, const Shading &shading, Lobes lobes, Part last);
    void add_caustic_levels(const SurfacePoint &hit, const Shading &shading, Lobes lobes);
    void plan(const SurfacePoint &hit, const Shading &shading);
    std::optional<ScatterSample> draw(const SurfacePoint &hit, const Shading &shading, Lobes lobes,
                                      const std::array<float, 3> &u) const;
    bool go_on(const SurfacePoint &hit, const Shading &shading);
    bool pass_straight(const SurfacePoint &hit, const Shading &shading, float u);
    bool scatter(const SurfacePoint &hit, const Shading &shading, Part part, Lobes lobes,
                 const std::array<float, 4> &u);
    bool survives(Vec3 weight, float u);
    Transport transport(const SurfacePoint &hit) const {
        const bool began_inside = hit.is_backfacing && bodies_ == 0;
        return pass_.scene.mesh_of(hit).is_closed && !began_inside ? Transport::radiance : Transport::flux;
    }

    /// Whether photons carry the light that arrives by a word: at a surface met before they were asked for what came
    /// there by glossy scatterings.
    bool is_gathered(const Word &word) const {
        if (word.diffuse == 0) return pass_.gathers_rough && word.is_focused;
        return pass_.maps && word.ends_glossy;
    }
    /// Whether a final gather ends here, where the eye sees no detail: all light is asked of the photons. A ray shorter
    /// than their radius goes on, for it would show how they are blurred (Jensen 1996, section 5).
    bool ends_final_gather() const {
        return pass_.maps && pass_.indirect == Indirect::gather && word_.diffuse > 0 &&
               (word_.ends_glossy || state_.length >= pass_.maps->global.kernel.radius);
    }
    bool goes_on_diffusely() const {
        if (pass_.integrator != Integrator::photon_map) return pass_.integrator == Integrator::path_tracing;
        return pass_.indirect != Indirect::photons && !ends_final_gather();
    }
    /// Whether a ray of its own looks for emissive surfaces, since none goes on diffusely to meet them.
    bool asks_emitters() const { return pass_.maps && pass_.indirect == Indirect::photons; }
    bool asks_every_source() const { return word_.diffuse == 0 && pass_.lights.source_count() <= few_sources; }
    /// Weight of light that the current ray meets, against light sampling at its origin.
    float weight(size_t source, float light_pdf) const {
        if (origin_.pdf == 0) return 1;
        const float choice = origin_.asked_all ? 1 : pass_.lights.choice_probability(source, origin_.position);
        return power_heuristic(origin_.pdf, choice * light_pdf);
    }

    const CameraPass &pass_;
    bool is_probe_;
    Sequence sequence_;
    RayCounts &counts_;
    Levels *levels_;  ///< of the caustic map; null: it is asked by one radius
    PixelSample &sample_;
    Ray ray_;
    RayState state_;
    Vec3 throughput_{1, 1, 1};
    Word word_;
    uint32_t bodies_ = 0;  ///< that the path entered and has not left
    Origin origin_;
    bool is_described_ = false;
    float first_depth_ = 0;  ///< of the transparent surfaces passed so far, along the camera's ray
    /// Probabilities of the ways to go on from the present vertex, and where to if diffusely.
    float go_straight_ = 0;
    std::array<float, 3> go_on_{};  ///< by Part
    std::array<Lobes, 3> parts_{};  ///< parts_of() the surface there
    bool splits_ = false;           ///< there: what goes on by glossy lobes goes on by reflection and by refraction
    std::optional<Guide> guide_;
};

}  // namespace photon_maps
