// SPDX-License-Identifier: GPL-3.0-or-later
#include "photon_trace.h"

#include "parallel.h"
#include "sampling.h"

namespace photon_maps {

namespace {

constexpr uint64_t chunk_size = 1024;

void add(Flux &sum, Vec3 flux) {
    sum[0] += static_cast<double>(flux.x);
    sum[1] += static_cast<double>(flux.y);
    sum[2] += static_cast<double>(flux.z);
}

Photon record(const SurfacePoint &hit, Vec3 direction, Vec3 flux, uint32_t bounce) {
    return {hit.position, flux, pack_normal(hit.normal, std::min(bounce, 255u)), pack_direction(direction)};
}

/// Leaves the surface by the cosine about the shading normal; nothing where that leads into the surface.
/// `flux` becomes that of the scattered photon, before roulette.
std::optional<Vec3> scatter(const Scene &scene, const SurfacePoint &hit, Vec3 arriving, const std::array<float, 4> &u,
                            Vec3 &flux) {
    const Vec3 direction = Frame(hit.shading_normal).to_world(sample_cosine_hemisphere(u[0], u[1]));
    flux *= albedo(shade(scene, hit, -arriving, {}), all_lobes);
    if (hit.shading_normal == hit.normal) return direction;
    const float leaving = dot(direction, hit.normal);
    const float ratio = shading_ratio(-dot(arriving, hit.shading_normal), -dot(arriving, hit.normal)) *
                        shading_ratio(leaving, dot(direction, hit.shading_normal));
    flux = flux * ratio;
    if (leaving <= 0) return {};
    return direction;
}

/// Follows one photon to its end.
void trace_photon(const Scene &scene, const PhotonEmission &emission, Sequence &sequence, float count,
                  uint32_t max_bounces, TracedPhotons &traced) {
    Ray ray = emission.ray;
    Vec3 flux = emission.flux / count;
    for (uint32_t bounce = 0;; ++bounce) {
        SurfacePoint hit;
        ++traced.rays;
        const bool met = scene.intersect(ray, hit);
        if (bounce == 0) {
            if (met && emission.falloff_radius_squared > 0) {
                const float squared = length_squared(hit.position - emission.falloff_center);
                flux = flux * (squared / (squared + emission.falloff_radius_squared));
            }
            add(traced.balance.emitted, flux);
        }
        if (!met) {
            add(traced.balance.escaped, flux);
            return;
        }

        // Record the photon as it arrives.
        (bounce == 0 ? traced.direct : traced.indirect).push_back(record(hit, ray.direction, flux, bounce));

        // Scatter it.
        const auto u = sequence.next();
        Vec3 scattered = flux;
        const std::optional<Vec3> direction = scatter(scene, hit, ray.direction, u, scattered);
        if (!direction) scattered = Vec3();
        add(traced.balance.absorbed, flux - scattered);
        if (bounce == max_bounces) {
            add(traced.balance.cut, scattered);
            return;
        }

        // Russian roulette by the ratio of the throughputs: surviving photons keep about the same flux.
        const float survival = std::min(1.0f, max_component(scattered) / max_component(flux));
        if (!(u[2] < survival)) return;
        flux = scattered / survival;
        ray = {hit.origin_above(), *direction};
    }
}

}  // namespace

FluxBalance &FluxBalance::operator+=(const FluxBalance &other) {
    for (size_t c = 0; c < 3; ++c) {
        emitted[c] += other.emitted[c];
        absorbed[c] += other.absorbed[c];
        escaped[c] += other.escaped[c];
        cut[c] += other.cut[c];
    }
    return *this;
}

TracedPhotons trace_photons(const Scene &scene, const Lights &lights, const PhotonTracing &tracing,
                            const std::atomic<bool> *cancel) {
    // Trace chunks of photons, each into its own lists.
    const uint64_t chunk_count = (tracing.count + chunk_size - 1) / chunk_size;
    std::vector<TracedPhotons> chunks(chunk_count);
    parallel_for(tracing.threads, chunk_count, cancel, [&](size_t c) {
        const uint64_t begin = c * chunk_size, end = std::min(begin + chunk_size, tracing.count);
        for (uint64_t i = begin; i < end; ++i) {
            throw_if_cancelled(cancel);
            Sequence sequence(tracing.first + i, tracing.seed);
            const std::optional<PhotonEmission> emission = lights.emit(sequence);
            if (!emission || !(max_component(emission->flux) > 0)) continue;
            trace_photon(scene, *emission, sequence, static_cast<float>(tracing.count), tracing.max_bounces, chunks[c]);
        }
    });

    // Join them in the order of emission.
    TracedPhotons all;
    size_t direct = 0, indirect = 0;
    for (const TracedPhotons &chunk : chunks) {
        direct += chunk.direct.size();
        indirect += chunk.indirect.size();
    }
    all.direct.reserve(direct);
    all.indirect.reserve(indirect);
    for (TracedPhotons &chunk : chunks) {
        all.direct.insert(all.direct.end(), chunk.direct.begin(), chunk.direct.end());
        all.indirect.insert(all.indirect.end(), chunk.indirect.begin(), chunk.indirect.end());
        all.balance += chunk.balance;
        all.rays += chunk.rays;
        chunk = TracedPhotons();
    }
    return all;
}

}  // namespace photon_maps
