// SPDX-License-Identifier: GPL-3.0-or-later
#include "radius.h"

#include "estimate.h"
#include "first_diffuse_hit.h"
#include "parallel.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr double caustic_photons_in_kernel = 20;
constexpr float least_caustic_pixels = 5;
/// Of the width of what the camera sees: kernels much wider would blur all that there is to see of indirect light.
constexpr float largest_share_of_view = 0.125f;
constexpr uint64_t max_pilot_photons = 1 << 14;
constexpr uint64_t pilot_pixels = 512;
constexpr uint32_t pilot_stream = 0x70696c6f;

/// A diffuse point that the camera sees, and how long the way to it is.
struct SeenPoint {
    Vec3 position, normal;
    float distance;
};

/// Photons that no pass will trace again.
struct PilotPhotons {
    PhotonMap map;
    double share;  ///< of the photons of a pass

    PilotPhotons(const Scene &scene, const Emission &emission, const PhotonTracing &pass, pm_photon_kind kind,
                 const std::atomic<bool> *cancel) {
        PhotonTracing tracing = pass;
        tracing.first = 0;
        tracing.count = std::min(pass.count, max_pilot_photons);
        tracing.seed = hash(pass.seed, pilot_stream);
        TracedPhotons traced = trace_photons(scene, emission, tracing, cancel);
        map = PhotonMap(std::move(traced.photons[kind]), pass.threads, cancel);
        share = static_cast<double>(tracing.count) / static_cast<double>(pass.count);
    }

    /// Pilot photons that stand for so many of a pass.
    double stands_for(double photons, double least) const {
        return std::round(std::clamp(photons * share, least, photons));
    }
};

std::vector<SeenPoint> seen_points(const Scene &scene, const Camera &camera, uint32_t seed,
                                   const std::atomic<bool> *cancel) {
    std::vector<SeenPoint> points;
    for (uint64_t i = 0; i < pilot_pixels; ++i) {
        throw_if_cancelled(cancel);
        Sequence sequence(i, hash(seed, pilot_stream));
        const auto u = sequence.next();
        SurfacePoint hit;
        float distance = 0;
        const Vec2 pixel{u[0] * static_cast<float>(camera.frame_width), u[1] * static_cast<float>(camera.frame_height)};
        if (first_diffuse_hit(scene, camera.ray(pixel, {u[2], u[3]}), sequence, hit, distance))
            points.push_back({hit.position, hit.normal, distance});
    }
    return points;
}

float median(std::vector<float> &values) {
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Radii that hold k photons around some of the photons themselves.
std::vector<float> radii_around_photons(const PhotonMap &map, double k, float max_radius,
                                        const std::atomic<bool> *cancel) {
    std::vector<float> radii;
    const size_t step = std::max<size_t>(1, map.size() / pilot_pixels);
    for (size_t i = 0; i < map.size(); i += step) {
        throw_if_cancelled(cancel);
        const PhotonBlock &photons = map.blocks()[i / lanes];
        const Vec3 normal = normalize(unpack_normal(photons.normal[i % lanes]));
        radii.push_back(
            radius_holding(map, {photons.position(i % lanes), normal, normal}, static_cast<size_t>(k), max_radius));
    }
    return radii;
}

/// A radius that holds k pilot photons, scaled to one that holds the wanted number of a pass: their number in a kernel
/// grows with the square of its radius and with the emitted photons.
float scaled(float radius, double wanted, const PilotPhotons &pilot, double k) {
    return static_cast<float>(static_cast<double>(radius) * std::sqrt(wanted * pilot.share / k));
}

}  // namespace

float shrunk_radius(float first_radius, uint32_t index) {
    // The product of (i + alpha) / (i + 1) for i = 1 ... index, by the gamma function.
    constexpr double alpha = 2.0 / 3;
    const double n = index;
    const double log_squared = std::lgamma(n + 1 + alpha) - std::lgamma(1 + alpha) - std::lgamma(n + 2);
    return static_cast<float>(static_cast<double>(first_radius) * std::exp(log_squared / 2));
}

float choose_indirect_radius(const Scene &scene, const Emission &emission, const Camera &camera,
                             const PhotonTracing &pass, const std::atomic<bool> *cancel) {
    const PilotPhotons pilot(scene, emission, pass, PM_PHOTONS_INDIRECT, cancel);
    const float max_radius = scene.bounds().radius();

    // Find what radius holds k of them around points that the camera sees; where it sees too little to judge by, around
    // the photons themselves. Without any, any radius will do.
    const double k = pilot.stands_for(usual_photons_in_kernel, 16);
    std::vector<float> radii, widths;
    for (const SeenPoint &point : seen_points(scene, camera, pass.seed, cancel)) {
        throw_if_cancelled(cancel);
        const Query query{point.position, point.normal, point.normal};
        radii.push_back(radius_holding(pilot.map, query, static_cast<size_t>(k), max_radius));
        widths.push_back(camera.footprint(point.distance) * static_cast<float>(camera.frame_width));
    }
    const bool sees_any = !radii.empty();
    if (!sees_any) radii = radii_around_photons(pilot.map, k, max_radius, cancel);
    if (radii.empty()) return max_radius / 100;
    const float radius = scaled(median(radii), usual_photons_in_kernel, pilot, k);
    return sees_any ? std::min(radius, largest_share_of_view * median(widths)) : radius;
}

float choose_caustic_radius(const Scene &scene, const Emission &emission, const Camera &camera,
                            const PhotonTracing &pass, const std::atomic<bool> *cancel) {
    const PilotPhotons pilot(scene, emission, pass, PM_PHOTONS_CAUSTIC, cancel);

    // Around the photons, not the pixels: it is where they lie densely that a caustic is sharp.
    const float max_radius = scene.bounds().radius() / 8;
    const double k = pilot.stands_for(caustic_photons_in_kernel, 8);
    std::vector<float> radii = radii_around_photons(pilot.map, k, max_radius, cancel);
    if (radii.empty()) return 0;
    const float by_density = scaled(median(radii), caustic_photons_in_kernel, pilot, k);

    std::vector<float> footprints;
    for (const SeenPoint &point : seen_points(scene, camera, pass.seed, cancel))
        footprints.push_back(camera.footprint(point.distance));
    const float by_pixel = footprints.empty() ? 0 : least_caustic_pixels * median(footprints);
    return std::min(std::max(by_density, by_pixel), max_radius);
}

}  // namespace photon_maps
