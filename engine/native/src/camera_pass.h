// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 2: what each pixel of the camera sees in one pass.
#pragma once

#include <atomic>

#include "camera.h"
#include "error_estimate.h"
#include "film.h"
#include "gather.h"
#include "guide.h"
#include "light.h"
#include "scene.h"
#include "shadow_photons.h"

namespace photon_maps {

enum class Integrator : uint32_t { photon_map = 0, path_tracing = 1, regular_shading = 2 };

/// What brings the light of diffuse bounces to what the eye sees.
enum class Indirect : uint32_t {
    photons,   ///< the global map
    gather,    ///< a final gather: rays, which ask the global map where they end
    paths,     ///< rays that go on as in path tracing; caustics are still photons'
    all_paths  ///< rays that go on as in path tracing, and find caustics, too
};

/// The photon maps of a pass; either may be empty. The words are those of camera_path.h.
struct PhotonMaps {
    PhotonGather global;  ///< L (S|D)* D S* D; for a final gather L D too
    PhotonGather caustic;
};

struct CameraPass {
    const Scene &scene;
    const Lights &lights;
    const Camera &camera;
    const PixelSampler &pixel_sampler;
    Integrator integrator;
    const PhotonMaps *maps;               ///< null without photons
    const PhotonImportance *importance;   ///< null: rays go on by the closures alone
    const ShadowPhotons *shadow_photons;  ///< null: all shadow rays are traced
    Indirect indirect;
    bool gathers_rough;  ///< the caustic map is asked by rough reflections, too
    bool has_caustics;   ///< what rough reflections show of caustics is told from other reflections
    uint32_t max_bounces;
    uint32_t light_samples;  ///< of each source, or choices among many, at the first diffuse vertices
    uint32_t seed;
    uint32_t index;  ///< of the pass
    bool film_transparent;
    int threads;
};

/// What a camera pass traced.
struct RayCounts {
    uint64_t rays = 0;  ///< of all kinds
    uint64_t shadow_rays = 0, spared_shadow_rays = 0;
    uint64_t estimates = 0;      ///< asked of photon maps
    uint64_t light_samples = 0;  ///< at first diffuse vertices

    RayCounts &operator+=(const RayCounts &other) {
        rays += other.rays;
        shadow_rays += other.shadow_rays;
        spared_shadow_rays += other.spared_shadow_rays;
        estimates += other.estimates;
        light_samples += other.light_samples;
        return *this;
    }
};

/// Renders one sample of a pixel of the frame.
/// @param is_probe, levels as of trace_camera_path()
PixelSample render_pixel(const CameraPass &pass, uint32_t x, uint32_t y, bool is_probe, RayCounts &counts,
                         Levels *levels);

/// Renders one sample a pixel into `film`.
/// @param error null, or told the blur of its probes
/// @param left_out tiles that are not rendered
/// @throws Cancelled once `cancel` is set
RayCounts render_camera_pass(const CameraPass &pass, Film &film, ErrorEstimate *error,
                             const std::vector<bool> &left_out, const std::atomic<bool> *cancel);

}  // namespace photon_maps
