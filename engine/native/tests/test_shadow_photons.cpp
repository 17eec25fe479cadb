// SPDX-License-Identifier: GPL-3.0-or-later
// What photons say of the lights' sight: lit or dark only where all photons around agree.
#include <algorithm>
#include <random>
#include <vector>

#include "check.h"
#include "shadow_photons.h"

using namespace photon_maps;

namespace {

constexpr float cube_size = 0.25f;
constexpr int enough = 16;

std::vector<ShadowPhoton> several(Vec3 position, uint32_t source, bool is_lit, int count) {
    return std::vector<ShadowPhoton>(static_cast<size_t>(count), {position, source & 0x7fffffff, is_lit ? 1u : 0u});
}

std::vector<ShadowPhoton> joined(std::vector<ShadowPhoton> a, const std::vector<ShadowPhoton> &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

void check_answers(test::Checks &checks) {
    const Vec3 here{0.1f, 0.1f, 0.1f}, beside{0.3f, 0.1f, 0.1f}, far{0.6f, 0.1f, 0.1f};
    const auto answer = [](const std::vector<ShadowPhoton> &photons, Vec3 position, size_t source) {
        return ShadowPhotons(photons, cube_size).visibility(position, source);
    };
    checks.that(answer({}, here, 0) == Visibility::unknown, "no photons");
    for (const bool is_lit : {true, false}) {
        const Visibility known = is_lit ? Visibility::lit : Visibility::dark;
        checks.that(answer(several(here, 3, is_lit, enough), here, 3) == known, "enough photons of one sort");
        checks.that(answer(several(here, 3, is_lit, enough), beside, 3) == known, "in the cube beside");
        checks.that(answer(several(here, 3, is_lit, enough), far, 3) == Visibility::unknown, "two cubes off");
        checks.that(answer(several(here, 3, is_lit, enough), here, 2) == Visibility::unknown, "of another light");
        checks.that(answer(several(here, 3, is_lit, enough - 1), here, 3) == Visibility::unknown, "too few");
        const auto halves = joined(several(here, 3, is_lit, enough / 2), several(beside, 3, is_lit, enough / 2));
        checks.that(answer(halves, here, 3) == known, "cubes count together");
        const auto one_other = joined(several(here, 3, is_lit, 1000), several(beside, 3, !is_lit, 1));
        checks.that(answer(one_other, here, 3) == Visibility::unknown, "one of the other sort");
        const auto other_light = joined(several(here, 3, is_lit, enough), several(here, 4, !is_lit, enough));
        checks.that(answer(other_light, here, 3) == known, "another light's do not count");
    }
    const ShadowPhotons negative(several({-0.01f, -0.01f, -7.3f}, 0, true, enough), cube_size);
    checks.that(negative.visibility({0.01f, 0.01f, -7.3f}, 0) == Visibility::lit, "across the origin");
    checks.that(negative.visibility({-0.01f, -0.01f, 7.3f}, 0) == Visibility::unknown, "not mirrored");
    checks.that(negative.memory_bytes() > 0 && ShadowPhotons({}, 1).memory_bytes() == 0, "memory is counted");
}

/// Among random photons: against brute force, and never lit within a cube's size of a shadow photon.
void check_against_brute_force(test::Checks &checks) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<ShadowPhoton> photons;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 p{uniform(random), uniform(random), uniform(random)};
        photons.push_back({p, static_cast<uint32_t>(i) & 1u, p.x + 0.3f * p.y < 0.2f ? 1u : 0u});
    }
    const ShadowPhotons map(photons, cube_size);
    int lit = 0, dark = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p = Vec3{uniform(random), uniform(random), uniform(random)} * 1.2f;
        const auto source = static_cast<uint32_t>(i % 2);
        int lit_around = 0, dark_around = 0;
        bool lit_near = false, dark_near = false;
        for (const ShadowPhoton &photon : photons) {
            if (photon.source != source) continue;
            const auto cubes_apart = [](float a, float b) {
                return std::abs(std::floor(a / cube_size) - std::floor(b / cube_size));
            };
            const bool around = cubes_apart(p.x, photon.position.x) <= 1 && cubes_apart(p.y, photon.position.y) <= 1 &&
                                cubes_apart(p.z, photon.position.z) <= 1;
            (photon.is_lit ? lit_around : dark_around) += around;
            if (length(p - photon.position) < cube_size) (photon.is_lit ? lit_near : dark_near) = true;
        }
        const Visibility found = map.visibility(p, source);
        const Visibility wanted = dark_around == 0 && lit_around >= enough   ? Visibility::lit
                                  : lit_around == 0 && dark_around >= enough ? Visibility::dark
                                                                             : Visibility::unknown;
        checks.that(found == wanted, "as all photons say");
        checks.that(!(found == Visibility::lit && dark_near), "never lit near a shadow photon");
        checks.that(!(found == Visibility::dark && lit_near), "never dark near a lit one");
        lit += found == Visibility::lit;
        dark += found == Visibility::dark;
    }
    checks.that(lit > 200 && dark > 200, "both answers occur");
}

}  // namespace

int main() {
    test::Checks checks;
    check_answers(checks);
    check_against_brute_force(checks);
    return checks.report();
}
