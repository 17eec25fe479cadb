// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 2: what each pixel of the camera sees in one pass.
#pragma once

#include <atomic>

#include "camera.h"
#include "film.h"
#include "gather.h"
#include "light.h"
#include "scene.h"

namespace photon_maps {

/// The photon maps of a pass; either may be empty.
struct PhotonMaps {
    PhotonGather indirect, caustic;
};

struct CameraPass {
    const Scene &scene;
    const Lights &lights;
    const Camera &camera;
    const PixelSampler &pixel_sampler;
    const PhotonMaps *maps;  ///< null: path tracing
    uint32_t max_bounces;
    uint32_t seed;
    uint32_t index;  ///< of the pass
    bool film_transparent;
    int threads;
};

/// Renders one sample a pixel into `film`; returns the number of rays traced.
/// @throws Cancelled once `cancel` is set
uint64_t render_camera_pass(const CameraPass &pass, Film &film, const std::atomic<bool> *cancel);

}  // namespace photon_maps
