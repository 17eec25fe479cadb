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

Ray Camera::ray(Vec2 pixel) const {
    const float x_plane = left + (right - left) * pixel.x / static_cast<float>(frame_width);
    const float y_plane = bottom + (top - bottom) * pixel.y / static_cast<float>(frame_height);
    if (type == PM_CAMERA_ORTHOGRAPHIC)
        return {transform.point({x_plane, y_plane, 0}), transform.vector({0, 0, -1}), clip_start, clip_end};
    return {transform.origin, transform.vector({x_plane, y_plane, -1}), clip_start, clip_end};
}

}  // namespace photon_maps
