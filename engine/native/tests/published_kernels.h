// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels as their authors write them, to compare with.
#pragma once

#include <cmath>

#include "filter.h"

namespace photon_maps::test {

/// The kernels as they are published, in double precision; t is (d / r)^2.
inline double published_weight(const Kernel &kernel, double t) {
    switch (kernel.filter) {
        case PM_FILTER_NONE:
            return 1;
        case PM_FILTER_CONE:
            return 1 - std::sqrt(t) / double{kernel.cone_k};
        case PM_FILTER_GAUSSIAN:
            return 0.918 * (1 - (1 - std::exp(-1.953 * t / 2)) / (1 - std::exp(-1.953)));
        case PM_FILTER_EPANECHNIKOV:
            return 1 - t;
    }
    return -1;
}

}  // namespace photon_maps::test
