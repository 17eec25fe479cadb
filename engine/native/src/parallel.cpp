// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace photon_maps {

int thread_count(uint32_t requested) {
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    return static_cast<int>(std::min(requested == 0 ? cores : requested, 1024u));
}

void parallel_for(int threads, size_t count, const std::atomic<bool> *cancel, const std::function<void(size_t)> &body) {
    std::atomic<size_t> next = 0;
    std::atomic<bool> stop = false;
    std::exception_ptr failure;
    std::mutex failure_mutex;

    const auto work = [&] {
        try {
            while (!stop) {
                throw_if_cancelled(cancel);
                const size_t i = next++;
                if (i >= count) return;
                body(i);
            }
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            if (!failure) failure = std::current_exception();
            stop = true;
        }
    };

    {
        std::vector<std::jthread> helpers;
        const size_t helper_count = std::min(static_cast<size_t>(threads), count);
        for (size_t t = 1; t < helper_count; ++t) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace photon_maps
