// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 1: photons leave the lights, scatter, and are recorded where they hit diffuse surfaces.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <utility>
#include <vector>

#include "emission.h"
#include "light.h"
#include "photon.h"
#include "photon_maps.h"
#include "scene.h"
#include "shadow_photons.h"

namespace photon_maps {

using Flux = std::array<double, 3>;  ///< W, RGB, in sums

/// Where the emitted flux went: emitted = absorbed + escaped + cut, up to the noise of Russian roulette.
struct FluxBalance {
    Flux emitted{}, absorbed{}, escaped{};
    Flux cut{};  ///< carried by photons that reached the last bounce

    FluxBalance &operator+=(const FluxBalance &other);
};

/// What of a light's photons met an instance, whether or not it keeps photons.
struct Received {
    uint64_t arrived = 0, stored = 0;
    Flux flux{};  ///< of those that arrived

    Received &operator+=(const Received &other);
};
using ReceivedBySource = std::map<std::pair<uint32_t, uint32_t>, Received>;  ///< by instance and source

/// The photons of one pass, by pm_photon_kind, in the order of their emission.
struct TracedPhotons {
    std::array<std::vector<Photon>, 3> photons;
    std::array<std::vector<PhotonOrigin>, 3> origins;  ///< of the photons, if they are asked for; as are the next two
    std::vector<PhotonOrigin> shadow_origins;
    ReceivedBySource received;
    std::vector<PhotonSegment> segments;  ///< if they are asked for
    std::vector<ShadowPhoton> shadow_photons;
    FluxBalance balance;  ///< of the photons that are not aimed
    uint64_t rays = 0;
    uint64_t caustic_rays = 0;  ///< of those, of the photons that are aimed

    const std::vector<Photon> &operator[](pm_photon_kind kind) const { return photons[kind]; }
    size_t size() const { return photons[0].size() + photons[1].size() + photons[2].size(); }
};

/// What photons are traced for. The words are those of camera_path.h: every diffuse hit is recorded once, by the map
/// that its word belongs to.
enum class PhotonPurpose {
    global,  ///< L D and L (S|D)* D S* D: from all lights in proportion to their power
    caustic  ///< L S+ D: aimed at what can focus light; a photon ends at its first diffuse scattering
};

struct PhotonTracing {
    PhotonPurpose purpose;
    uint64_t first;        ///< global number of the first photon
    uint64_t count;        ///< photons emitted; flux is divided by it
    uint32_t max_bounces;  ///< a photon that has bounced so often is recorded once more and ends
    uint32_t seed;
    int threads;
    bool records_direct = false;  ///< L D as well, which only a final gather needs: lights are sampled elsewhere
    bool leaves_shadow_photons = false;
    bool records_origins = false, records_segments = false;
};

/// Traces one photon and adds what it leaves.
/// @param number of the photon in its pass, below tracing.count
void trace_photon(const Scene &scene, const Emission &emission, const PhotonTracing &tracing, uint64_t number,
                  TracedPhotons &traced);

/// Traces photons; the result does not depend on the number of threads.
/// @throws Cancelled once `cancel` is set
TracedPhotons trace_photons(const Scene &scene, const Emission &emission, const PhotonTracing &tracing,
                            const std::atomic<bool> *cancel);

}  // namespace photon_maps
