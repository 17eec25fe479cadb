// SPDX-License-Identifier: GPL-3.0-or-later
// The rays that a pass asks of Embree, and their bare rate: nothing but rtcIntersect1 and rtcOccluded1, in the same
// order.
#pragma once

#include <atomic>
#include <utility>
#include <vector>

#include "embree.h"
#include "measure.h"
#include "parallel.h"

namespace photon_maps {

/// What passes have asked. Embree's calls bring no context along, so there is one for the program while it records.
struct RecordedRays {
    struct Asked {
        rtc::Ray ray;
        bool is_shadow;
    };

    rtc::Scene scene = nullptr;
    std::vector<Asked> rays;
    uint64_t hits = 0, shadows = 0;  ///< rays that met something, of each kind
    rtc::Functions bare{};

    size_t size() const { return rays.size(); }
};

inline RecordedRays &recording() {
    static RecordedRays the_recording;
    return the_recording;
}

inline void record_intersect(rtc::Scene scene, rtc::RayHit *ray, void *arguments) {
    RecordedRays &r = recording();
    r.scene = scene;
    r.rays.push_back({ray->ray, false});
    r.bare.rtcIntersect1(scene, ray, arguments);
    r.hits += ray->hit.geometry != rtc::invalid_id;
}

inline void record_occluded(rtc::Scene scene, rtc::Ray *ray, void *arguments) {
    RecordedRays &r = recording();
    r.scene = scene;
    r.rays.push_back({*ray, true});
    r.bare.rtcOccluded1(scene, ray, arguments);
    r.shadows += ray->tfar < 0;
}

/// Runs a pass, which must keep to this thread, with recorders in the places of Embree's calls.
/// @param embree made without const
template <typename Pass>
RecordedRays rays_of(Pass pass, Embree &embree) {
    rtc::Functions &functions = const_cast<rtc::Functions &>(embree.functions());
    recording().bare = functions;
    functions.rtcIntersect1 = record_intersect;
    functions.rtcOccluded1 = record_occluded;
    pass();
    functions = recording().bare;
    return std::exchange(recording(), {});
}

/// Traces the recorded rays and nothing else.
inline void trace_bare(const RecordedRays &recorded, int threads) {
    constexpr size_t block = 2048;
    std::atomic<uint64_t> hits = 0, shadows = 0;
    const size_t count = recorded.size();
    parallel_for(threads, (count + block - 1) / block, nullptr, [&](size_t b) {
        uint64_t block_hits = 0, block_shadows = 0;
        for (size_t i = b * block; i < std::min((b + 1) * block, count); ++i) {
            const RecordedRays::Asked &asked = recorded.rays[i];
            rtc::RayHit ray{asked.ray, {}};
            if (asked.is_shadow) {
                recorded.bare.rtcOccluded1(recorded.scene, &ray.ray, nullptr);
                block_shadows += ray.ray.tfar < 0;
                continue;
            }
            ray.hit.geometry = ray.hit.instance = rtc::invalid_id;
            recorded.bare.rtcIntersect1(recorded.scene, &ray, nullptr);
            block_hits += ray.hit.geometry != rtc::invalid_id;
        }
        hits += block_hits;
        shadows += block_shadows;
    });
    bench::require(hits == recorded.hits && shadows == recorded.shadows, "bare rays hit something else");
}

}  // namespace photon_maps
