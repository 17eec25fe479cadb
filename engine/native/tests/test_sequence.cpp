// SPDX-License-Identifier: GPL-3.0-or-later
// The low-discrepancy points: stratified as Sobol points are, and independent between seeds.
#include <string>
#include <vector>

#include "check.h"
#include "sequence.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

constexpr uint32_t exponent = 8;
constexpr uint32_t count = 1 << exponent;

/// A run of points that starts at a multiple of its length, and so is stratified on its own.
std::vector<std::array<float, 4>> points(uint64_t first, uint32_t seed) {
    std::vector<std::array<float, 4>> result;
    for (uint64_t i = 0; i < count; ++i) result.push_back(sobol4(first + i, seed));
    return result;
}

/// Every interval of a dimension that can hold one point holds one.
void test_dimensions_are_stratified(Checks &checks, uint64_t first, uint32_t seed) {
    for (size_t dimension = 0; dimension < 4; ++dimension) {
        std::vector<int> held(count, 0);
        for (const auto &point : points(first, seed)) ++held[static_cast<size_t>(point[dimension] * count)];
        for (const int number : held) checks.that(number == 1, "dimension " + std::to_string(dimension));
    }
}

/// Every elementary box of the first two dimensions that can hold one point holds one: a (0, m, 2)-net.
void test_first_two_dimensions_are_a_net(Checks &checks, uint64_t first, uint32_t seed) {
    for (uint32_t columns = 0; columns <= exponent; ++columns) {
        const uint32_t width = 1u << columns, height = count >> columns;
        std::vector<int> held(count, 0);
        for (const auto &point : points(first, seed)) {
            const auto x = static_cast<size_t>(point[0] * static_cast<float>(width));
            const auto y = static_cast<size_t>(point[1] * static_cast<float>(height));
            ++held[x + width * y];
        }
        for (const int number : held) checks.that(number == 1, "boxes of " + std::to_string(width) + " columns");
    }
}

/// Correlation of two seeds, and of two groups of one sequence: three standard deviations of random numbers.
void test_seeds_and_groups_are_independent(Checks &checks) {
    constexpr uint64_t many = 1 << 14;
    const double bound = 3 / std::sqrt(static_cast<double>(many));
    double seeds = 0, groups = 0;
    for (uint64_t i = 0; i < many; ++i) {
        const auto centred = [](float v) { return (static_cast<double>(v) - 0.5) * std::sqrt(12.0); };
        seeds += centred(sobol4(i, 1)[0]) * centred(sobol4(i, 2)[0]);
        Sequence sequence(i, 7);
        const auto first = sequence.next(), second = sequence.next();
        groups += centred(first[0]) * centred(second[0]);
    }
    checks.near(seeds / many, 0, bound, "seeds");
    checks.near(groups / many, 0, bound, "groups");
}

void test_numbers_are_in_the_unit_interval(Checks &checks) {
    for (uint64_t i = 0; i < 100000; ++i) {
        for (const float v : sobol4(i * 0x10001, static_cast<uint32_t>(i)))
            checks.that(v >= 0 && v < 1, "in the unit interval");
    }
}

}  // namespace

int main() {
    Checks checks;
    for (const uint32_t seed : {0u, 1u, 0xdeadbeefu}) {
        for (const uint64_t first : {uint64_t{0}, uint64_t{3} * count, uint64_t{1} << 32, uint64_t{5} << 40}) {
            test_dimensions_are_stratified(checks, first, seed);
            test_first_two_dimensions_are_a_net(checks, first, seed);
        }
    }
    test_seeds_and_groups_are_independent(checks);
    test_numbers_are_in_the_unit_interval(checks);
    return checks.report();
}
