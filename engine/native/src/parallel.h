// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over several threads, with cancel.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>

namespace photon_maps {

/// Thrown through the helper's own loops when the user stops a render; ends as PM_CANCELLED.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("the render was cancelled") {}
};

/// @throws Cancelled if `cancel` (may be null) is set.
inline void throw_if_cancelled(const std::atomic<bool> *cancel) {
    if (cancel && *cancel) throw Cancelled();
}

/// Returns the number of threads to use: `requested`, or one for every core where it is 0.
int thread_count(uint32_t requested);

/// Calls body(i) once for every i in [0, count), on `threads` threads that take the next i from one counter.
/// Which thread runs which i is left open: results must not depend on it.
/// @throws Cancelled once `cancel` (may be null) is set; otherwise the first exception that a body threw.
void parallel_for(int threads, size_t count, const std::atomic<bool> *cancel, const std::function<void(size_t)> &body);

}  // namespace photon_maps
