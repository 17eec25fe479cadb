// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 1: photons leave the lights, bounce between diffuse surfaces, and are recorded at every hit.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "light.h"
#include "photon.h"
#include "scene.h"

namespace photon_maps {

using Flux = std::array<double, 3>;  ///< W, RGB, in sums

/// Where the emitted flux went: emitted = absorbed + escaped + cut, up to the noise of Russian roulette.
struct FluxBalance {
    Flux emitted{}, absorbed{}, escaped{};
    Flux cut{};  ///< carried by photons that reached the last bounce

    FluxBalance &operator+=(const FluxBalance &other);
};

/// The photons of one pass, in the order of their emission.
struct TracedPhotons {
    std::vector<Photon> direct;    ///< at their first hit
    std::vector<Photon> indirect;  ///< after one bounce or more
    FluxBalance balance;
    uint64_t rays = 0;
};

struct PhotonTracing {
    uint64_t first;        ///< global number of the first photon
    uint64_t count;        ///< photons emitted; flux is divided by it
    uint32_t max_bounces;  ///< a photon that has bounced so often is recorded once more and ends
    uint32_t seed;
    int threads;
};

/// Traces photons; the result does not depend on the number of threads.
/// @throws Cancelled once `cancel` is set
TracedPhotons trace_photons(const Scene &scene, const Lights &lights, const PhotonTracing &tracing,
                            const std::atomic<bool> *cancel);

}  // namespace photon_maps
