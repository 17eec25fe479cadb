// SPDX-License-Identifier: GPL-3.0-or-later
// What the processor is said to offer is what the compiler's own runtime says of it, less what it is to go without.
#include <cstdlib>

#include "check.h"
#include "processor.h"

int main() {
    photon_maps::test::Checks checks;
#if defined(__x86_64__)
    const bool is_held_back = std::getenv("PHOTON_MAPS_WITHOUT_AVX2") != nullptr;
    checks.that(photon_maps::has_baseline, "SSE4.2 and POPCNT");
    checks.that(photon_maps::has_avx2 == (__builtin_cpu_supports("avx2") != 0 && !is_held_back), "AVX2");
#else
    checks.that(true, "there is one level");
#endif
    return checks.report();
}
