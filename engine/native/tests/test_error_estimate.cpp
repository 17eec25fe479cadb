// SPDX-License-Identifier: GPL-3.0-or-later
// The error estimate on pictures whose true error is known: noise that is white, noise that cancels, blur, and tiles
// that are left out.
#include <random>

#include "check.h"
#include "error_estimate.h"
#include "photon_maps.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

constexpr uint32_t width = 100, height = 70;
constexpr uint32_t wanted = (1u << PM_PASS_COMBINED) | (1u << PM_PASS_ERROR);
constexpr float radiance = 2;

/// A picture of one radiance, disturbed pass by pass.
struct Disturbed {
    Film film{width, height, wanted};
    ErrorEstimate error{width, height};
    std::vector<bool> left_out = std::vector<bool>(film.tiles().count());
    std::mt19937 random{1};
    std::normal_distribution<float> normal;

    /// @param disturb(pixel) is added to a pixel's radiance; @param blur(pixel) is told by probes
    template <typename Disturb, typename Blur>
    void add(Disturb disturb, Blur blur) {
        Film pass(width, height, wanted);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const size_t pixel = size_t{y} * width + x;
                PixelSample sample;
                const float value = radiance + disturb(pixel);
                sample.direct = {value, value, value};
                pass.set(pixel, sample);
                const float b = blur(pixel);
                if (error.is_probe(x, y)) error.set_blur(x, y, {b, b, b});
            }
        film.add(pass, left_out);
        error.add(film, pass, left_out);
    }

    /// The root mean square of the picture's relative error.
    double true_error() const {
        double sum = 0;
        for (size_t pixel = 0; pixel < size_t{width} * height; ++pixel) {
            const auto passes = static_cast<float>(film.passes_of(film.tiles().of_pixel(pixel)));
            const double off = film.sum(pixel).x / passes / radiance - 1;
            sum += off * off;
        }
        // Errors are relative to the pixel's radiance or the picture's mean together: twice the square of either.
        return std::sqrt(sum / (2.0 * width * height));
    }
};

constexpr auto no_blur = [](size_t) { return 0.0f; };

void check_white_noise(Checks &checks) {
    Disturbed picture;
    const auto noise = [&](size_t) { return 0.1f * picture.normal(picture.random); };
    picture.add(noise, no_blur);
    checks.that(std::isinf(picture.error.error()), "one pass tells nothing");
    for (int pass = 1; pass < 64; ++pass) picture.add(noise, no_blur);
    const double expected = picture.true_error();
    checks.near(expected, 0.1 / radiance / 8 / std::sqrt(2), 1e-4, "the disturbance is as set");
    checks.near(picture.error.noise() / expected, 1, 0.05, "independent passes");
    checks.that(picture.error.blur() == 0, "nothing is blurred");
    std::vector<float> pixels(size_t{width} * height);
    picture.error.read(pixels);
    double sum = 0;
    for (const float e : pixels) sum += double{e} * e;
    checks.near(std::sqrt(sum / static_cast<double>(pixels.size())) / expected, 1, 0.05, "the error of the pixels");
}

/// Passes that cancel each other's errors, as stretches of a low-discrepancy sequence do: the error of the mean falls
/// faster than the variance between passes tells.
void check_stratified_noise(Checks &checks) {
    Disturbed picture;
    std::vector<float> offsets(size_t{width} * height);
    std::uniform_real_distribution<float> uniform;
    for (float &offset : offsets) offset = uniform(picture.random);
    for (uint32_t pass = 0; pass < 64; ++pass) {
        // The van der Corput sequence, shifted at random in each pixel: the integral of a step.
        float x = 0;
        for (uint32_t digit = 0; digit < 6; ++digit)
            x += static_cast<float>((pass >> digit) & 1) / static_cast<float>(2u << digit);
        picture.add(
            [&](size_t pixel) {
                const float u = x + offsets[pixel];
                return (u - std::floor(u) < 0.37f ? 0.63f : -0.37f) * 0.2f;
            },
            no_blur);
    }
    checks.near(picture.error.noise() / picture.true_error(), 1, 0.35, "stratified passes");
    checks.that(picture.error.noise() < 0.3 * 0.2 * std::sqrt(0.37 * 0.63) / radiance / 8,
                "less than the variance tells");
}

void check_blur(Checks &checks) {
    Disturbed picture;
    // Kernels add 8 % of the radiance; those of half the radius a quarter of that.
    const auto blur = [&](size_t) { return 0.06f * radiance + 0.1f * picture.normal(picture.random); };
    for (int pass = 0; pass < 32; ++pass) picture.add([](size_t) { return 0.08f * radiance; }, blur);
    checks.near(picture.error.blur() / picture.true_error(), 1, 0.15, "blur");
    checks.that(picture.error.noise() < 1e-3f, "no noise but of rounding");
    checks.near(picture.error.error(), picture.error.blur(), 1e-6, "both together");
}

void check_tiles_left_out(Checks &checks) {
    Disturbed picture;
    const auto is_quiet = [](size_t pixel) { return pixel % width < 48; };
    const auto noise = [&](size_t pixel) { return (is_quiet(pixel) ? 0.01f : 0.2f) * picture.normal(picture.random); };
    for (int pass = 0; pass < 16; ++pass) picture.add(noise, no_blur);
    const float quiet = picture.error.tile_noise(0);
    checks.that(quiet < 0.1f * picture.error.tile_noise(4), "tiles are told apart");
    for (size_t tile = 0; tile < picture.left_out.size(); ++tile)
        picture.left_out[tile] = tile % picture.film.tiles().columns() < 3;
    for (int pass = 16; pass < 64; ++pass) picture.add(noise, no_blur);
    checks.that(picture.film.passes_of(0) == 16 && picture.film.passes_of(4) == 64, "passes of tiles");
    checks.near(picture.error.noise() / picture.true_error(), 1, 0.1, "with tiles left out");
    std::vector<float> combined(size_t{4} * width * height);
    picture.film.read(Buffer::combined, combined);
    checks.near(combined[0], radiance, 0.02, "a tile that was left out is the mean of its own passes");
}

}  // namespace

int main() {
    Checks checks;
    check_white_noise(checks);
    check_stratified_noise(checks);
    check_blur(checks);
    check_tiles_left_out(checks);
    return checks.report();
}
