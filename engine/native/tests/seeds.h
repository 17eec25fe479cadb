// SPDX-License-Identifier: GPL-3.0-or-later
// Random tests by their seeds.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>

namespace photon_maps::test {

/// Calls a test with a thousand seeds from the first argument on; or, where there is a second one, for so many seconds.
/// @return how many seeds there were
template <class Test>
uint32_t try_seeds(int argc, char **argv, Test test) {
    constexpr uint32_t usual = 1000;
    const uint32_t first = argc > 1 ? static_cast<uint32_t>(std::strtoul(argv[1], nullptr, 10)) : 1;
    const double seconds = argc > 2 ? std::strtod(argv[2], nullptr) : 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    uint32_t count = 0;
    for (; seconds > 0 ? std::chrono::steady_clock::now() < end : count < usual; ++count) test(first + count);
    std::cerr << count << " seeds from " << first << '\n';
    return count;
}

}  // namespace photon_maps::test
