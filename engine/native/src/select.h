// SPDX-License-Identifier: GPL-3.0-or-later
// Quickselect whose result is the same with every standard library, and whose inner loop has no branch to mispredict.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "parallel.h"

namespace photon_maps {

/// Moves the items for which `goes_first` holds to the front; returns how many they are.
template <typename T, typename Predicate>
size_t sweep(std::span<T> items, Predicate goes_first) {
    size_t count = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        const T item = items[i];
        items[i] = items[count];
        items[count] = item;
        count += static_cast<size_t>(goes_first(item));
    }
    return count;
}

/// Reorders `items` so that the one at `middle` is where sorting would put it, smaller ones before it and greater
/// ones behind it (Hoare 1961). Linear time is expected whatever the input: pivots are drawn at random, by a fixed
/// seed.
/// @param items fewer than 2^32
/// @param middle below items.size()
/// @param less a strict weak order; which of equal items come first is the same for the same input
/// @param cancel looked at between sweeps; may be null
/// @throws Cancelled
template <typename T, typename Less>
void select(std::span<T> items, size_t middle, Less less, const std::atomic<bool> *cancel = nullptr) {
    uint64_t random = 0;
    while (items.size() > 1) {
        if (cancel && *cancel) throw Cancelled();

        // The pivot: of a few items the one whose rank among them is middle's among all.
        std::array<size_t, 9> sample{};
        const size_t sample_size = items.size() < 128 ? 3 : sample.size();
        for (size_t count = 0; count < sample_size; ++count) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const size_t drawn = (random >> 32) * items.size() >> 32;
            size_t at = count;
            for (; at > 0 && less(items[drawn], items[sample[at - 1]]); --at) sample[at] = sample[at - 1];
            sample[at] = drawn;
        }
        std::swap(items[sample[sample_size * middle / items.size()]], items.back());

        // The sweep: items below the pivot move to the front.
        const T pivot = items.back();
        const size_t below =
            sweep(items.first(items.size() - 1), [pivot, less](const T &item) { return less(item, pivot); });
        std::swap(items[below], items.back());
        if (middle < below) {
            items = items.first(below);
            continue;
        }

        // Where none is below it, all may be equal to it: those that are follow.
        const size_t equal =
            below > 0 ? 0 : sweep(items.subspan(1), [pivot, less](const T &item) { return !less(pivot, item); });
        if (middle <= below + equal) return;
        items = items.subspan(below + equal + 1);
        middle -= below + equal + 1;
    }
}

}  // namespace photon_maps
