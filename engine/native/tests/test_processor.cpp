// SPDX-License-Identifier: GPL-3.0-or-later
// What the processor is said to offer is what the compiler's own runtime says of it, less what it is to go without.
#include <cstdlib>

#include "check.h"
#include "processor.h"

namespace {

bool is_held_back(const char *variable) { return std::getenv(variable) != nullptr; }

}  // namespace

int main() {
    photon_maps::test::Checks checks;
#if defined(__x86_64__)
    const bool avx2 = __builtin_cpu_supports("avx2") != 0 && !is_held_back("PHOTON_MAPS_WITHOUT_AVX2");
    const bool avx512 = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
                        !is_held_back("PHOTON_MAPS_WITHOUT_AVX512");
    checks.that(photon_maps::has_baseline, "SSE4.2 and POPCNT");
    checks.that(photon_maps::has_avx2 == avx2, "AVX2");
    checks.that(photon_maps::has_avx512 == (avx2 && avx512), "AVX-512");
#else
    checks.that(true, "there is one level");
#endif
    return checks.report();
}
