// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels that weigh photons by their distance (Jensen 2001, section 7.3; Silverman 1986 for Epanechnikov's).
#pragma once

#include "photon_maps.h"
#include "simd.h"
#include "vec.h"

namespace photon_maps {

/// Jensen's Gaussian: w = alpha (1 - c + c exp(-beta d2 / (2 r2))) with c = 1 / (1 - exp(-beta)).
constexpr double gaussian_alpha = 0.918;
constexpr double gaussian_beta = 1.953;
constexpr double gaussian_c = 1.1652945755669075;

/// A radially symmetric weight w(d) on the disc of a radius; outside it no photon counts.
struct Kernel {
    pm_filter filter = PM_FILTER_EPANECHNIKOV;
    float radius = 0;  ///< scene units, > 0
    float cone_k = 1;  ///< PM_FILTER_CONE: the slope's constant, >= 1

    /// Returns w at eight squared distances, as shares of radius^2, 0 to 1.
    [[gnu::always_inline]] Float8 weights(Float8 t) const;

    /// Returns the integral of w over the disc, in m2: pi r2, pi r2 (1 - 2/(3k)), the Gaussian's, pi r2 / 2.
    float norm() const;

    /// Returns the integral of w(rho) rho drho from 0 to `s` (0 <= s <= radius), in m2: the part that one radian of
    /// a disc of radius s holds.
    float wedge(float s) const;
};

inline Float8 Kernel::weights(Float8 t) const {
    switch (filter) {
        case PM_FILTER_NONE:
            break;
        case PM_FILTER_CONE:
            return 1 - sqrt(t) / cone_k;
        case PM_FILTER_GAUSSIAN: {
            // exp by its Taylor series around the middle of what can occur: 1e-7 right, the same on every machine.
            constexpr auto middle = static_cast<float>(-gaussian_beta / 4);
            constexpr float exp_middle = 0.6136994f;
            const Float8 y = t * static_cast<float>(-gaussian_beta / 2) - middle;
            Float8 exp_y = broadcast(1);
            for (int m = 8; m > 0; --m) exp_y = 1 + exp_y * y * (1 / static_cast<float>(m));
            constexpr auto base = static_cast<float>(gaussian_alpha * (1 - gaussian_c));
            constexpr auto scale = static_cast<float>(gaussian_alpha * gaussian_c) * exp_middle;
            return base + scale * exp_y;
        }
        case PM_FILTER_EPANECHNIKOV:
            return 1 - t;
    }
    return broadcast(1);
}

}  // namespace photon_maps
