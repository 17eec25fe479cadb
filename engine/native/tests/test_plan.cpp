// SPDX-License-Identifier: GPL-3.0-or-later
// What plans make of pilot passes, where the best split is known.
#include "check.h"
#include "plan.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

/// Pilot passes of a diffuse room: 10 % of noise a pass by the camera, as much by 8192 photons.
PilotNoise room() {
    PilotNoise noise;
    noise.camera_variance = 0.01;
    noise.global = {.variance = 0.01, .flux_variance = 0, .blur = 1e-7, .count = 8192, .cost = 2};
    noise.pixel_cost = 200'000;
    noise.gather_cost = 1'000;
    return noise;
}

/// Error squared of so many photons after as many passes as a cost affords, without blur or shrinking.
double squared_error(const PilotNoise &noise, double photons, double cost) {
    const double pass = noise.pixel_cost + photons * noise.global.cost;
    return (noise.camera_variance + noise.global.variance * noise.global.count / photons) * pass / cost;
}

void check_split(Checks &checks) {
    // Neyman's allocation: effort in proportion to the root of variance by cost.
    PilotNoise noise = room();
    noise.path_variance = noise.camera_variance;  // passes do not stratify it
    noise.pixel_cost *= 16;
    const double best = std::sqrt(noise.global.variance * noise.global.count / noise.global.cost /
                                  (noise.camera_variance / noise.pixel_cost));
    const Plan plan = plan_for(noise, 0.005, false);
    const auto chosen = static_cast<double>(plan.counts.global);
    checks.that(squared_error(noise, chosen, 1) < 1.1 * squared_error(noise, best, 1), "photons by the best split");
    checks.that(plan.counts.caustic == 0, "no caustic map, no photons for it");

    // Light that the camera finds badly, such as one lamp of many, leaves less for photons, and the other way round.
    PilotNoise many_lamps = noise, dim_corners = noise;
    many_lamps.camera_variance = many_lamps.path_variance = 100 * noise.camera_variance;
    dim_corners.global.variance *= 25;
    checks.that(plan_for(many_lamps, 0.01, false).counts.global < plan.counts.global / 4, "camera noise");
    checks.that(plan_for(dim_corners, 0.01, false).counts.global > plan.counts.global * 3, "photon noise");
}

void check_passes(Checks &checks) {
    // Variance falls as 1 / n along paths, and as 1 / n^1.4 where passes stratify each other, from four passes on.
    PilotNoise paths;
    paths.camera_variance = paths.path_variance = 0.2;
    paths.pixel_cost = 1'000;
    PilotNoise seen = paths;
    seen.path_variance = 0;
    // A quarter of the squared difference of means over two passes each, times four, as pilots have it.
    const double halves = std::exp2(1.4) - 1;
    const double plain = 0.2 / 1e-4, stratified = std::pow(0.2 / halves * std::pow(4, 0.4) / 1e-4, 1 / 1.4);
    checks.near(plan_for(paths, 0.01, true).passes / plain, 1, 1e-3, "passes of paths");
    checks.near(plan_for(seen, 0.01, true).passes / stratified, 1, 1e-3, "stratified passes");
    checks.near(plan_for(seen, 0.01, true).cost / (1'000 * stratified), 1, 1e-3, "their cost");
    seen.stratification = 1;
    checks.near(plan_for(seen, 0.01, true).passes / plain, 1, 1e-3, "passes that stratify each other no better");
}

void check_radius(Checks &checks) {
    PilotNoise sharp = room(), blurred = room();
    sharp.global.blur = 1e-9;
    blurred.global.blur = 0.04 * 0.04;
    checks.that(plan_for(sharp, 0.02, true).global_radius > 1, "no blur, wider kernels");
    checks.that(plan_for(blurred, 0.01, true).global_radius < 0.8f, "blur beyond the error wants smaller kernels");
    checks.that(plan_for(blurred, 0.05, true).global_radius > plan_for(blurred, 0.005, true).global_radius,
                "the less error, the less blur");

    // Behind a narrow gap it is how many photons come at all that makes the noise: no kernel can be too narrow.
    PilotNoise gap = blurred;
    gap.global.flux_variance = gap.global.variance;
    checks.that(plan_for(gap, 0.01, true).global_radius < 0.2f, "noise of the flux wants small kernels");
    gap.camera_variance = gap.global.blur = 0;
    const Plan plan = plan_for(gap, 1e-3, true);
    const double each = gap.global.variance * gap.global.count / static_cast<double>(plan.counts.global);
    checks.near(plan.passes * 1e-6 / each, 1, 1e-3, "noise of the flux falls as that of independent passes");
}

void check_bounds(Checks &checks) {
    PilotNoise quiet = room();
    quiet.global.variance = quiet.camera_variance = 0;
    checks.that(plan_for(quiet, 0.02, true).counts.global == 1 << 10, "nothing to gain, fewest photons");
    PilotNoise hopeless = room();
    hopeless.camera_variance = 1e12;
    const Plan still = plan_for(hopeless, 1e-4, true);
    checks.that(still.counts.global > 0 && std::isfinite(still.cost), "out of reach, still a plan");
    PilotNoise dim = room();
    dim.global.variance = dim.global.flux_variance = 1e6;
    const double work = static_cast<double>(plan_for(dim, 0.02, true).counts.global) * dim.global.cost;
    checks.that(work > 4 * dim.pixel_cost && work <= 8 * dim.pixel_cost, "hopelessly dim, passes stay short");
    for (const double beyond : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        PilotNoise wild = room();
        wild.global.variance = wild.global.flux_variance = beyond;
        checks.that(!std::isfinite(plan_for(wild, 0.02, true).cost), "noise beyond all numbers is no plan");
    }
    PilotNoise lacking = room();
    lacking.lack = 0.03 * 0.03;
    checks.that(plan_for(lacking, 0.02, true).cost > 100 * plan_for(room(), 0.02, true).cost, "light that never comes");
    PilotNoise caustic;
    caustic.camera_variance = 0.01;
    caustic.caustic = {.variance = 0.01, .flux_variance = 0, .blur = 0, .count = 8192, .cost = 3};
    caustic.pixel_cost = 200'000;
    const Plan plan = plan_for(caustic, 0.01, true);
    checks.that(plan.counts.global == 0 && plan.counts.caustic > 8192, "caustics alone");
}

}  // namespace

int main() {
    Checks checks;
    check_split(checks);
    check_passes(checks);
    check_radius(checks);
    check_bounds(checks);
    return checks.report();
}
