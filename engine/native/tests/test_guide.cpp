// SPDX-License-Identifier: GPL-3.0-or-later
// Directions from photons: what is drawn against its density, and what the photons say against both.
#include <functional>
#include <random>
#include <string>

#include "guide.h"
#include "sampling.h"
#include "surface_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

constexpr float cube_size = 0.5f;
constexpr Vec3 here{0.1f, 0.2f, 0.3f};

class Random {
  public:
    float one() { return std::min(uniform_(engine_), 1 - 1e-7f); }
    std::array<float, 3> three() { return {one(), one(), one()}; }

  private:
    std::mt19937 engine_{11};
    std::uniform_real_distribution<float> uniform_{0, 1};
};

Vec3 direction(float degrees, float around) {
    const float angle = degrees * pi / 180, turn = around * pi / 180;
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

/// Photons that landed here and around from some directions, about a normal.
std::vector<Photon> landed(Vec3 normal, const std::vector<Vec3> &local_directions, int count) {
    const Frame frame(normal);
    Random random;
    std::vector<Photon> photons;
    for (int i = 0; i < count; ++i) {
        const Vec3 from = frame.to_world(local_directions[static_cast<size_t>(i) % local_directions.size()]);
        const Vec3 beside = frame.x * (4 * random.one() - 2) + frame.y * (4 * random.one() - 2);
        photons.push_back({here + beside * cube_size, {1, 1, 1}, pack_normal(normal, 1), pack_direction(-from)});
    }
    return photons;
}

SurfacePoint point_with(Vec3 normal) {
    SurfacePoint point{};
    point.position = here;
    point.normal = point.shading_normal = normal;
    return point;
}

Shading shading_with(Vec3 normal, const std::function<void(Shading &, Vec3)> &add) {
    Shading shading = seen(normalize(normal + Vec3{0.3f, 0.2f, 0.1f}));
    shading.normal = normal;
    add(shading, normal);
    return shading;
}

struct Named {
    std::string name;
    std::function<void(Shading &, Vec3)> add;
};

std::vector<Named> surfaces() {
    return {
        {"Lambertian", [](Shading &s, Vec3 n) { add_diffuse(s, orange, 0, n); }},
        {"rough", [](Shading &s, Vec3 n) { add_diffuse(s, orange, 1, n); }},
        {"sheen", [](Shading &s, Vec3 n) { add_sheen(s, orange, 0.3f, n); }},
        {"tilted", [](Shading &s, Vec3 n) { add_diffuse(s, orange, 0.5f, normalize(n + Vec3{0.2f, -0.3f, 0.1f})); }},
        {"translucent",
         [](Shading &s, Vec3 n) {
             add_diffuse(s, orange * 0.4f, 0, n);
             add_translucent(s, orange * 0.5f, n);
         }},
    };
}

constexpr size_t rows = 12, columns = 12, fine = 64;  // bins of the sphere, and steps in each

size_t bin_of(Vec3 d) {
    const double turn = std::atan2(double{d.y}, double{d.x}) / (2 * std::numbers::pi) + 0.5;
    const auto row = static_cast<size_t>((double{d.z} + 1) / 2 * rows);
    return std::min(row, rows - 1) * columns + std::min(static_cast<size_t>(turn * columns), columns - 1);
}

/// Compares draws with a density over bins of the sphere of equal solid angle.
/// @param total the integral that the density has
void check_density(Checks &checks, const std::string &name, double total, const std::function<float(Vec3)> &density,
                   const std::function<std::optional<Vec3>()> &draw) {
    std::vector<double> expected(rows * columns), counts(rows * columns);
    constexpr double cell = 4 * std::numbers::pi / (rows * columns * fine * fine);
    double integral = 0;
    for (size_t i = 0; i < rows * fine; ++i) {
        for (size_t j = 0; j < columns * fine; ++j) {
            const float z = 2 * (static_cast<float>(i) + 0.5f) / (rows * fine) - 1;
            const float phi = 2 * pi * (static_cast<float>(j) + 0.5f) / (columns * fine) - pi;
            const float sine = std::sqrt(1 - z * z);
            const double own = double{density({sine * std::cos(phi), sine * std::sin(phi), z})} * cell;
            expected[i / fine * columns + j / fine] += own;
            integral += own;
        }
    }
    checks.near(integral, total, 0.005, name + ": the density integrates to what is drawn");

    constexpr int count = 100000;
    for (int i = 0; i < count; ++i)
        if (const auto drawn = draw()) ++counts[bin_of(*drawn)];
    double squared = 0;
    int freedom = 0;
    for (size_t bin = 0; bin < counts.size(); ++bin) {
        const double wanted = expected[bin] * count;
        if (wanted < 20) {
            checks.that(counts[bin] < 60, name + ": few are drawn where few are expected");
            continue;
        }
        // The bins' own integrals are right to about half a per cent.
        squared += (counts[bin] - wanted) * (counts[bin] - wanted) / (wanted + 2.5e-5 * wanted * wanted);
        ++freedom;
    }
    checks.that(freedom > 4, name + ": bins are filled");
    checks.near(squared, 0, freedom + 5 * std::sqrt(2.0 * freedom), name + ": chi-squared");
}

void check_guide(Checks &checks, const std::string &name, const PhotonImportance &importance, Vec3 normal,
                 const Shading &shading) {
    const IncomingFlux *incoming = importance.around(point_with(normal), 0.5f, 0.5f);
    checks.that(incoming != nullptr, name + ": photons are found");
    if (!incoming) return;
    const Guide guide(*incoming, shading);
    Random random;
    check_density(
        checks, name + ", the guide", 1, [&](Vec3 d) { return guide.pdf(d); },
        [&] { return std::optional(guide.sample(random.one(), random.one())); });

    // With the closures' own: all that is drawn has its density, and weighs what it scatters over that.
    bool agrees = true;
    double drawn_share = 0;
    constexpr int tries = 20000;
    std::array<double, 3> mean{};
    for (int i = 0; i < tries; ++i) {
        const auto drawn = sample_guided(guide, shading, random.three());
        if (!drawn) continue;
        drawn_share += 1.0 / tries;
        const float density = pdf_guided(guide, shading, drawn->direction);
        const Vec3 wanted = evaluate(shading, diffuse_lobes, drawn->direction, Transport::radiance) / density;
        const bool reflects = dot(drawn->direction, shading.normal) > 0;
        agrees = agrees && drawn->pdf == density && max_component(abs(drawn->weight - wanted)) < 1e-5f &&
                 (max_component(wanted) == 0 || reflects == (drawn->lobe == diffuse_reflection));
        for (int c = 0; c < 3; ++c) mean[static_cast<size_t>(c)] += double{drawn->weight[c]} / tries;
    }
    checks.that(agrees, name + ": density, weight and lobe of what is drawn");
    check_density(
        checks, name + ", the mixture", drawn_share, [&](Vec3 d) { return pdf_guided(guide, shading, d); },
        [&]() -> std::optional<Vec3> {
            const auto drawn = sample_guided(guide, shading, random.three());
            return drawn ? std::optional(drawn->direction) : std::nullopt;
        });

    // Nothing that the closures scatter is ever out of reach; and it is all the same light.
    std::array<double, 3> unguided{};
    bool reachable = true;
    for (int i = 0; i < tries; ++i) {
        const auto drawn = sample(shading, diffuse_lobes, random.three(), Transport::radiance);
        if (!drawn) continue;
        reachable = reachable && pdf_guided(guide, shading, drawn->direction) >= 0.49f * drawn->pdf;
        for (int c = 0; c < 3; ++c) unguided[static_cast<size_t>(c)] += double{drawn->weight[c]} / tries;
    }
    checks.that(reachable, name + ": at least about half as often as without");
    for (size_t c = 0; c < 3; ++c) checks.near(mean[c], unguided[c], 0.02, name + ": the share that is scattered");
}

void check_guides(Checks &checks) {
    const std::vector<Vec3> lobe{direction(60, 30), direction(62, 35), direction(20, 200)};
    for (const Vec3 normal : {up, Vec3{1, 0, 0}, -up, normalize({0.3f, 0.5f, -0.4f})}) {
        PhotonImportance importance(cube_size);
        importance.add(landed(normal, lobe, 4000));
        checks.that(importance.memory_bytes() > 0, "memory is counted");
        const std::string place = " about (" + std::to_string(normal.x) + ", " + std::to_string(normal.z) + ")";
        for (const Named &surface : surfaces())
            check_guide(checks, surface.name + place, importance, normal, shading_with(normal, surface.add));

        // Most of a Lambertian surface's directions go where the photons came from.
        const Guide guide(*importance.around(point_with(normal), 0.5f, 0.5f), shading_with(normal, surfaces()[0].add));
        Random random;
        int near = 0;
        for (int i = 0; i < 10000; ++i) {
            const Vec3 drawn = guide.sample(random.one(), random.one());
            near += std::ranges::any_of(lobe, [&](Vec3 d) { return dot(Frame(normal).to_world(d), drawn) > 0.85f; });
        }
        checks.that(near > 8000, "directions go where photons came from" + place);
    }
}

/// Ends of the numbers' range, and what few photons say.
void check_limits(Checks &checks) {
    const std::vector<Vec3> grazing{direction(89.5f, 10)};
    PhotonImportance importance(cube_size);
    importance.add(landed(up, grazing, 1000));
    for (const Named &surface : surfaces()) {
        const Shading shading = shading_with(up, surface.add);
        const Guide guide(*importance.around(point_with(up), 0.5f, 0.5f), shading);
        constexpr float last = 1 - 0x1p-24f;
        for (const float u : {0.0f, 0.5f, last}) {
            for (const float v : {0.0f, 0.5f, last}) {
                const Vec3 drawn = guide.sample(u, v);
                checks.near(double{length(drawn)}, 1, 1e-3, surface.name + ": a direction at the ends of the range");
            }
        }
    }
    checks.that(!importance.around(point_with(-up), 0.5f, 0.5f), "another side has other photons");

    PhotonImportance few(cube_size);
    few.add(landed(up, grazing, 15));
    checks.that(!few.around(point_with(up), 0.5f, 0.5f), "few photons say nothing");
    checks.that(!PhotonImportance(cube_size).around(point_with(up), 0.5f, 0.5f), "no photons say nothing");
}

void check_disk(Checks &checks) {
    Random random;
    double worst = 0;
    const auto compare = [&](float u, float v) {
        const Vec2 back = disk_to_square(sample_disk(u, v));
        worst = std::max({worst, std::abs(double{back.x} - double{u}), std::abs(double{back.y} - double{v})});
    };
    for (int i = 0; i < 100000; ++i) compare(random.one(), random.one());
    for (const float u : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
        for (const float v : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) compare(u, v);
    checks.near(worst, 0, 1e-5, "disk_to_square() inverts sample_disk()");
}

}  // namespace

int main() {
    Checks checks;
    check_disk(checks);
    check_guides(checks);
    check_limits(checks);
    return checks.report();
}
