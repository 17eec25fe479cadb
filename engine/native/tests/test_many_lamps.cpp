// SPDX-License-Identifier: GPL-3.0-or-later
// Many sources of light: each is chosen with the probability that is told, and rays meet all lamps in their way.
#include <random>

#include "emission_scenes.h"
#include "light_checks.h"

using namespace photon_maps;
using test::Checks;

namespace {

/// Draws numbers and places.
class Draws {
  public:
    float number(float from, float to) { return std::uniform_real_distribution<float>(from, to)(engine_); }
    Vec3 place(float reach) { return {number(-reach, reach), number(-reach, reach), number(-reach, reach)}; }
    Vec3 direction() {
        while (true)
            if (const Vec3 p = place(1); length_squared(p) > 0.01f && length_squared(p) < 1) return normalize(p);
    }

  private:
    std::mt19937 engine_{5};
};

/// Lamps of all types, near together and far apart, some dark or without an extent; powers over six decades.
std::vector<Lamp> mixed_lamps(size_t count) {
    Draws draws;
    std::vector<Lamp> lamps;
    for (size_t i = 0; i < count; ++i) {
        Lamp lamp{};
        const size_t kind = i % 23;
        lamp.type = kind == 7 ? LightType::sun : static_cast<LightType>(std::array{0, 2, 3, 4}[i % 4]);
        const Frame frame(draws.direction());
        lamp.transform = {frame.x, frame.y, frame.z, draws.place(i % 3 == 0 ? 1.0f : 20.0f)};
        const float power = kind == 11 ? 0.0f : std::pow(10.0f, draws.number(-3, 3));
        lamp.power = Vec3{1, 1, 1} * power;
        lamp.width = kind == 13 && i % 4 < 2 ? 0.0f : draws.number(0.05f, 0.6f);
        lamp.height = draws.number(0.05f, 2);
        lamp.spot_angle = 1.2f;
        lamp.spread = pi;
        lamp.soft_falloff = kind == 5;
        lamp.visibility = kind == 17 ? 1u << PM_RAY_CAMERA : ~0u;
        lamps.push_back(lamp);
    }
    return lamps;
}

/// A scene with a glowing pane, under a sky.
struct Room {
    test::TestScene scene;
    std::optional<Lights> lights;

