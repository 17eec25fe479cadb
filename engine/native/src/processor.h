// SPDX-License-Identifier: GPL-3.0-or-later
// What the processor offers, asked of itself: the compilers' own runtimes do not all tell the truth when one builds for
// another platform.
#pragma once

namespace photon_maps {

#if defined(__x86_64__)
/// Whether it has what the library is compiled for (x86-64-v2: SSE4.2 and POPCNT).
extern const bool has_baseline;
/// Whether it has AVX2, the operating system keeps the registers of it, and PHOTON_MAPS_WITHOUT_AVX2 is not set.
extern const bool has_avx2;
/// Whether it has AVX2 as above and AVX-512 for 256-bit vectors, the operating system keeps the registers of it, and
/// PHOTON_MAPS_WITHOUT_AVX512 is not set. macOS keeps them only once they are used: there it is false.
extern const bool has_avx512;
#endif

}  // namespace photon_maps
