// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the nested radii a picture is read by.
#include <random>

#include "check.h"
#include "film.h"
#include "nested_estimate.h"

using namespace photon_maps;

namespace {

constexpr uint32_t size = 64;  // pixels along a side, each of which sees one unit of length
constexpr Vec3 up{0, 0, 1};
constexpr uint32_t caustic_alone = 1u << static_cast<uint32_t>(Buffer::caustic);
constexpr float largest_radius = 11;

struct Films {
    Film chosen, provisional;
};

/// Passes over a plane on which photons fall at random, each bringing `flux`: read by the radii that are chosen, and by
/// the provisional one.
/// @param density photons per unit of area and pass as a function of x, up to `densest`
template <typename Density>
Films photon_film(uint32_t passes, float densest, float flux, const Density &density) {
    std::mt19937 random(41);
    std::uniform_real_distribution<float> uniform(0, 1);
    constexpr float margin = largest_radius, side = size + 2 * margin;
    std::poisson_distribution<int> number(static_cast<double>(densest * side * side));
    const Kernel kernel{PM_FILTER_EPANECHNIKOV, largest_radius, 1};
    Films films{Film(size, size, caustic_alone, true), Film(size, size, caustic_alone)};
    for (uint32_t pass = 0; pass < passes; ++pass) {
        std::vector<Photon> photons;
        for (int i = number(random); i > 0; --i) {
            const Vec3 position{side * uniform(random) - margin, side * uniform(random) - margin, 0};
            if (uniform(random) * densest < density(position.x))
                photons.push_back({position, {flux, flux, flux}, pack_normal(up, 0), pack_direction(-up)});
        }
        const PhotonMap map(photons, 1, nullptr);
        Films added{Film(size, size, caustic_alone, true), Film(size, size, caustic_alone)};
        for (uint32_t y = 0; y < size; ++y) {
            for (uint32_t x = 0; x < size; ++x) {
                const Vec3 center{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0};
                const LevelDiscs discs{largest_radius * sqrt(level_areas()), broadcast(1)};
                const Levels levels = estimate_levels(map, EdgeIndex(), {center, up, up}, kernel, discs);
                PixelSample sample;
                sample.caustic = levels.color(provisional_level);
                added.chosen.set(size_t{y} * size + x, sample);
                added.chosen.nested()->set(x, y, levels);
                added.provisional.set(size_t{y} * size + x, sample);
            }
        }
        films.chosen.add(added.chosen);
        films.provisional.add(added.provisional);
    }
    return films;
}

std::vector<float> read(const Film &film) {
    std::vector<float> pixels(film.size(Buffer::caustic));
    film.read(Buffer::caustic, pixels);
    return pixels;
}

struct Moments {
    double mean = 0, variance = 0;
};

/// Of the first channel of the columns [begin, end).
Moments moments(const std::vector<float> &pixels, uint32_t begin, uint32_t end) {
    Moments found;
    const double count = double{size} * (end - begin);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = begin; x < end; ++x) found.mean += double{pixels[3 * (size_t{y} * size + x)]} / count;
    for (uint32_t y = 0; y < size; ++y) {
        for (uint32_t x = begin; x < end; ++x) {
            const double difference = double{pixels[3 * (size_t{y} * size + x)]} - found.mean;
            found.variance += difference * difference / count;
        }
    }
    return found;
}

/// Where all radii see the same light a large one serves, and nothing brightens or darkens: neither where many photons
/// came nor where few did.
void check_constant(test::Checks &checks) {
    struct Light {
        float density;
        uint32_t passes;
        double tolerance;
    };
    for (const auto [density, passes, tolerance] : {Light{0.5f, 8, 0.005}, {0.02f, 8, 0.02}, {0.02f, 1, 0.03}}) {
        const Films films = photon_film(passes, density, 1 / density, [&](float) { return density; });
        const Moments found = moments(read(films.chosen), 0, size), fixed = moments(read(films.provisional), 0, size);
        checks.near(found.mean, fixed.mean, tolerance, "the mean of a constant light");
        // The variance of the smallest radius: that of a sum of w^2 over Poisson's photons, w = 2 (1 - t) / (pi r^2),
        // is 4 / (3 pi r^2) over the density.
        const double smallest =
            4 * 128 / (3 * double{pi} * double{largest_radius * largest_radius} * double{density} * passes);
        checks.near(fixed.variance, smallest / 32, 0.3 * smallest / 32, "the variance of the provisional radius");
        checks.that(found.variance < 1.5 * fixed.variance, "the variance is that of a large radius");
    }
}

/// Beside a step small radii serve, far from it large ones.
void check_step(test::Checks &checks) {
    constexpr uint32_t passes = 32, middle = size / 2;
    const Films films = photon_film(passes, 2, 1, [](float x) { return x < middle ? 0.5f : 2.0f; });
    const std::vector<float> pixels = read(films.chosen);
    checks.near(moments(pixels, middle - 4, middle - 3).mean, 0.5, 0.05, "the dark side of a step");
    checks.near(moments(pixels, middle + 3, middle + 4).mean, 2, 0.05, "the bright side of a step");
    checks.near(moments(pixels, middle - 2, middle - 1).mean, 0.5, 0.2, "just beside it");
    const double smallest = 4 * 128 / (3 * double{pi} * double{largest_radius * largest_radius} * 0.5 * passes);
    checks.that(moments(pixels, 0, 12).variance < 0.05 * smallest, "far from a step there is little noise");
}

/// What reading gives: the mean over the passes, in the place of the provisional radius, beside other light.
void check_exchange(test::Checks &checks) {
    const uint32_t wanted = caustic_alone | 1u << static_cast<uint32_t>(Buffer::combined);
    Film film(20, 18, wanted, true);
    const size_t empty = film.memory_bytes();
    for (uint32_t pass = 0; pass < 2; ++pass) {
        Film added(20, 18, wanted, true);
        for (uint32_t x = 0; x < 16; ++x) {
            Levels levels;
            levels.red = broadcast(3);
            levels.red[provisional_level] = 1;
            levels.variance = broadcast(1000);
            PixelSample sample;
            sample.direct = {4, 4, 4};
            sample.caustic = levels.color(provisional_level);
            added.set(x, sample);
            added.nested()->set(x, 0, levels);
        }
        added.nested()->set(17, 17, {});
        film.add(added);
    }
    std::vector<float> combined(film.size(Buffer::combined));
    film.read(Buffer::combined, combined);
    checks.near(double{combined[0]}, 4 + 3, 1e-6, "red of the largest radius");
    checks.near(double{combined[1]}, 4, 1e-6, "green beside it");
    checks.near(double{combined[4 * 19]}, 0, 0, "no light");
    checks.near(double{read(film)[0]}, 3, 1e-6, "the caustic alone");
    // One tile of two by two: 4 vectors of 8 numbers for each of its pixels.
    checks.near(static_cast<double>(film.memory_bytes() - empty), 16 * 16 * 4 * 8 * 4, 0, "memory of one tile");
}

}  // namespace

int main() {
    test::Checks checks;
    check_constant(checks);
    check_step(checks);
    check_exchange(checks);
    return checks.report();
}
