// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan.h"

#include <numbers>
#include <numeric>

#include "parallel.h"
#include "relative_error.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t watched_pixels = 1024;

/// Means over the first passes of the squared radius, and of its inverse, over that of the first: by the gamma function
/// r^2 goes as (pass + 1)^(-1/3) / gamma(5/3) (Knaus and Zwicker 2011, equation 21 with alpha = 2/3).
double mean_squared_radius(double passes) { return 1.66 / std::cbrt(passes) - 0.66 / passes; }
double mean_inverse_squared_radius(double passes) { return 0.68 * std::cbrt(passes) + 0.32 / passes; }

/// The variance of a pass's light where its random numbers are stratified over so many passes, over what the halves of
/// the pilot passes tell. With n samples at the edges of shadows and things the variance of their mean goes as n^-1.5,
/// elsewhere faster (Mitchell 1996); from 4 to 64 passes of ten scenes as n^-0.9 to n^-1.7. What more bounces bring
/// goes as n^-1.1, and is taken as n^-1. A quarter of the halves' squared difference is V(2) - V(4) (as of
/// ErrorEstimate::compare_halves).
double stratified(double passes) {
    constexpr double power = 1.4;
    constexpr double most = 1 << 12;  // what is out of reach by then is so for other reasons
    const double doubling = std::exp2(-power);
    return doubling / (1 - doubling) * std::pow(PilotPixels::passes / std::min(passes, most), power - 1);
}

/// Parts of a picture's squared error, as of one pass.
struct SquaredError {
    double seen;  ///< noise of what the eye sees without diffuse bounces
    double paths, photons;
    /// By the kernels' width, taken to go with their squared radius: it goes with the power 2 of that where light is
    /// smooth and 1/2 at its edges; between the radii of a plan with 1.1 to 1.6 behind a narrow gap, 0.5 to 0.75 in
    /// rooms.
    double blur;
    double lack;

    double after(double passes, bool shrinks) const {
        const double shrunk = shrinks ? mean_squared_radius(passes) : 1;
        const double inverse = shrinks ? mean_inverse_squared_radius(passes) : 1;
        const double noise = seen * stratified(passes) + paths + photons * inverse;
        return noise / passes + blur * shrunk + lack;
    }
};

