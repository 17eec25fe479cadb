// SPDX-License-Identifier: GPL-3.0-or-later
// What pilot passes tell of something they have in common, where it and their noise are known.
#include <cmath>
#include <random>

#include "check.h"
#include "pilot_pixels.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

constexpr uint32_t passes = PilotNoise::passes;
using Found = std::array<double, passes>;

/// The products of what passes found in so many places; places have nothing in common but the mean.
PassProducts products_of(double common, double deviation, uint32_t places, std::mt19937 &random) {
    std::normal_distribution<double> noise(0, deviation);
    PassProducts products{};
    for (uint32_t place = 0; place < places; ++place) {
        Found found;
        for (double &each : found) each = common + noise(random);
        for (uint32_t a = 0; a < passes; ++a)
            for (uint32_t b = 0; b < passes; ++b) products[a][b] += found[a] * found[b] / places;
    }
    return products;
}

/// Mean of what is expected over many sets of passes.
double mean_expected(double common, double deviation, uint32_t places) {
    std::mt19937 random(1);
    constexpr int sets = 400;
    double sum = 0;
    for (int i = 0; i < sets; ++i) sum += expected_square(products_of(common, deviation, places, random)) / sets;
    return sum;
}

void check_common(Checks &checks) {
    for (const double common : {0.01, 0.013, 0.019, 0.05}) {
        checks.near(mean_expected(common, 0, 1) / (common * common), 1, 1e-9, "without noise it is what is found");
        checks.near(mean_expected(common, common / 10, 10) / (common * common), 1, 0.02, "little noise");
        checks.near(mean_expected(common, common, 100) / (common * common), 1, 0.05,
                    "noise that many places take away");
        checks.near(mean_expected(common, common / 5, 1) / (common * common), 1, 0.1, "noise that all places share");
    }
}

void check_noise(Checks &checks) {
    // Squares of noise are no square of something in common.
    checks.that(mean_expected(0, 0.02, 1) < 0.6 * 0.02 * 0.02, "noise alone");
    checks.that(mean_expected(0, 0.02, 100) < 0.06 * 0.02 * 0.02, "noise of many places");
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i)
        checks.that(expected_square(products_of(0, 0.02, 1, random)) > 1e-3 * 0.02 * 0.02, "what noise may hide");
    checks.that(expected_square({}) == 0, "nothing at all");
}

}  // namespace

int main() {
    Checks checks;
    check_common(checks);
    check_noise(checks);
    return checks.report();
}
