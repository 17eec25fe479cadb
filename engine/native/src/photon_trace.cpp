// SPDX-License-Identifier: GPL-3.0-or-later
#include "photon_trace.h"

#include "parallel.h"

namespace photon_maps {

namespace {

constexpr uint64_t chunk_size = 1024, chunks_at_once = 256;

template <typename T>
void append(std::vector<T> &list, const std::vector<T> &more) {
    list.insert(list.end(), more.begin(), more.end());
}

/// Appends the photons of chunks, in their order.
/// @param share of all photons that will have been traced then: room is made at once for the rest, and for those that
///     a map adds to the last eight
void append(TracedPhotons &all, const std::vector<TracedPhotons> &chunks, double share) {
    for (size_t kind = 0; kind < all.photons.size(); ++kind) {
        std::vector<Photon> &list = all.photons[kind];
        size_t count = list.size();
        for (const TracedPhotons &chunk : chunks) count += chunk.photons[kind].size();
        constexpr double margin = 1.02;
        if (count > list.capacity()) {
            const double expected = share < 1 ? margin * static_cast<double>(count) / share : 0;
            list.reserve(std::max(count, static_cast<size_t>(expected)) + lanes);
        }
        for (const TracedPhotons &chunk : chunks) {
            append(list, chunk.photons[kind]);
            append(all.origins[kind], chunk.origins[kind]);
        }
    }
    for (const TracedPhotons &chunk : chunks) {
        append(all.shadow_photons, chunk.shadow_photons);
        append(all.shadow_origins, chunk.shadow_origins);
        append(all.segments, chunk.segments);
        for (const auto &[key, received] : chunk.received) all.received[key] += received;
        all.balance += chunk.balance;
        all.rays += chunk.rays;
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

Received &Received::operator+=(const Received &other) {
    arrived += other.arrived;
    stored += other.stored;
    for (size_t c = 0; c < 3; ++c) flux[c] += other.flux[c];
    return *this;
}

TracedPhotons trace_photons(const Scene &scene, const Emission &emission, const PhotonTracing &tracing,
                            const std::atomic<bool> *cancel) {
    // Trace chunks of photons, each into its own lists; join them in the order of emission. Not all at once, for the
    // lists would then be there twice.
    TracedPhotons all;
    const uint64_t chunk_count = (tracing.count + chunk_size - 1) / chunk_size;
    for (uint64_t first = 0; first < chunk_count; first += chunks_at_once) {
        const uint64_t last = std::min(first + chunks_at_once, chunk_count);
        std::vector<TracedPhotons> chunks(last - first);
        parallel_for(tracing.threads, chunks.size(), cancel, [&](size_t c) {
            const uint64_t begin = (first + c) * chunk_size, end = std::min(begin + chunk_size, tracing.count);
            for (uint64_t i = begin; i < end; ++i) {
                throw_if_cancelled(cancel);
                trace_photon(scene, emission, tracing, i, chunks[c]);
            }
        });
        append(all, chunks, static_cast<double>(last) / static_cast<double>(chunk_count));
    }
    return all;
}

}  // namespace photon_maps
