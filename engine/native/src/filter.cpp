// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter.h"

namespace photon_maps {

float Kernel::norm() const { return 2 * pi * wedge(radius); }

float Kernel::wedge(float s) const {
    const float s2 = s * s;
    switch (filter) {
        case PM_FILTER_NONE:
            return s2 / 2;
        case PM_FILTER_CONE:
            return s2 * (0.5f - s / radius / (3 * cone_k));
        case PM_FILTER_GAUSSIAN: {
            const double r2 = static_cast<double>(radius) * radius;
            const double exponent = gaussian_beta * s2 / (2 * r2);
            return static_cast<float>(
                gaussian_alpha * ((1 - gaussian_c) * s2 / 2 - gaussian_c * r2 / gaussian_beta * std::expm1(-exponent)));
        }
        case PM_FILTER_EPANECHNIKOV:
            return s2 * (0.5f - s2 / (radius * radius) / 4);
    }
    return 0;
}

}  // namespace photon_maps