    explicit Room(std::vector<Lamp> lamps) {
        scene.add(test::pane_mesh(1, 1), {0, 0, 2.5f}, test::glow);
        scene.scene.freeze();
        lights.emplace(scene.scene, std::move(lamps), World{test::sky, ~0u});
    }
};

double sum_of_probabilities(Checks &checks, const Lights &lights, Vec3 position) {
    double sum = 0;
    for (size_t source = 0; source < lights.source_count(); ++source) {
        const float probability = lights.choice_probability(source, position);
        checks.that((probability > 0) == lights.shines(source), "what shines, and only that, is chosen");
        sum += static_cast<double>(probability);
    }
    return sum;
}

/// Choices by evenly spread numbers: how often each source is taken, and what is left of the numbers.
void check_frequencies(Checks &checks, const Lights &lights, Vec3 position) {
    constexpr uint32_t count = 1 << 20;
    const LightChoice::Chances chances = lights.chances_at(position);
    std::vector<uint32_t> taken(lights.source_count());
    double left = 0, left_squared = 0;
    bool agree = true, within = true;
    for (uint32_t i = 0; i < count; ++i) {
        const auto choice = lights.choose(chances, (static_cast<float>(i) + 0.5f) / count);
        if (!choice) return checks.that(false, "a source is chosen");
        if (++taken[choice->source] == 1)
            agree = agree && choice->probability == lights.choice_probability(choice->source, position);
        within = within && choice->left >= 0 && choice->left < 1;
        left += static_cast<double>(choice->left) / count;
        left_squared += static_cast<double>(choice->left * choice->left) / count;
    }
    checks.that(agree, "the probability of a choice is that of its source");
    checks.that(within, "what is left of a random number lies in [0, 1)");
    checks.near(left, 0.5, 0.01, "mean of what is left");
    checks.near(left_squared, 1.0 / 3, 0.01, "its square");
    double worst = 0;
    for (size_t source = 0; source < lights.source_count(); ++source) {
        const double expected = static_cast<double>(lights.choice_probability(source, position)) * count;
        worst = std::max(worst, std::abs(taken[source] - expected) - 1e-4 * expected);
    }
    checks.that(worst <= 8, "sources are taken as often as they say");  // rounding moves ends by some steps
}

void check_choices(Checks &checks) {
    for (const size_t count : {0u, 1u, 7u, 8u, 50u, 126u, 127u, 1000u, 5000u}) {
        const Room room(mixed_lamps(count));
        Draws draws;
        for (int i = 0; i < 6; ++i) {
            // Also beside a lamp, and far from all.
            const Vec3 place = i == 0   ? Vec3{1e4f, 3e3f, -2e4f}
                               : i == 1 ? room.lights->emissive_triangles().bounds().center()
                               : i == 2 && count > 0
                                   ? room.lights->lamps()[count / 2].transform.origin + Vec3{1e-3f, 0, 0}
                                   : draws.place(20);
            checks.near(sum_of_probabilities(checks, *room.lights, place), 1, 1e-5, "some source is chosen");
            if (count < 5000 && i % 2 == 0) check_frequencies(checks, *room.lights, place);
        }
    }
}

/// Of few sources each is chosen by the irradiance it might bring; of many nearly so.
void check_importance(Checks &checks) {
    for (const size_t count : {60u, 3000u}) {
        std::vector<LightReach> reaches;
        Draws draws;
        for (size_t i = 0; i < count; ++i) reaches.push_back({draws.place(10), draws.number(0.5f, 2), 1e-4f, 0});
        const LightChoice choice(reaches);
        double worst = 1;
        for (int i = 0; i < 50; ++i) {
            const Vec3 place = draws.place(12);
            const auto irradiance = [&](const LightReach &reach) {
                return static_cast<double>(reach.factor) /
                       std::max(double{length_squared(reach.position - place)}, double{reach.floor});
            };
            double total = 0;
            for (const LightReach &reach : reaches) total += irradiance(reach);
            const LightChoice::Chances chances = choice.at(place);
            for (size_t s = 0; s < count; ++s) {
                const double exact = static_cast<double>(1 - even_share) * irradiance(reaches[s]) / total +
                                     static_cast<double>(even_share) / static_cast<double>(count);
                const double ratio = static_cast<double>(choice.probability(chances, s)) / exact;
                worst = std::max({worst, ratio, 1 / ratio});
            }
        }
        checks.that(worst < (count < 100 ? 1.00001 : 6), "by irradiance: off by " + std::to_string(worst));
    }
}

/// Dark and absent sources.
void check_darkness(Checks &checks) {
    const LightChoice none({}), dark(std::vector<LightReach>(300));
    checks.that(!none.choose(none.at({}), 0.5f), "no source");
    checks.that(!dark.choose(dark.at({}), 0.5f) && dark.probability(dark.at({}), 7) == 0, "dark sources");
}

void check_meetings(Checks &checks) {
    for (const size_t count : {1u, 9u, 50u, 1000u}) {
        const Room room(mixed_lamps(count));
        Draws draws;
        size_t met = 0, differ = 0;
        for (int i = 0; i < 3000; ++i) {
            Ray ray{draws.place(20), draws.direction() * draws.number(0.5f, 2)};
            if (i % 3 == 0) ray.far = draws.number(0.1f, 20);
            if (i % 5 == 0) ray.kinds = 1u << PM_RAY_DIFFUSE;
            if (i % 7 == 0)
                ray.origin = room.lights->lamps()[static_cast<size_t>(i) % count].transform.origin - ray.direction;
            const bool is_open = std::isinf(ray.far);
            std::vector<size_t> expected, found;
            for (size_t lamp = 0; lamp < count; ++lamp)
                if (room.lights->meet(lamp, ray, is_open)) expected.push_back(lamp);
            room.lights->meet_all(ray, is_open, [&](const LampHit &hit) { found.push_back(hit.source); });
            std::sort(found.begin(), found.end());
            met += found.size();
            differ += found != expected ? 1 : 0;
        }
        checks.that(differ == 0 && met > 0, "rays meet the lamps that each meets by itself");
    }
}

}  // namespace

int main() {
    Checks checks;
    check_choices(checks);
    check_importance(checks);
    check_darkness(checks);
    check_meetings(checks);
    return checks.report();
}
