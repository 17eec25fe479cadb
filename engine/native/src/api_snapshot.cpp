// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface to the photons of a pass.
#include <algorithm>
#include <numeric>

#include "api.h"
#include "convert.h"

namespace {

void store(pm::Vec3 v, float *out) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

const std::vector<pm::Photon> &photons_of(const pm_snapshot &snapshot, uint32_t kind) {
    pm::require(kind < pm::PhotonSnapshot::kind_count, "unknown kind of photons " + std::to_string(kind));
    return snapshot.snapshot->photons[kind];
}

pm_photon_segment to_pm_segment(const pm::PhotonSegment &segment) {
    pm_photon_segment result{};
    store(segment.start, result.start);
    store(segment.end, result.end);
    store(segment.flux, result.flux);
    result.bounce = segment.bounce;
    result.source = segment.origin.source;
    result.number = segment.origin.number;
    return result;
}

pm_map_probe to_pm_map_probe(const pm::ProbedIrradiance &found) {
    pm_map_probe result{};
    result.radius = found.radius;
    result.photons = found.photons;
    store(found.irradiance, result.irradiance);
    const pm::Vec3 v = found.variance;
    store({std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z)}, result.standard_error);
    return result;
}

}  // namespace

pm_status pm_snapshot_create(pm_render *render, uint32_t index, pm_snapshot **snapshot) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require_handle(snapshot, "snapshot");
        if (!render->render.has_begun()) throw pm::InvalidOperation("no pass has been rendered yet");
        *snapshot = std::make_unique<pm_snapshot>(pm_snapshot{render->state, render->render.snapshot(index)}).release();
    });
}

pm_status pm_snapshot_count(const pm_snapshot *snapshot, uint32_t kind, uint64_t *count) {
    return pm::guarded([&] {
        pm::require_handle(snapshot, "snapshot");
        pm::require_handle(count, "count");
        *count = photons_of(*snapshot, kind).size();
    });
}

pm_status pm_snapshot_photons(const pm_snapshot *snapshot, uint32_t kind, uint64_t first, uint64_t count,
                              pm_traced_photon *photons) {
    return pm::guarded([&] {
        pm::require_handle(snapshot, "snapshot");
        pm::require(photons || count == 0, "photons is null");
        const std::vector<pm::Photon> &source = photons_of(*snapshot, kind);
        pm::require(first <= source.size() && count <= source.size() - first,
                    "there are only " + std::to_string(source.size()) + " photons of this kind");
        for (uint64_t i = first; i < first + count; ++i) {
            const pm::PhotonOrigin &origin = snapshot->snapshot->origins[kind][i];
            pm_photon photon = pm::to_pm_photon(source[i]);
            if (kind == PM_PHOTONS_SHADOW) {  // nothing arrived
                photon = {};
                store(source[i].position, photon.position);
            }
            photons[i - first] = {photon, origin.source, origin.instance, origin.number};
        }
    });
}

pm_status pm_snapshot_segments(const pm_snapshot *snapshot, uint32_t is_caustic, const uint32_t *numbers,
                               uint64_t count, pm_photon_segment *segments, uint64_t capacity,
                               uint64_t *segment_count) {
    return pm::guarded([&] {
        pm::require_handle(snapshot, "snapshot");
        pm::require_handle(segment_count, "segment_count");
        pm::require(numbers || count == 0, "numbers is null");
        pm::require(segments || capacity == 0, "segments is null");
        pm::validate_count(count, "numbers");
        const auto purpose = is_caustic ? pm::PhotonPurpose::caustic : pm::PhotonPurpose::global;
        for (const pm::PhotonTracing &tracing : snapshot->snapshot->tracings)
            for (uint64_t i = 0; tracing.purpose == purpose && i < count; ++i)
                pm::require(numbers[i] < tracing.count, "there is no photon " + std::to_string(numbers[i]));
        const pm::SceneState &state = *snapshot->state;
        const std::vector<pm::PhotonSegment> found =
            trace_segments(state.scene, *state.emission, *snapshot->snapshot, purpose, {numbers, count});
        const auto written = static_cast<ptrdiff_t>(std::min<uint64_t>(capacity, found.size()));
        std::transform(found.begin(), found.begin() + written, segments, to_pm_segment);
        *segment_count = found.size();
    });
}

pm_status pm_snapshot_received(const pm_snapshot *snapshot, pm_received *rows, uint64_t capacity, uint64_t *row_count) {
    return pm::guarded([&] {
        pm::require_handle(snapshot, "snapshot");
        pm::require_handle(row_count, "row_count");
        pm::require(rows || capacity == 0, "rows is null");
        *row_count = 0;
        for (const auto purpose : {pm::PhotonPurpose::global, pm::PhotonPurpose::caustic}) {
            for (const auto &[key, received] : snapshot->snapshot->received[static_cast<size_t>(purpose)]) {
                if (*row_count < capacity) {
                    const bool is_caustic = purpose == pm::PhotonPurpose::caustic;
                    const auto &[instance, source] = key;
                    rows[*row_count] = {instance,
                                        source,
                                        is_caustic,
                                        0,
                                        received.arrived,
                                        received.stored,
                                        {received.flux[0], received.flux[1], received.flux[2]}};
                }
                ++*row_count;
            }
        }
    });
}

pm_status pm_snapshot_probe(const pm_snapshot *snapshot, const float *origin, const float *direction, pm_probe *probe) {
    return pm::guarded([&] {
        pm::require_handle(snapshot, "snapshot");
        pm::require_handle(origin, "origin");
        pm::require_handle(direction, "direction");
        pm::require_handle(probe, "probe");
        pm::require(probe->struct_size == sizeof(pm_probe), "pm_probe has another struct_size");
        const pm::Vec3 from = pm::vec3(origin), along = pm::vec3(direction);
        pm::require(pm::is_finite(from) && pm::max_component(pm::abs(from)) <= pm::max_coordinate,
                    "origin is not finite or beyond 1e9");
        pm::require(std::abs(pm::length(along) - 1) < 1e-3f, "direction is no unit vector");
        *probe = {};
        probe->struct_size = sizeof(pm_probe);
        const pm::Ray ray{from, along, 0, pm::infinity, 1u << PM_RAY_CAMERA};
        const auto found = pm::probe(snapshot->state->scene, *snapshot->snapshot, ray);
        if (!found) return;
        probe->is_hit = 1;
        probe->keeps_photons = found->keeps_photons;
        probe->instance = found->hit.instance;
        store(found->hit.position, probe->position);
        store(found->hit.normal, probe->normal);
        probe->global_map = to_pm_map_probe(found->global);
        probe->caustic_map = to_pm_map_probe(found->caustic);
    });
}

void pm_snapshot_release(pm_snapshot *snapshot) { const std::unique_ptr<pm_snapshot> owned(snapshot); }
