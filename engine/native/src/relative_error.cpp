// SPDX-License-Identifier: GPL-3.0-or-later
#include "relative_error.h"

#include <numeric>

namespace photon_maps {

float trimmed_mean(std::vector<float> &values, size_t share) {
    if (values.empty()) return 0;
    const auto end = values.end() - static_cast<std::ptrdiff_t>(values.size() / share);
    if (end != values.end()) std::nth_element(values.begin(), end, values.end());
    return static_cast<float>(std::accumulate(values.begin(), end, 0.0) / static_cast<double>(end - values.begin()));
}

float squared_floor(std::span<const Vec3> means) {
    constexpr size_t brightest = 100;
    std::vector<float> radiances;
    radiances.reserve(means.size());
    for (const Vec3 mean : means) radiances.push_back(average(mean));
    const float floor = trimmed_mean(radiances, brightest);
    return std::max(floor * floor, std::numeric_limits<float>::min());
}

float relative_square(Vec3 square, Vec3 mean, float floor) {
    return (square.x / (mean.x * mean.x + floor) + square.y / (mean.y * mean.y + floor) +
            square.z / (mean.z * mean.z + floor)) /
           3;
}

Vec3 variance_of_mean(Vec3 sum, Vec3 squares, uint32_t n) {
    const auto count = static_cast<float>(n);
    const Vec3 mean = sum / count;
    return max(squares / count - mean * mean, {}) / (count - 1);
}

}  // namespace photon_maps
