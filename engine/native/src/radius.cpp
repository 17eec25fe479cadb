// SPDX-License-Identifier: GPL-3.0-or-later
#include "radius.h"

#include "camera_pass.h"
#include "estimate.h"
#include "parallel.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr double photons_in_kernel = 125;
constexpr uint64_t max_pilot_photons = 1 << 16;
constexpr uint64_t pilot_pixels = 512;
constexpr uint32_t pilot_stream = 0x70696c6f;

}  // namespace

float shrunk_radius(float first_radius, uint32_t index) {
    // The product of (i + alpha) / (i + 1) for i = 1 ... index, by the gamma function.
    constexpr double alpha = 2.0 / 3;
    const double n = index;
    const double log_squared = std::lgamma(n + 1 + alpha) - std::lgamma(1 + alpha) - std::lgamma(n + 2);
    return static_cast<float>(static_cast<double>(first_radius) * std::exp(log_squared / 2));
}

float choose_first_radius(const Scene &scene, const Lights &lights, const Camera &camera, PhotonTracing pass,
                          const std::atomic<bool> *cancel) {
    // Trace pilot photons, none of which a pass will trace again.
    PhotonTracing pilot = pass;
    pilot.first = 0;
    pilot.count = std::min(pass.count, max_pilot_photons);
    pilot.seed = hash(pass.seed, pilot_stream);
    const TracedPhotons photons = trace_photons(scene, lights, pilot, cancel);
    const PhotonMap map(photons.indirect, pass.threads, cancel);
    const float max_radius = scene.bounds().radius();

    // Find what radius holds k of them around points that the camera sees.
    const double share = static_cast<double>(pilot.count) / static_cast<double>(pass.count);
    const double k = std::round(std::clamp(photons_in_kernel * share, 16.0, photons_in_kernel));
    std::vector<float> radii;
    const auto ask = [&](Vec3 position, Vec3 normal) {
        throw_if_cancelled(cancel);
        radii.push_back(radius_holding(map, {position, normal, normal}, static_cast<size_t>(k), max_radius));
    };
    for (uint64_t i = 0; i < pilot_pixels; ++i) {
        const auto u = sobol4(i, pilot.seed);
        SurfacePoint hit;
        const Vec2 pixel{u[0] * static_cast<float>(camera.frame_width), u[1] * static_cast<float>(camera.frame_height)};
        if (first_hit(scene, camera, pixel, hit) && (hit.material->traits.lobes & diffuse_lobes) != 0)
            ask(hit.position, hit.normal);
    }
    // Where the camera sees too little to judge by, ask around the photons themselves; without any, any radius will do.
    const size_t step = std::max<size_t>(1, photons.indirect.size() / pilot_pixels);
    if (radii.empty())
        for (size_t i = 0; i < photons.indirect.size(); i += step)
            ask(photons.indirect[i].position, normalize(unpack_normal(photons.indirect[i].normal)));
    if (radii.empty()) return max_radius / 100;

    // The median pixel; the number in a kernel grows with the square of its radius and with the emitted photons.
    std::nth_element(radii.begin(), radii.begin() + static_cast<ptrdiff_t>(radii.size() / 2), radii.end());
    const double scale = std::sqrt(photons_in_kernel * share / k);
    return static_cast<float>(static_cast<double>(radii[radii.size() / 2]) * scale);
}

}  // namespace photon_maps
