// SPDX-License-Identifier: GPL-3.0-or-later
#include "processor.h"

#if defined(__x86_64__)

#include <cpuid.h>

#include <cstdint>
#include <cstdlib>

namespace photon_maps {

namespace {

// Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2, CPUID, and volume 1, section 14.3.
// AVX-512: volume 1, section 15.2.
constexpr uint32_t sse4_2 = 1u << 20, popcnt = 1u << 23, os_saves = 1u << 27;  // leaf 1, ecx
constexpr uint32_t avx2 = 1u << 5;                                             // leaf 7, ebx
constexpr uint32_t avx512 = 1u << 16 | 1u << 31;                               // F and VL; leaf 7, ebx
constexpr uint32_t vector_registers = 0x06;                                    // of 128 and 256 bits, in XCR0
constexpr uint32_t avx512_registers = 0xe0;                                    // masks, and what it adds to vectors

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

bool saves(uint32_t registers) { return (features() & os_saves) != 0 && (saved_registers() & registers) == registers; }

bool has(uint32_t wanted) { return (more_features() & wanted) == wanted; }

/// Set by tests, to have the code for older processors run on newer ones.
bool is_held_back(const char *variable) { return std::getenv(variable) != nullptr; }

}  // namespace

const bool has_baseline = (features() & sse4_2) != 0 && (features() & popcnt) != 0;
const bool has_avx2 = saves(vector_registers) && has(avx2) && !is_held_back("PHOTON_MAPS_WITHOUT_AVX2");
const bool has_avx512 = has_avx2 && saves(vector_registers | avx512_registers) && has(avx512) &&
                        !is_held_back("PHOTON_MAPS_WITHOUT_AVX512");

}  // namespace photon_maps

#endif
