// SPDX-License-Identifier: GPL-3.0-or-later
// Multiple importance sampling.
#pragma once

namespace photon_maps {

/// Weight of a sample against another way to choose it (Veach 1997, section 9.2.4: the power heuristic).
constexpr float power_heuristic(float pdf, float other_pdf) {
    const float ratio = other_pdf / pdf;
    return 1 / (1 + ratio * ratio);
}

}  // namespace photon_maps
