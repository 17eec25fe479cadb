// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace photon_maps {

namespace {

/// Means over the first passes of the squared radius, and of its inverse, over that of the first: by the gamma function
/// r^2 goes as (pass + 1)^(-1/3) / gamma(5/3) (Knaus and Zwicker 2011, equation 21 with alpha = 2/3).
double mean_squared_radius(double passes) { return 1.66 / std::cbrt(passes) - 0.66 / passes; }
double mean_inverse_squared_radius(double passes) { return 0.68 * std::cbrt(passes) + 0.32 / passes; }

/// The variance of a pass's light where its random numbers are stratified over so many passes, over what the halves of
/// the pilot passes tell, if that of the mean of n passes goes as n^-power. A quarter of the halves' squared difference
/// is V(2) - V(4) (as of ErrorEstimate::compare_halves). What more bounces bring goes as n^-1.1, and is taken as n^-1.
double stratified(double passes, double power) {
    constexpr double most = 1 << 12;  // what is out of reach by then is so for other reasons
    const double doubling = std::exp2(-power);
    return doubling / (1 - doubling) * std::pow(PilotNoise::passes / std::min(passes, most), power - 1);
}

/// Parts of a picture's squared error, as of one pass.
struct SquaredError {
    double seen;         ///< noise of what the eye sees without diffuse bounces
    double power;        ///< by which passes stratify that
    double independent;  ///< noise of what neither passes stratify nor radii change
    double photons;
    /// By the kernels' width, taken to go with their squared radius: it goes with the power 2 of that where light is
    /// smooth and 1/2 at its edges; in seven scenes between the pilots' radius and half of it with 0.8 to 1.7.
    double blur;
    double lack;

