// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera.h"

namespace photon_maps {

namespace {

/// How far a filter reaches, in its width, as Blender's Cycles has them: the width of the curved ones is that of
/// what they weigh most.
double support(PixelFilter filter) {
    return filter == PixelFilter::gaussian ? 3 : filter == PixelFilter::blackman_harris ? 2 : 1;
}

/// The filters at t in [-1/2, 1/2] of their support.
double filter_weight(PixelFilter filter, double t) {
    switch (filter) {
        case PixelFilter::box:
            return 1;
        case PixelFilter::gaussian:
            return std::exp(-72 * t * t);  // exp(-8 (x / width)^2) over three widths
        case PixelFilter::blackman_harris: {
            const double phase = 2 * std::numbers::pi * (t + 0.5);  // Harris 1978
            return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
        }
    }
    return 0;
}

/// A point of the aperture, uniform by area: in a disk or, with three blades or more, in a regular polygon with the
/// middle of a side at the angle of the rotation (Cycles, kernel/camera/camera.h).
Vec2 aperture_point(const Camera &camera, Vec2 lens) {
    Vec2 point = sample_disk(lens.x, lens.y);
    if (camera.aperture_blades >= 3) {
        // Choose a blade, then a point in the triangle of its two corners and the middle (Turk 1990).
        const auto blades = static_cast<float>(camera.aperture_blades);
        const float blade = std::min(std::floor(lens.x * blades), blades - 1);
        const float root = std::sqrt(lens.x * blades - blade);
        const float along = root * std::cos(pi / blades), across = root * (1 - 2 * lens.y) * std::sin(pi / blades);
        const float angle = camera.aperture_rotation + 2 * pi * blade / blades;
        const float cosine = std::cos(angle), sine = std::sin(angle);
        point = {cosine * along - sine * across, sine * along + cosine * across};
    }
    return {point.x * camera.aperture_radius / camera.aperture_ratio, point.y * camera.aperture_radius};
}

/// A unit direction in the camera's axes: longitude 0 is the view direction.
Vec3 equirectangular_direction(float longitude, float latitude) {
    const float width = std::cos(latitude);
    return {width * std::sin(longitude), std::sin(latitude), -width * std::cos(longitude)};
}

/// The axes of a panorama's lens, which faces every direction: x leans towards the camera's view direction, as in
/// Cycles.
struct LensPlane {
    Vec3 x, y;

    explicit LensPlane(Vec3 direction) {
        const Vec3 forward{0, 0, -1};
        const Vec3 leaning = forward - direction * dot(forward, direction);
        // Straight ahead nothing leans: any axis will do.
        x = length_squared(leaning) > 1e-12f ? normalize(leaning) : Vec3{1, 0, 0};
        y = cross(direction, x);
    }
};

}  // namespace

PixelSampler::PixelSampler(PixelFilter filter, float width) {
    // Sum the filter over fine steps, then invert the sum.
    constexpr size_t fine = 16 * steps;
    std::array<double, fine + 1> cumulative{};
    for (size_t i = 0; i < fine; ++i)
        cumulative[i + 1] = cumulative[i] + filter_weight(filter, (static_cast<double>(i) + 0.5) / fine - 0.5);
    size_t at = 0;
    for (size_t i = 0; i <= steps; ++i) {
        const double target = cumulative[fine] * static_cast<double>(i) / steps;
        while (at < fine && cumulative[at + 1] < target) ++at;
        const double step = cumulative[std::min(at + 1, fine)] - cumulative[at];
        const double t = static_cast<double>(at) + (step > 0 ? (target - cumulative[at]) / step : 0);
        inverse_[i] =
            static_cast<float>((std::min(t / fine, 1.0) - 0.5) * support(filter) * static_cast<double>(width));
    }
}

float PixelSampler::offset(float u) const {
    const float scaled = u * steps;
    const auto i = std::min(static_cast<size_t>(scaled), steps - 1);
    const float t = scaled - static_cast<float>(i);
    return inverse_[i] * (1 - t) + inverse_[i + 1] * t;
}

Ray Camera::ray(Vec2 pixel, Vec2 lens) const {
    const float x_plane = left + (right - left) * pixel.x / static_cast<float>(frame_width);
    const float y_plane = bottom + (top - bottom) * pixel.y / static_cast<float>(frame_height);

    // The ray through the middle of the lens.
    Vec3 origin, direction;
    if (type == PM_CAMERA_ORTHOGRAPHIC) {
        origin = {x_plane, y_plane, 0};
        direction = {0, 0, -1};
    } else if (type == PM_CAMERA_PERSPECTIVE) {
        direction = {x_plane, y_plane, -1};
    } else {
        direction = equirectangular_direction(x_plane, y_plane);
    }

    // Any other ray of the pixel meets it in the plane of focus.
    if (aperture_radius > 0) {
        const Vec2 point = aperture_point(*this, lens);
        Vec3 offset{point.x, point.y, 0};
        if (type == PM_CAMERA_EQUIRECTANGULAR) {
            const LensPlane plane(direction);
            offset = plane.x * point.x + plane.y * point.y;
        }
        origin += offset;
        direction = direction - offset / focus_distance;
    }
    return {transform.point(origin), transform.vector(direction), clip_start, clip_end};
}

float Camera::footprint(float depth) const {
    const float area =
        (right - left) / static_cast<float>(frame_width) * (top - bottom) / static_cast<float>(frame_height);
    return std::sqrt(area) * (type == PM_CAMERA_ORTHOGRAPHIC ? 1 : depth);
}

}  // namespace photon_maps
