// SPDX-License-Identifier: GPL-3.0-or-later
#include "processor.h"

#if defined(__x86_64__)

#include <cpuid.h>

#include <cstdint>
#include <cstdlib>

namespace photon_maps {

namespace {

// Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2, CPUID, and volume 1, section 14.3.
constexpr uint32_t sse4_2 = 1u << 20, popcnt = 1u << 23, os_saves = 1u << 27;  // leaf 1, ecx
constexpr uint32_t avx2 = 1u << 5;                                             // leaf 7, ebx
constexpr uint32_t vector_registers = 6;                                       // of 128 and 256 bits, in XCR0

uint32_t features() {
    uint32_t a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(1, &a, &b, &c, &d) ? c : 0;
}

uint32_t more_features() {
    uint32_t a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) ? b : 0;
}

/// Returns the lower half of XCR0: what the operating system saves; only if it says os_saves.
uint32_t saved_registers() {
    uint32_t low = 0, high = 0;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

bool saves_vectors() {
    return (features() & os_saves) != 0 && (saved_registers() & vector_registers) == vector_registers;
}

/// Set by tests, to have the code for older processors run on newer ones.
bool is_held_back() { return std::getenv("PHOTON_MAPS_WITHOUT_AVX2") != nullptr; }

}  // namespace

const bool has_baseline = (features() & sse4_2) != 0 && (features() & popcnt) != 0;
const bool has_avx2 = saves_vectors() && (more_features() & avx2) != 0 && !is_held_back();

}  // namespace photon_maps

#endif