    /// That of each of so many passes.
    double noise(double passes, bool shrinks) const {
        return seen * stratified(passes, power) + independent +
               photons * (shrinks ? mean_inverse_squared_radius(passes) : 1);
    }
    /// That of their mean.
    double after(double passes, bool shrinks) const {
        return noise(passes, shrinks) / passes + blur * (shrinks ? mean_squared_radius(passes) : 1) + lack;
    }
};

/// @param global, caustic photons of a pass, 0 where there is no such map
/// @param radius over that of the pilot passes
SquaredError squared_error(const PilotNoise &noise, double global, double caustic, double radius) {
    SquaredError squared{.seen = noise.camera_variance - noise.path_variance,
                         .power = noise.stratification,
                         .independent = noise.path_variance,
                         .photons = 0,
                         .blur = noise.caustic.blur,
                         .lack = noise.lack};
    if (global > 0) {
        const double area = radius * radius, share = noise.global.count / global;
        squared.independent += noise.global.flux_variance * share;
        squared.photons += (noise.global.variance - noise.global.flux_variance) * share / area;
        squared.blur += noise.global.blur * area;
    }
    if (caustic > 0) squared.photons += noise.caustic.variance * noise.caustic.count / caustic;
    return squared;
}

/// Of a pass, in rays.
/// @param global, caustic, radius as of squared_error()
double pass_cost(const PilotNoise &noise, double global, double caustic, double radius) {
    const double gathered = global > 0 ? global / noise.global.count * radius * radius : 0;
    return noise.pixel_cost + global * noise.global.cost + caustic * noise.caustic.cost + noise.gather_cost * gathered;
}

/// Passes until the error is small enough; infinitely many where they are surely more than a limit.
double passes_needed(const SquaredError &squared, double error, bool shrinks, double limit) {
    constexpr double fewest = PilotNoise::passes, most = 1 << 16;
    if (limit < fewest || (limit < most && squared.after(limit, shrinks) > error * error))
        return std::numeric_limits<double>::infinity();
    double low = fewest, high = most;
    const double first = squared.after(low, shrinks);
    if (!std::isfinite(first)) return std::numeric_limits<double>::infinity();
    if (first <= error * error) return low;
    // What is out of reach is the further out of it the more error is left.
    const double left = squared.after(most, shrinks);
    if (left > error * error) return most * left / (error * error);
    constexpr int halvings = 24;
    for (int i = 0; i < halvings; ++i) {
        const double middle = std::sqrt(low * high);
        (squared.after(middle, shrinks) > error * error ? low : high) = middle;
    }
    return high;
}

/// Chooses photons and radius.
Plan plan_photons(const PilotNoise &noise, double error, bool shrinks) {
    const auto counts_of = [&](const MapNoise &map) {
        // Fewer would cost no less: a pass of a small picture has other things to do. More would hardly gain anything
        // but longer passes: of photons alone twice as many do in one pass what as many do in two. 2^10 ... 2^23.
        constexpr int fewest = 10, most = 23, steps = 2;
        constexpr double most_work = 8;  // over that of the cameras' paths
        std::vector<double> counts;
        if (map.count == 0) return std::vector<double>{0};
        for (int i = fewest * steps; i <= most * steps; ++i) {
            const double count = std::exp2(static_cast<double>(i) / steps);
            if (!counts.empty() && count * map.cost > most_work * noise.pixel_cost) break;
            counts.push_back(count);
        }
        return counts;
    };
    const std::vector<double> radii =
        noise.global.count > 0
            ? std::vector<double>{1.19, 1, 0.84, 0.71, 0.59, 0.5, 0.42, 0.35, 0.3, 0.25, 0.21, 0.18, 0.15, 0.125}
            : std::vector<double>{1};
    Plan best;
    for (const double global : counts_of(noise.global))
        for (const double caustic : counts_of(noise.caustic))
            for (const double radius : radii) {
                const double cost = pass_cost(noise, global, caustic, radius);
                const SquaredError squared = squared_error(noise, global, caustic, radius);
                const double passes = passes_needed(squared, error, shrinks, best.cost / cost);
                if (cost * passes >= best.cost) continue;
                best = {.counts = {static_cast<uint64_t>(global), static_cast<uint64_t>(caustic)},
                        .global_radius = static_cast<float>(radius),
                        .passes = passes,
                        .cost = cost * passes};
            }
    return best;
}

/// So many light samples of a pass that variance times cost is least.
/// @param plan with one of them
uint32_t light_samples_for(const PilotNoise &noise, const Plan &plan, bool shrinks) {
    constexpr double most = 16;
    const auto global = static_cast<double>(plan.counts.global), caustic = static_cast<double>(plan.counts.caustic);
    const SquaredError squared = squared_error(noise, global, caustic, double{plan.global_radius});
    const double direct = noise.direct_variance * stratified(plan.passes, noise.stratification);
    const double other = squared.noise(plan.passes, shrinks) - direct;
    // With k samples: (other + direct / k) * (rest + k * light_cost).
    const double rest = pass_cost(noise, global, caustic, double{plan.global_radius}) - noise.light_cost;
    if (noise.light_cost == 0 || direct == 0) return 1;
    const double best = std::sqrt(direct * std::max(rest, 0.0) / (std::max(other, 1e-12) * noise.light_cost));
    return static_cast<uint32_t>(std::clamp(std::round(best), 1.0, most));
}

}  // namespace

PilotNoise PilotNoise::with_light_samples(uint32_t count) const {
    PilotNoise noise = *this;
    noise.camera_variance -= direct_variance * (1 - 1.0 / count);
    noise.direct_variance /= count;
    noise.pixel_cost += (count - 1) * light_cost;
    return noise;
}

Plan plan_for(const PilotNoise &noise, double error, bool shrinks) {
    const Plan with_one = plan_photons(noise, error, shrinks);
    const uint32_t count = light_samples_for(noise, with_one, shrinks);
    if (count == 1) return with_one;
    Plan with_more = plan_photons(noise.with_light_samples(count), error, shrinks);
    with_more.light_samples = count;
    return with_more.cost < with_one.cost ? with_more : with_one;
}

}  // namespace photon_maps
