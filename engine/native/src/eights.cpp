// SPDX-License-Identifier: GPL-3.0-or-later
#include "eights.h"

namespace photon_maps {

namespace {

/// The axis along which points reach farthest.
int longest_axis(std::span<const Vec3> points, std::span<const uint32_t> numbers) {
    Vec3 lower = points[numbers.front()], upper = lower;
    for (const uint32_t i : numbers) {
        lower = min(lower, points[i]);
        upper = max(upper, points[i]);
    }
    const Vec3 size = upper - lower;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Halves the points by their longest axis until eight are left, between runs of the largest power of 8 that they
/// exceed.
void order_part(std::span<const Vec3> points, std::span<uint32_t> numbers) {
    if (numbers.size() <= lanes) return;
    size_t run = lanes;
    while (run * lanes < numbers.size()) run *= lanes;
    const size_t middle = (numbers.size() + run - 1) / run / 2 * run;
    const int axis = longest_axis(points, numbers);
    std::nth_element(numbers.begin(), numbers.begin() + static_cast<ptrdiff_t>(middle), numbers.end(),
                     [&](uint32_t a, uint32_t b) {
                         const float left = points[a][axis], right = points[b][axis];
                         return left != right ? left < right : a < b;
                     });
    order_part(points, numbers.first(middle));
    order_part(points, numbers.subspan(middle));
}

}  // namespace

std::vector<uint32_t> order_in_eights(std::span<const Vec3> points) {
    std::vector<uint32_t> numbers(points.size());
    for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    order_part(points, numbers);
    return numbers;
}

}  // namespace photon_maps
