// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory_limit.h"

#if defined(_WIN32)
#include <windows.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <limits>
#include <string>

#include "film.h"
#include "photon.h"

namespace photon_maps {

namespace {

std::string megabytes(size_t bytes) { return std::to_string((bytes >> 20) + 1) + " MB"; }

}  // namespace

size_t machine_memory() {
#if defined(_WIN32)
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof status;
    return GlobalMemoryStatusEx(&status) ? static_cast<size_t>(status.ullTotalPhys)
                                         : std::numeric_limits<size_t>::max();
#else
    const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_size > 0 ? static_cast<size_t>(pages) * static_cast<size_t>(page_size)
                                      : std::numeric_limits<size_t>::max();
#endif
}

size_t memory_limit_or_usual(uint64_t asked) {
    if (asked > 0) return static_cast<size_t>(std::min<uint64_t>(asked, std::numeric_limits<size_t>::max()));
    return machine_memory() / 10 * 9;
}

size_t picture_bytes(uint32_t width, uint32_t height, uint32_t buffers) {
    // The sum and the pass, and the error's own sums.
    size_t floats = 0;
    for (size_t b = 0; b < buffer_count; ++b)
        if (buffers >> b & 1) floats += 2 * buffer_channels[b];
    constexpr size_t floats_of_error = 10;
    if (buffers >> static_cast<size_t>(Buffer::error) & 1) floats += floats_of_error;
    return size_t{width} * height * floats * sizeof(float);
}

double photons_with_room(size_t limit, size_t taken, bool keeps_lists) {
    // The list of the photons, in whose place their map is built, and the map's boxes; a kept list stays beside its map
    // and the list of the next pass.
    constexpr size_t bytes_of_boxes = 4, least_room = 1 << 20;
    const size_t bytes = (keeps_lists ? 3 : 1) * sizeof(Photon) + bytes_of_boxes;
    const size_t room = limit > taken ? limit - taken : 0;
    if (room < least_room)
        throw MemoryLimitExceeded("the scene and the picture take about " + megabytes(taken) +
                                  ", which leaves no room for photons below the memory limit of " + megabytes(limit));
    return static_cast<double>(room) / static_cast<double>(bytes);
}

void require_memory(size_t limit, size_t needed, const char *what) {
    if (needed > limit)
        throw MemoryLimitExceeded(std::string(what) + " needs about " + megabytes(needed) +
                                  ", more than the memory limit of " + megabytes(limit));
}

}  // namespace photon_maps
