// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels against their definitions and against numeric integration.
#include <string>

#include "check.h"
#include "filter.h"
#include "published_kernels.h"

using namespace photon_maps;

namespace {

/// The integral of w(rho) rho drho from 0 to s, by the midpoint rule.
double integral(const Kernel &kernel, double s) {
    constexpr int steps = 20000;
    const double r = kernel.radius, width = s / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double rho = (i + 0.5) * width;
        sum += test::published_weight(kernel, rho * rho / (r * r)) * rho * width;
    }
    return sum;
}

}  // namespace

int main() {
    test::Checks checks;
    for (const pm_filter filter : {PM_FILTER_NONE, PM_FILTER_CONE, PM_FILTER_GAUSSIAN, PM_FILTER_EPANECHNIKOV}) {
        for (const float radius : {1e-4f, 0.3f, 1.0f, 1e4f}) {
            for (const float cone_k : {1.0f, 1.1f, 3.0f}) {
                const Kernel kernel{filter, radius, cone_k};
                const std::string name = "filter " + std::to_string(filter);
                for (float t = 0; t <= 1; t += 0.0625f) {
                    const Float8 weights = kernel.weights(broadcast(t));
                    for (size_t lane = 0; lane < lanes; ++lane) {
                        checks.near(double{weights[lane]}, test::published_weight(kernel, double{t}), 3e-7,
                                    name + " weight");
                    }
                    const float s = radius * std::sqrt(t);
                    const double expected = integral(kernel, double{s});
                    checks.near(double{kernel.wedge(s)}, expected, 2e-6 * expected, name + " wedge");
                }
                const double expected = 2 * std::numbers::pi * integral(kernel, double{radius});
                checks.near(double{kernel.norm()}, expected, 2e-6 * expected, name + " norm");
            }
        }
    }
    checks.near(double{Kernel{PM_FILTER_CONE, 2, 1.5f}.norm()}, std::numbers::pi * 4 * (1 - 2 / 4.5), 1e-5,
                "cone norm");
    checks.near(double{Kernel{PM_FILTER_EPANECHNIKOV, 2, 1}.norm()}, std::numbers::pi * 2, 1e-5, "Epanechnikov norm");
    return checks.report();
}
