// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 2: rays from the camera to the first surface, direct light by shadow rays, indirect light from the photons
// or, for the yardstick, by going on as paths. Which light is carried by what:
//
//   path, light to eye     photon map                        path tracing
//   L E                    emission, seen by the ray         the same
//   L D E                  light sampling, and one closure   the same
//                          sample that meets an emitter
//   L D D+ E               photons with one bounce or more   the next vertices of the path
#pragma once

#include <atomic>

#include "camera.h"
#include "coverage.h"
#include "estimate.h"
#include "film.h"
#include "light.h"
#include "scene.h"

namespace photon_maps {

/// The indirect photons of a pass and how they are gathered.
struct PhotonGather {
    const PhotonMap *map;
    const EdgeIndex *edges;
    const Coverage *coverage;  ///< null where the map is empty
    Kernel kernel;
};

struct CameraPass {
    const Scene &scene;
    const Lights &lights;
    const Camera &camera;
    const PixelSampler &pixel_sampler;
    const PhotonGather *gather;  ///< null: path tracing
    uint32_t max_bounces;
    uint32_t seed;
    uint32_t index;  ///< of the pass
    bool film_transparent;
    int threads;
};

/// Renders one sample a pixel into `film`; returns the number of rays traced.
/// @throws Cancelled once `cancel` is set
uint64_t render_camera_pass(const CameraPass &pass, Film &film, const std::atomic<bool> *cancel);

/// The first surface that the camera sees through a point of its frame in pixels.
bool first_hit(const Scene &scene, const Camera &camera, Vec2 pixel, SurfacePoint &hit);

}  // namespace photon_maps