/// Passes until the error is small enough.
double passes_needed(const SquaredError &squared, double error, bool shrinks) {
    constexpr double fewest = PilotPixels::passes, most = 1 << 16;
    double low = fewest, high = most;
    if (squared.after(low, shrinks) <= error * error) return low;
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

/// Mean of what is normally distributed and known to be positive (of the truncated normal distribution).
/// @param center, deviation of the distribution, as it would be if it could be negative
double mean_above_zero(double center, double deviation) {
    if (deviation == 0) return std::max(center, 0.0);
    const double z = std::max(center / deviation, -5.0);  // below, the quotient is lost in rounding
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    return deviation * (z + density / (std::erfc(-z * std::numbers::sqrt2 / 2) / 2));
}

/// Chooses photons and radius.
Plan plan_photons(const PilotNoise &noise, double error, bool shrinks) {
    const auto counts_of = [](const MapNoise &map) {
        // Fewer would cost no less: a pass of a small picture has other things to do. 2^10 ... 2^23.
        constexpr int fewest = 10, most = 23, steps = 2;
        std::vector<double> counts;
        if (map.count == 0) return std::vector<double>{0};
        for (int i = fewest * steps; i <= most * steps; ++i)
            counts.push_back(std::exp2(static_cast<double>(i) / steps));
        return counts;
    };
    const std::vector<double> radii =
        noise.global.count > 0 ? std::vector<double>{1.68, 1.41, 1.19, 1, 0.84, 0.71, 0.59, 0.5, 0.42, 0.35, 0.3, 0.25}
                               : std::vector<double>{1};
    Plan best;
    for (const double global : counts_of(noise.global))
        for (const double caustic : counts_of(noise.caustic))
            for (const double radius : radii) {
                const double area = radius * radius;
                SquaredError squared{.seen = noise.camera_variance - noise.path_variance,
                                     .paths = noise.path_variance,
                                     .photons = 0,
                                     .blur = noise.caustic.blur,
                                     .lack = noise.lack};
                double cost = noise.pixel_cost;
                if (global > 0) {
                    squared.photons += noise.global.variance * noise.global.count / global / area;
                    squared.blur += noise.global.blur * area;
                    cost += global * noise.global.cost + noise.gather_cost * global / noise.global.count * area;
                }
                if (caustic > 0) {
                    squared.photons += noise.caustic.variance * noise.caustic.count / caustic;
                    cost += caustic * noise.caustic.cost;
                }
                const double passes = passes_needed(squared, error, shrinks);
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
    const PhotonCounts &counts = plan.counts;
    const double area = double{plan.global_radius} * double{plan.global_radius};
    const auto photons = [](const MapNoise &map, uint64_t count) {
        return count > 0 ? map.variance * map.count / static_cast<double>(count) : 0;
    };
    const auto traced = [](const MapNoise &map, uint64_t count) { return map.cost * static_cast<double>(count); };
    const double shrink = stratified(plan.passes);
    const double direct = noise.direct_variance * shrink;
    const double inverse = shrinks ? mean_inverse_squared_radius(plan.passes) : 1;
    const double other =
        (noise.camera_variance - noise.path_variance) * shrink - direct + noise.path_variance +
        (photons(noise.global, counts.global) / area + photons(noise.caustic, counts.caustic)) * inverse;
    const double cost = noise.pixel_cost + traced(noise.global, counts.global) + traced(noise.caustic, counts.caustic);
    // With k samples: (other + direct / k) * (cost + k * light_cost).
    if (noise.light_cost == 0 || direct == 0) return 1;
    const double best = std::sqrt(direct * cost / (std::max(other, 1e-12) * noise.light_cost));
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

PilotPixels::PilotPixels(const Camera &camera, bool is_nested) : is_nested_(is_nested) {
    const uint64_t all = uint64_t{camera.frame_width} * camera.frame_height;
    const auto count = static_cast<uint32_t>(std::min<uint64_t>(watched_pixels, all));
    for (uint32_t i = 0; i < count; ++i) {
        const auto u = sobol4(i, 0);
        Pixel &pixel = pixels_.emplace_back();
        pixel.x = static_cast<uint32_t>(u[0] * static_cast<float>(camera.frame_width));
        pixel.y = static_cast<uint32_t>(u[1] * static_cast<float>(camera.frame_height));
    }
}

void PilotPixels::add(const CameraPass &pass, const std::atomic<bool> *cancel) {
    const bool is_first_half = added_ < passes / 2;
    std::vector<RayCounts> counts(pixels_.size());
    std::vector<float> caustics(pixels_.size()), indirect(pixels_.size());
    parallel_for(pass.threads, pixels_.size(), cancel, [&](size_t i) {
        Pixel &pixel = pixels_[i];
        Levels levels;
        const PixelSample sample =
            render_pixel(pass, pixel.x, pixel.y, true, counts[i], is_nested_ ? &levels : nullptr);
        pixel.radiance[added_] = sample.radiance();
        caustics[i] = average(sample.caustic);
        indirect[i] = average(sample.soft_indirect);
        pixel.global.add(sample.global.radiance, is_first_half);
        pixel.caustic.add(sample.caustic_map.radiance, is_first_half);
        pixel.camera.add(sample.radiance() - sample.global.radiance - sample.caustic_map.radiance, is_first_half);
        pixel.direct.add(sample.direct, is_first_half);
        pixel.global_blur.add(sample.global.blur, is_first_half);
        pixel.caustic_blur.add(sample.caustic_map.blur, is_first_half);
    });
    for (size_t i = 0; i < pixels_.size(); ++i) {
        caustics_.add(caustics[i]);
        indirect_.add(indirect[i]);
        counts_ += counts[i];
    }
    ++added_;
}

void PilotPixels::find_noise(PilotNoise &noise) const {
    const std::vector<Vec3> means = this->means();
    constexpr auto count = static_cast<float>(passes);
    const float floor = squared_floor(means);
    const auto mean_over_pixels = [&](auto squared, size_t largest = 1000) {
        std::vector<float> squares;
        for (size_t i = 0; i < pixels_.size(); ++i)
            squares.push_back(relative_square(squared(pixels_[i]), means[i], floor));
        return double{trimmed_mean(squares, largest)};
    };
    const auto variance = [&](Moments Pixel::*part) {
        return mean_over_pixels([&](const Pixel &p) { return (p.*part).difference * (p.*part).difference / count; });
    };
    // Expected from a difference that noise may have brought about as well: of a kernel to one of a quarter of its
    // area. Few pixels are watched, and one of a sharp corner must not stand for a thousandth of the picture.
    constexpr size_t worst = 100;
    constexpr double of_difference = 4;  // where the error goes with the radius, it is twice what half of it takes away
    const auto blur = [&](Moments Pixel::*part) {
        const double difference = mean_over_pixels(
            [&](const Pixel &p) {
                const Vec3 mean = (p.*part).sum / count;
                return mean * mean - variance_of_mean((p.*part).sum, (p.*part).squares, passes);
            },
            worst);
        const double doubt = variance(part) / count * std::sqrt(2.0 / static_cast<double>(pixels_.size()));
        return of_difference * mean_above_zero(difference, doubt);
    };
    noise.camera_variance = variance(&Pixel::camera);
    noise.direct_variance = std::min(variance(&Pixel::direct), noise.camera_variance);
    noise.global.variance = variance(&Pixel::global);
    noise.caustic.variance = variance(&Pixel::caustic);
    noise.global.blur = blur(&Pixel::global_blur);
    noise.caustic.blur = blur(&Pixel::caustic_blur);
}

double PilotPixels::pixel_cost() const {
    constexpr double estimate_cost = 2.5;
    return per_pixel(counts_.rays) + estimate_cost * per_pixel(counts_.estimates);
}

double PilotPixels::hidden_variance(RareLight light, const PilotPixels &photons) const {
    // How much of a pixel's radiance it is.
    const Moments Pixel::*part = light == RareLight::caustics ? &Pixel::caustic : &Pixel::global;
    const std::vector<Vec3> means = photons.means();
    const float floor = squared_floor(means);
    double share = 0;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const Vec3 mean = (photons.pixels_[i].*part).sum / static_cast<float>(passes);
        share += std::sqrt(relative_square(mean * mean, means[i], floor));
    }
    share /= static_cast<double>(pixels_.size());

    // By how few samples it comes at the least: what comes with probability p has a variance of about its square over
    // p.
    const double came = (light == RareLight::caustics ? caustics_ : indirect_).count();
    const double fewest = std::max(1.0, came - 2 * std::sqrt(came));
    return share * share * static_cast<double>(pixels_.size() * passes) / fewest;
}

std::vector<Vec3> PilotPixels::means() const {
    std::vector<Vec3> means;
    for (const Pixel &p : pixels_)
        means.push_back(std::accumulate(p.radiance.begin(), p.radiance.end(), Vec3{}) / static_cast<float>(passes));
    return means;
}

double PilotPixels::squared_lack(const PilotPixels &other) const {
    const std::vector<Vec3> means = other.means();
    const float floor = squared_floor(means);
    double sum = 0, squares = 0;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        double of_pass = 0;
        for (size_t i = 0; i < pixels_.size(); ++i) {
            const float difference = average(other.pixels_[i].radiance[pass] - pixels_[i].radiance[pass]);
            const float square = difference * difference;
            of_pass += std::copysign(std::sqrt(relative_square({square, square, square}, means[i], floor)), difference);
        }
        of_pass /= static_cast<double>(pixels_.size());
        sum += of_pass;
        squares += of_pass * of_pass;
    }
    // Pixels share their photons: only passes are independent. Student's t for four of them, 95 %.
    constexpr double t = 3.18;
    const double mean = sum / passes, variance = (squares / passes - mean * mean) / (passes - 1);
    return mean > 0 ? std::max(0.0, mean * mean - t * t * variance) : 0;
}

}  // namespace photon_maps
