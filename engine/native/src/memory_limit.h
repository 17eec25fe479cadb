// SPDX-License-Identifier: GPL-3.0-or-later
// What a render will need of memory, foreseen: where the system hands out more than there is, it is too late to be told
// when it is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace photon_maps {

/// What was asked for does not fit into the memory that may be used.
struct MemoryLimitExceeded : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Returns the bytes of memory that the machine has; SIZE_MAX where the system does not say.
size_t machine_memory();

/// Returns the bytes that a render may use: as asked for, or of 0 nine tenths of the machine's.
size_t memory_limit_or_usual(uint64_t asked);

/// Returns the bytes of a picture's buffers in all that holds them while a pass is rendered; nested radii, which are
/// kept where there are caustics only, come on top.
/// @param buffers bit 1 << Buffer
size_t picture_bytes(uint32_t width, uint32_t height, uint32_t buffers);

/// Returns the stored photons of a pass for which there is room.
/// @param taken bytes of all else
/// @param keeps_lists whether their lists stay while the next pass is traced
/// @throws MemoryLimitExceeded if there is no room for any
double photons_with_room(size_t limit, size_t taken, bool keeps_lists);

/// @throws MemoryLimitExceeded if more bytes are needed than may be used
void require_memory(size_t limit, size_t needed, const char *what);

}  // namespace photon_maps
