// SPDX-License-Identifier: GPL-3.0-or-later
// Closures against themselves: sampling against densities, weights against integrals, energy, reciprocity; and against
// closed forms.
#include <array>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "surface_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

using Add = std::function<void(Shading &, float roughness, Vec3 normal)>;

struct Named {
    std::string name;
    Add add;
};

/// Everything that surface.h adds, in one colour, alone and mixed.
std::vector<Named> all_closures(Vec3 color, bool multiple) {
    return {
        {"diffuse", [=](Shading &s, float r, Vec3 n) { add_diffuse(s, color, r, n); }},
        {"translucent", [=](Shading &s, float, Vec3 n) { add_translucent(s, color, n); }},
        {"sheen", [=](Shading &s, float r, Vec3 n) { add_sheen(s, color, r, n); }},
        {"glossy", [=](Shading &s, float r, Vec3 n) { add_glossy(s, color, r, n, multiple); }},
        {"metallic", [=](Shading &s, float r, Vec3 n) { add_metallic(s, white, color, white, r, n, multiple); }},
        {"conductor",
         [=](Shading &s, float r, Vec3 n) { add_conductor(s, color, {0.2f, 1, 3}, {4, 2, 1}, r, n, multiple); }},
        {"glass", [=](Shading &s, float r, Vec3 n) { add_glass(s, white, color, r, 1.5f, n, multiple); }},
        {"refraction", [=](Shading &s, float r, Vec3 n) { add_refraction(s, color, r, 1.3f, n); }},
        {"specular",
         [=](Shading &s, float r, Vec3 n) { add_specular(s, color, {0.1f, 0.05f, 0}, r, 1.5f, n, multiple); }},
        {"mixture",
         [=](Shading &s, float r, Vec3 n) {
             add_diffuse(s, color * 0.3f, 1 - r, n);
             add_translucent(s, color * 0.3f, n);
             add_glass(s, white * 0.4f, color, r, 1.4f, n, multiple);
         }},
        {"principled",
         [=](Shading &s, float r, Vec3 n) { add_principled(s, white, plain_principled(color, r, n), multiple); }},
        {"principled with all",
         [=](Shading &s, float r, Vec3 n) {
             Principled inputs = plain_principled(color, r, n);
             inputs.coat_roughness = 0.2f;
             inputs.metallic = inputs.transmission = inputs.coat = inputs.sheen = inputs.diffuse_roughness = 0.4f;
             add_principled(s, white, inputs, multiple);
         }},
    };
}

