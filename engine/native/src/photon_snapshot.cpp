// SPDX-License-Identifier: GPL-3.0-or-later
#include "photon_snapshot.h"

#include "ray_state.h"

namespace photon_maps {

void PhotonSnapshot::add(const PhotonTracing &tracing, TracedPhotons &traced) {
    tracings.push_back(tracing);
    received[static_cast<size_t>(tracing.purpose)] = std::move(traced.received);
    const bool is_caustic = tracing.purpose == PhotonPurpose::caustic;
    for (size_t kind = 0; kind < traced.origins.size(); ++kind)
        if (is_caustic == (kind == PM_PHOTONS_CAUSTIC)) origins[kind] = std::move(traced.origins[kind]);
    for (size_t i = 0; i < traced.shadow_photons.size(); ++i) {
        if (traced.shadow_photons[i].is_lit) continue;
        photons[PM_PHOTONS_SHADOW].push_back({traced.shadow_photons[i].position, {}, 0, 0});
        origins[PM_PHOTONS_SHADOW].push_back(traced.shadow_origins[i]);
    }
}

std::optional<Probe> probe(const Scene &scene, const PhotonSnapshot &snapshot, Ray ray) {
    constexpr float mostly = 0.5f;
    RayState state;
    state.kinds = ray.kinds;
    SurfacePoint hit;
    while (scene.intersect(ray, hit)) {
        const Shading shading = shade(scene, hit, -ray.direction, state);
        if (average(shading.transparency) > mostly && state.transparent_depth < max_transparent_depth) {
            ray.origin = hit.origin_towards(ray.direction);
            state = passed(state);
            continue;
        }
        const bool keeps_photons = (lobes_of(shading) & diffuse_lobes) != 0;
        if (!keeps_photons) return Probe{hit, false, {}, {}};
        return Probe{hit, true, probe_irradiance(snapshot.gathers.global, hit),
                     probe_irradiance(snapshot.gathers.caustic, hit)};
    }
    return {};
}

std::vector<PhotonSegment> trace_segments(const Scene &scene, const Emission &emission, const PhotonSnapshot &snapshot,
                                          PhotonPurpose purpose, std::span<const uint32_t> numbers) {
    TracedPhotons traced;
    for (PhotonTracing tracing : snapshot.tracings) {
        if (tracing.purpose != purpose) continue;
        tracing.records_origins = tracing.leaves_shadow_photons = false;
        tracing.records_segments = true;
        for (const uint32_t number : numbers) trace_photon(scene, emission, tracing, number, traced);
    }
    return std::move(traced.segments);
}

}  // namespace photon_maps
