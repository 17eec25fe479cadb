// SPDX-License-Identifier: GPL-3.0-or-later
#include "pilot_pixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.h"
#include "relative_error.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t watched_pixels = 1024;

}  // namespace

double expected_square(const PassProducts &products) {
    constexpr uint32_t n = PilotNoise::passes;
    constexpr double pairs = n * (n - 1) / 2;

    // The mean of all pairs, and how far it is to be trusted. Let q be its variance by the noise of one pass times what
    // is common, and r the variance of a product by the noise of both passes. Then pairs have the variance 1.2 q + r,
    // the means of each pass's three pairs (4 q + 2 r) / 9, and the mean of all q + r / 6.
    double sum = 0, squares = 0, squares_of_passes = 0;
    for (uint32_t a = 0; a < n; ++a) {
        double of_pass = 0;
        for (uint32_t b = 0; b < n; ++b)
            if (b != a) of_pass += products[a][b];
        sum += of_pass / 2;
        squares_of_passes += of_pass * of_pass / ((n - 1) * (n - 1));
        for (uint32_t b = a + 1; b < n; ++b) squares += products[a][b] * products[a][b];
    }
    const double mean = sum / pairs;
    const double of_pairs = (squares - pairs * mean * mean) / (pairs - 1);
    const double of_passes = (squares_of_passes - n * mean * mean) / (n - 1);
    const double either = std::max(0.0, (9 * of_passes - 2 * of_pairs) / 1.6);
    const double variance = std::max(0.0, of_pairs - 1.2 * either) / pairs + either;

    // Not even its order is known before: all are as likely. A thousandth of the radiance does not show;
    // an eighth is more than kernels of the engine's choice err by.
    constexpr int least = -20, most = -6, steps = 8;
    double expected = 0, weights = 0;
    for (int step = least * steps; step <= most * steps && variance > 0; ++step) {
        const double square = std::exp2(static_cast<double>(step) / steps), off = mean - square;
        const double weight = std::exp(-off * off / (2 * variance));
        expected += weight * square;
        weights += weight;
    }
    return weights > 0 ? expected / weights : std::max(mean, 0.0);  // of what is measured well
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
        pixel.narrow.add(sample.global.radiance - sample.global.blur, is_first_half);
        pixel.caustic.add(sample.caustic_map.radiance, is_first_half);
        pixel.camera_light[added_] = sample.radiance() - sample.global.radiance - sample.caustic_map.radiance;
        pixel.camera.add(pixel.camera_light[added_], is_first_half);
        pixel.direct.add(sample.direct, is_first_half);
        pixel.global_blur[added_] = sample.global.blur;
        pixel.caustic_blur[added_] = sample.caustic_map.blur;
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
    const auto variance = [&](Moments Pixel::*part) {
        std::vector<float> squares;
        for (size_t i = 0; i < pixels_.size(); ++i) {
            const Vec3 difference = (pixels_[i].*part).difference;
            squares.push_back(relative_square(difference * difference / count, means[i], floor));
        }
        return double{trimmed_mean(squares)};
    };
    noise.camera_variance = variance(&Pixel::camera);
    noise.direct_variance = std::min(variance(&Pixel::direct), noise.camera_variance);
    noise.global.variance = variance(&Pixel::global);
    // A variance f + k / area, of which a quarter of the area has f + 4 k / area.
    noise.global.flux_variance =
        std::clamp((4 * noise.global.variance - variance(&Pixel::narrow)) / 3, 0.0, noise.global.variance);
    noise.caustic.variance = variance(&Pixel::caustic);
    noise.global.blur = squared_blur(&Pixel::global_blur, means, floor);
    noise.caustic.blur = squared_blur(&Pixel::caustic_blur, means, floor);
}

/// Returns the relative square of the error by the kernels' width.
/// @param part differences of a kernel to one of a quarter of its area
double PilotPixels::squared_blur(Passes Pixel::*part, std::span<const Vec3> means, float floor) const {
    constexpr double of_difference = 4;  // where the error goes with the radius, it is twice what half of it takes away
    const auto product = [&](size_t pixel, uint32_t a, uint32_t b) {
        const Passes &differences = pixels_[pixel].*part;
        return relative_square(differences[a] * differences[b], means[pixel], floor);
    };
    // Few pixels are watched, and one of a sharp corner must not stand for a thousandth of the picture: the worst
    // hundredth is left out. Which these are must not depend on the signs of noise.
    std::vector<std::pair<float, size_t>> pixels;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        float size = 0;
        for (uint32_t a = 0; a < passes; ++a) size += product(i, a, a);
        pixels.emplace_back(size, i);
    }
    std::ranges::sort(pixels);
    pixels.resize(pixels.size() - pixels.size() / 100);

    // Pixels share photons, so that their number does not tell how far a mean over them is to be trusted.
    PassProducts products{};
    for (uint32_t a = 0; a < passes; ++a)
        for (uint32_t b = a + 1; b < passes; ++b) {
            double sum = 0;
            for (const auto &[size, i] : pixels) sum += double{product(i, a, b)};
            products[a][b] = products[b][a] = sum / static_cast<double>(pixels.size());
        }
    return of_difference * expected_square(products);
}

double PilotPixels::stratification() const {
    // A quarter of the squared difference of two means is what the mean of both has less variance than either.
    const std::vector<Vec3> means = this->means();
    const float floor = squared_floor(means);
    std::vector<float> of_one, of_two;  // V(1) - V(2), V(2) - V(4)
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const Passes &light = pixels_[i].camera_light;
        const Vec3 first = light[0] - light[1], second = light[2] - light[3];
        const Vec3 halves = (light[0] + light[1] - light[2] - light[3]) / 2;
        of_one.push_back(relative_square((first * first + second * second) / 8, means[i], floor));
        of_two.push_back(relative_square(halves * halves / 4, means[i], floor));
    }
    // A power law takes off 2^power times as much in the first doubling as in the next.
    const double one = double{trimmed_mean(of_one)}, two = double{trimmed_mean(of_two)};
    return two > 0 ? std::clamp(std::log2(one / two), 1.0, PilotNoise::most_stratified) : PilotNoise::most_stratified;
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