Vec3 direction(float degrees, float around = 0) {
    const float angle = degrees * pi / 180, turn = around * pi / 180;
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

Shading seen(const Named &closure, float roughness, Vec3 outgoing, bool is_backfacing = false, Vec3 normal = up) {
    Shading shading = test::seen(outgoing, is_backfacing);
    closure.add(shading, roughness, normal);
    return shading;
}

class Random {
  public:
    std::array<float, 3> operator()() {
        const auto one = [&] { return std::min(uniform_(engine_), 1 - 1e-7f); };
        return {one(), one(), one()};
    }

  private:
    std::mt19937 engine_{7};
    std::uniform_real_distribution<float> uniform_{0, 1};
};

/// Means of sample().weight, and their standard errors.
struct Mean {
    std::array<double, 3> value{}, error{};
    bool usable = true;  ///< all were finite, not negative and on the side of their lobe
};

Mean mean_weight(const Shading &shading, Lobes lobes, Transport transport, int count) {
    Random random;
    Mean mean;
    std::array<double, 3> squares{};
    for (int i = 0; i < count; ++i) {
        const std::optional<ScatterSample> drawn = sample(shading, lobes, random(), transport);
        if (!drawn) continue;
        const bool reflects = (drawn->lobe & reflection_lobes) != 0;
        mean.usable &= is_finite(drawn->weight) && is_finite(drawn->direction) && std::isfinite(drawn->pdf) &&
                       std::abs(length(drawn->direction) - 1) < 1e-3f && (drawn->lobe & lobes) != 0 &&
                       (dot(drawn->direction, shading.normal) > 0) == reflects &&
                       (drawn->pdf > 0) != drawn->is_singular;
        for (int axis = 0; axis < 3; ++axis) {
            const double weight = double{drawn->weight[axis]};
            mean.usable &= weight >= 0;
            mean.value[static_cast<size_t>(axis)] += weight / count;
            squares[static_cast<size_t>(axis)] += weight * weight / count;
        }
    }
    for (size_t axis = 0; axis < 3; ++axis)
        mean.error[axis] = std::sqrt(std::max(squares[axis] - mean.value[axis] * mean.value[axis], 0.0) / count);
    return mean;
}

constexpr size_t rows = 12, columns = 12, fine = 32;  // bins of the sphere, and steps in each

/// Integrals over the bins.
struct Bins {
    std::array<double, rows * columns> pdf{};
    std::array<double, 3> value{};
};

size_t bin_of(Vec3 v) {
    const float polar = std::acos(std::clamp(v.z, -1.0f, 1.0f)) / pi, around = (std::atan2(v.y, v.x) + pi) / (2 * pi);
    return std::min(static_cast<size_t>(polar * rows), rows - 1) * columns +
           std::min(static_cast<size_t>(around * columns), columns - 1);
}

Bins integrate(const Shading &shading, Lobes lobes, Transport transport) {
    Bins bins;
    for (size_t i = 0; i < rows * fine; ++i) {
        const double polar = std::numbers::pi * (static_cast<double>(i) + 0.5) / (rows * fine);
        for (size_t j = 0; j < columns * fine; ++j) {
            const double around = 2 * std::numbers::pi * ((static_cast<double>(j) + 0.5) / (columns * fine) - 0.5);
            const Vec3 v{static_cast<float>(std::sin(polar) * std::cos(around)),
                         static_cast<float>(std::sin(polar) * std::sin(around)), static_cast<float>(std::cos(polar))};
            const double area =
                std::sin(polar) * 2 * std::numbers::pi * std::numbers::pi / (rows * columns * fine * fine);
            bins.pdf[i / fine * columns + j / fine] += area * double{pdf(shading, lobes, v)};
            const Vec3 value = evaluate(shading, lobes, v, transport);
            for (int axis = 0; axis < 3; ++axis) bins.value[static_cast<size_t>(axis)] += area * double{value[axis]};
        }
    }
    return bins;
}

/// Pearson's statistic of drawn directions against the integrals of pdf(), as a deviation of a normal distribution
/// (Wilson and Hilferty 1931).
double chi_squared_deviation(const Shading &shading, Lobes lobes, const Bins &bins, int count) {
    std::array<double, rows * columns> drawn{};
    Random random;
    double rest = count, expected_rest = count;
    for (int i = 0; i < count; ++i)
        if (const auto one = sample(shading, lobes, random(), Transport::flux)) drawn[bin_of(one->direction)] += 1;
    double sum = 0, degrees = 0;
    const auto compare = [&](double found, double expected) {
        sum += (found - expected) * (found - expected) / expected;
        degrees += 1;
    };
    for (size_t bin = 0; bin < drawn.size(); ++bin) {
        const double expected = bins.pdf[bin] * count;
        if (expected < 10) continue;
        compare(drawn[bin], expected);
        rest -= drawn[bin];
        expected_rest -= expected;
    }
    if (expected_rest > 10) compare(rest, expected_rest);
    const double variance = 2 / (9 * degrees);
    return (std::cbrt(sum / degrees) - (1 - variance)) / std::sqrt(variance);
}

/// Sampling against the density, and its weights against the integral of what evaluate() gives.
void check_sampling(Checks &checks, const Shading &shading, Lobes lobes, Transport transport, const std::string &name) {
    constexpr int count = 20000;
    const Bins bins = integrate(shading, lobes, transport);
    const Mean mean = mean_weight(shading, lobes, transport, count);
    checks.that(mean.usable, name + ": every sample is finite and on the side of its lobe");
    for (size_t axis = 0; axis < 3; ++axis)
        checks.near(mean.value[axis], bins.value[axis], 5 * mean.error[axis] + 4e-3,
                    name + ": mean weight against the integral");
    if (mean.value[0] > 0)
        checks.near(chi_squared_deviation(shading, lobes, bins, count), 0, 5, name + ": directions follow pdf()");
}

void check_all_sampling(Checks &checks) {
    for (const Named &closure : all_closures(orange, true))
        for (const float roughness : {0.5f, 1.0f})
            for (const float degrees : {20.0f, 75.0f})
                for (const bool is_backfacing : {false, true}) {
                    const std::string name = closure.name + ", roughness " + std::to_string(roughness) + ", " +
                                             std::to_string(degrees) + " degrees" + (is_backfacing ? ", back" : "");
                    const Shading shading = seen(closure, roughness, direction(degrees), is_backfacing);
                    check_sampling(checks, shading, all_lobes, Transport::flux, name);
                }
    // Single lobes, and normals that are not the surface's.
    for (const Named &closure : all_closures(orange, false)) {
        const Shading shading = seen(closure, 0.5f, direction(50), true);
        for (const Lobes lobes :
             {Lobes{glossy_reflection}, Lobes{rough_reflection}, Lobes{glossy_transmission}, diffuse_lobes})
            if (lobes_of(shading) & lobes)
                check_sampling(checks, shading, lobes, Transport::radiance, closure.name + ", some lobes");
        for (const Vec3 normal : {direction(35, 60), -direction(60, 180)})
            check_sampling(checks, seen(closure, 0.5f, direction(50), false, normal), all_lobes, Transport::flux,
                           closure.name + ", turned normal");
    }
}

void check_energy(Checks &checks) {
    for (const bool multiple : {false, true})
        for (const Named &closure : all_closures(white, multiple))
            for (const float roughness : {0.0f, 0.005f, 0.15f, 0.45f, 0.75f, 1.0f})
                for (const float degrees : {0.0f, 30.0f, 60.0f, 80.0f, 89.0f})
                    for (const bool is_backfacing : {false, true}) {
                        const Shading shading = seen(closure, roughness, direction(degrees), is_backfacing);
                        const Mean mean = mean_weight(shading, all_lobes, Transport::flux, 5000);
                        const std::string name = closure.name + ", roughness " + std::to_string(roughness) + ", " +
                                                 std::to_string(degrees) + (is_backfacing ? ", back" : "");
                        checks.that(mean.usable, name + ": every sample is finite");
                        const double value = mean.value[1], error = 4 * mean.error[1];
                        const float estimate = albedo(shading, all_lobes).y;
                        checks.that(estimate >= 0 && estimate < 1.001f, name + ": the albedo is a share");
                        checks.that(estimate > 0 || value == 0, name + ": what scatters has an albedo");
                        checks.that(value <= 1.01 + error, name + ": no energy is gained: " + std::to_string(value));
                        const bool is_lossless = closure.name == "diffuse" || closure.name == "translucent" ||
                                                 (multiple && (closure.name == "glossy" || closure.name == "metallic" ||
                                                               closure.name == "glass"));
                        // Nearer to grazing, the tables' grid is too coarse to be exact.
                        if (is_lossless && degrees <= 80)
                            checks.near(value, 1, 0.01 + error, name + ": no energy is lost");
                    }
}

/// Helmholtz: f(a, b) = f(b, a), over the squared indices on the two sides.
void check_reciprocity(Checks &checks) {
    const auto f = [](const Named &closure, float roughness, Vec3 outgoing, Vec3 incoming, bool flipped) {
        const Vec3 mirror{1, 1, flipped ? -1.0f : 1.0f};  // so that the back is above
        const Shading shading = seen(closure, roughness, outgoing * mirror, flipped);
        return evaluate(shading, all_lobes, incoming * mirror, Transport::radiance) / std::abs(incoming.z);
    };
    for (const Named &closure : all_closures(orange, false)) {
        if (closure.name == "sheen" || closure.name == "mixture" || closure.name.starts_with("principled")) continue;
        const bool transmits = closure.name == "translucent" || closure.name == "glass" || closure.name == "refraction";
        const float ior = closure.name == "glass" ? 1.5f : closure.name == "refraction" ? 1.3f : 1.0f;
        for (const float roughness : {0.3f, 0.8f})
            for (const Vec3 a : {direction(10), direction(60)}) {
                const Vec3 b = transmits ? -direction(35, 20) : direction(35, 100);
                const Vec3 there = f(closure, roughness, a, b, false);
                const Vec3 back = f(closure, roughness, b, a, transmits);
                checks.that(there.y > 0, closure.name + ": scatters there");
                for (int axis = 0; axis < 3; ++axis)
                    checks.near(double{there[axis]}, double{back[axis] / (ior * ior)}, 1e-4 * double{there[axis]},
                                closure.name + ": reciprocity");
                const Vec3 flux = evaluate(seen(closure, roughness, a), all_lobes, b, Transport::flux);
                const Vec3 radiance = evaluate(seen(closure, roughness, a), all_lobes, b, Transport::radiance);
                checks.near(double{flux.y}, double{radiance.y * ior * ior}, 1e-5 * double{flux.y},
                            closure.name + ": radiance is scaled by the squared indices");
            }
    }
}

/// What a rough diffuse surface is said to scatter is what its samples bring, further scatterings among them.
void check_rough_diffuse_albedo(Checks &checks) {
    for (const float roughness : {0.3f, 1.0f}) {
        const Shading shading =
            seen({"diffuse", [](Shading &s, float r, Vec3 n) { add_diffuse(s, white * 0.9f, r, n); }}, roughness,
                 direction(40));
        constexpr int side = 128;
        double sum = 0;
        for (int i = 0; i < side * side; ++i) {
            const float u = (static_cast<float>(i % side) + 0.5f) / side,
                        v = (static_cast<float>(i / side) + 0.5f) / side;
            const auto drawn = sample(shading, all_lobes, {u, v, 0.5f}, Transport::radiance);
            if (drawn) sum += double{drawn->weight.y};
        }
        checks.near(double{albedo(shading, all_lobes).y}, sum / (side * side), 0.01, "the albedo of rough diffuse");
    }
}

/// Two mirrors in one surface, of which a sample takes one: on the mean both reflect their share.
void check_mixed_mirrors(Checks &checks) {
    Shading shading = seen({"two mirrors",
                            [](Shading &s, float r, Vec3 n) {
                                add_glossy(s, white * 0.3f, r, n, false);
                                add_glossy(s, white * 0.5f, r, n, false);
                            }},
                           0, direction(30));
    constexpr int count = 1000;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / count;
        const auto drawn = sample(shading, all_lobes, {0.5f, 0.5f, u}, Transport::radiance);
        checks.that(drawn && drawn->is_singular, "a mirror is drawn");
        if (drawn) sum += double{drawn->weight.x};
    }
    checks.near(sum / count, 0.8, 0.005, "mirrors reflect their shares together");
}

}  // namespace

int main() {
    Checks checks;
    check_all_sampling(checks);
    check_energy(checks);
    check_reciprocity(checks);
    check_mixed_mirrors(checks);
    check_rough_diffuse_albedo(checks);
    return checks.report();
}
