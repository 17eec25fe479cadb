// SPDX-License-Identifier: GPL-3.0-or-later
// Aimed photons bring the same flux everywhere as unaimed ones, and more of them to what can focus light.
#include <functional>
#include <string>

#include "check.h"
#include "emission.h"
#include "emission_scenes.h"

using namespace photon_maps;

namespace {

using Emit = std::function<std::optional<PhotonEmission>(Sequence &)>;

/// Mean flux of the photons that do something, and the variance of that mean.
struct Mean {
    double sum = 0, sum_of_squares = 0;

    void add(Vec3 flux) {
        const auto value = static_cast<double>(flux.x + 2 * flux.y + 4 * flux.z);
        sum += value;
        sum_of_squares += value * value;
    }
    double mean(double count) const { return sum / count; }
    double variance(double count) const {
        return std::max(0.0, sum_of_squares / count - mean(count) * mean(count)) / count;
    }
};

bool passes(const Ray &ray, Vec3 center, float radius) {
    const Vec3 to = center - ray.origin;
    if (length_squared(to) < radius * radius) return true;
    return dot(to, ray.direction) > 0 && length_squared(cross(to, ray.direction)) < radius * radius;
}

constexpr int cells = 8;
constexpr float cell_size = 1;
const std::vector<std::pair<Vec3, float>> probes{
    {{1, 0, 1}, 0.5f},    {{1.5f, 0.3f, 1.1f}, 0.6f}, {{-2, 1, 1}, 1.0f},    {{1, 0, 1}, 0.1f},
    {{0, 0, 2.4f}, 0.3f}, {{1.2f, 0.2f, 1}, 0.2f},    {{-2, -2, 0.5f}, 0.4f}};

/// Flux on the cells of the ground, through the probes, and in all.
std::vector<Mean> field_of(const Emit &emit, uint64_t count, uint32_t seed) {
    std::vector<Mean> field(cells * cells + probes.size() + 1);
    for (uint64_t i = 0; i < count; ++i) {
        Sequence sequence(i, seed);
        const std::optional<PhotonEmission> photon = emit(sequence);
        if (!photon) continue;
        const Ray &ray = photon->ray;
        if (const float distance = -ray.origin.z / ray.direction.z; distance > 0) {
            const Vec3 p = ray.origin + ray.direction * distance;
            const float x = std::floor(p.x / cell_size) + cells / 2, y = std::floor(p.y / cell_size) + cells / 2;
            if (x >= 0 && x < cells && y >= 0 && y < cells)
                field[static_cast<size_t>(x) * cells + static_cast<size_t>(y)].add(photon->flux);
        }
        for (size_t p = 0; p < probes.size(); ++p)
            if (passes(ray, probes[p].first, probes[p].second)) field[cells * cells + p].add(photon->flux);
        field.back().add(photon->flux);
    }
    return field;
}

/// Two overlapping balls of glass and plastic, a larger one of glass, a tilted plastic pane, on a matte ground.
void add_casters(test::TestScene &test) {
    test.add(test::pane_mesh(12, 12), {}, test::matte);
    test.add(test::sphere_mesh(0.5f), {1, 0, 1}, test::glass);
    test.add(test::sphere_mesh(0.6f), {1.5f, 0.3f, 1.1f}, test::plastic);
    test.add(test::sphere_mesh(1), {-2, 1, 1}, test::glass);
    const Transform tilted{{1, 0, 0}, {0, 0.8f, 0.6f}, {0, -0.6f, 0.8f}, {-2, -2, 0.5f}};
    test.add_instance(test.add_mesh(test::pane_mesh(1, 0.5f)), tilted, {test::plastic});
}

Lamp lamp_of(LightType type, Vec3 origin, float width = 0, float height = 0) {
    Lamp lamp{type, Transform(), {3, 2, 1}};
    lamp.transform.origin = origin;
    lamp.width = width;
    lamp.height = height;
    lamp.visibility = ~0u;
    return lamp;
}

Lamp tilted(Lamp lamp) {
    const Vec3 origin = lamp.transform.origin;
    lamp.transform = {{0.8f, 0, 0.6f}, {0, 1, 0}, {-0.6f, 0, 0.8f}, origin};
    return lamp;
}

Lamp with_cone(Lamp lamp, float angle, float blend, float stretch) {
    lamp.spot_angle = angle;
    lamp.spot_blend = blend;
    lamp.transform.x = lamp.transform.x * stretch;
    return lamp;
}

Lamp with_spread(Lamp lamp, float spread) {
    lamp.spread = spread;
    return lamp;
}

struct Case {
    std::string name;
    std::vector<Lamp> lamps;
    std::function<void(test::TestScene &)> add = [](test::TestScene &) {};
    std::optional<uint32_t> world = {};
};

void check_same_field(test::Checks &checks, const Case &c) {
    test::TestScene test;
    add_casters(test);
    c.add(test);
    test.scene.freeze();
    const Lights lights(test.scene, c.lamps, {c.world, ~0u});
    const Emission emission(test.scene, lights);
    checks.that(!emission.empty() && emission.caster_count() == 4, c.name + ": there are light and casters");
    checks.that(!c.world || lights.shines(lights.world_source()), c.name + ": the world shines");

    constexpr uint64_t count = 1 << 18;
    const auto unaimed = field_of([&](Sequence &s) { return emission.emit(s); }, count, 1);
    const auto aimed = field_of([&](Sequence &s) { return emission.emit_caustic(s); }, count, 2);
    for (size_t i = 0; i < unaimed.size(); ++i) {
        const double deviation = std::sqrt(unaimed[i].variance(count) + aimed[i].variance(count));
        const std::string place = i < cells * cells                   ? "ground " + std::to_string(i)
                                  : i < cells * cells + probes.size() ? "probe " + std::to_string(i - cells * cells)
                                                                      : "all";
        checks.near(aimed[i].mean(count), unaimed[i].mean(count), 5 * deviation + 1e-6 * unaimed.back().mean(count),
                    c.name + ": flux of aimed photons, " + place);
    }
    checks.near(aimed.back().mean(count), unaimed.back().mean(count), 0.02 * unaimed.back().mean(count),
                c.name + ": the power");
}

void check_same_fields(test::Checks &checks) {
    using enum LightType;
    const auto add_glow = [](test::TestScene &test) {
        test.add(test::pane_mesh(1, 1), {0, 0, 2.5f}, test::glow);
        test.add(test::sphere_mesh(0.3f, 4), {2.5f, 1, 1}, test::glow);
        test.add(test::pane_mesh(0.2f, 0.2f), {-2, 1, 1.2f}, test::glow);  // within a caster
    };
    const std::vector<Case> cases{
        {"point", {lamp_of(point, {0, 0, 2.5f})}},
        {"point with a radius", {lamp_of(point, {0, 0, 2.5f}, 0.4f)}},
        {"point within a caster", {lamp_of(point, {-2, 1.3f, 1}, 0.1f)}},
        {"point whose sphere meets a caster", {lamp_of(point, {1, 0, 1.9f}, 0.6f)}},
        {"spot", {with_cone(tilted(lamp_of(spot, {-1, 0, 2.5f}, 0.2f)), 1.2f, 0.4f, 1.6f)}},
        {"spot within a caster", {with_cone(lamp_of(spot, {-2, 1, 1.3f}), 0.8f, 0.1f, 1)}},
        {"rectangle", {lamp_of(rectangle, {0, 0, 2.5f}, 1, 2)}},
        {"rectangle with casters half behind it", {tilted(lamp_of(rectangle, {0, 0, 1.2f}, 0.6f, 1))}},
        {"rectangle within a caster", {lamp_of(rectangle, {-2, 1, 1.4f}, 0.5f, 0.5f)}},
        {"ellipse with spread", {with_spread(tilted(lamp_of(ellipse, {-1, 0, 2.2f}, 1, 0.5f)), 1.5f)}},
        {"narrow spread", {with_spread(lamp_of(rectangle, {1, 0, 3}, 0.5f, 0.5f), 0.1f)}},
        {"sun", {tilted(lamp_of(sun, {}))}},
        {"wide sun", {tilted(lamp_of(sun, {}, 0.3f))}},
        {"glowing meshes", {}, add_glow},
        {"uniform world", {}, [](test::TestScene &) {}, test::glow},
        {"world and sun", {tilted(lamp_of(sun, {}))}, [](test::TestScene &) {}, test::sky},
        {"all at once",
         {lamp_of(point, {0, 0, 2.5f}, 0.1f), lamp_of(rectangle, {3, 3, 2}, 1, 1), tilted(lamp_of(sun, {}, 0.1f))},
         add_glow,
         test::sky},
    };
    for (const Case &c : cases) check_same_field(checks, c);
}

/// Flux of aimed photons through a sphere by closed form, where unaimed ones are too few to tell.
void check_small_caster(test::Checks &checks) {
    constexpr float radius = 0.5f, distance = 400;
    test::TestScene test;
    test.add(test::pane_mesh(1000, 1000), {}, test::matte);
    test.add(test::sphere_mesh(radius), {}, test::glass);
    test.scene.freeze();
    const double area = std::numbers::pi * double{radius} * double{radius};
    const double cone = area / (double{distance} * double{distance});  // solid angle, nearly
    const Vec3 above{0, 0, distance};
    struct Expected {
        std::string name;
        Lamp lamp;
        double flux;
    };
    using enum LightType;
    const Lamp point_lamp = lamp_of(point, above), area_lamp = lamp_of(rectangle, above, 2, 2);
    const std::vector<Expected> all{
        {"sun", lamp_of(sun, {}), 3 * area},
        {"wide sun", lamp_of(sun, {}, 0.01f), 3 * area},
        {"point", point_lamp, 3 / (4 * std::numbers::pi) * cone},
        {"spot", with_cone(lamp_of(spot, above), 1, 0, 1), 3 / (4 * std::numbers::pi) * cone},
        {"rectangle", area_lamp, 3 / std::numbers::pi * cone},
    };
    for (const Expected &expected : all) {
        const Lights lights(test.scene, {expected.lamp}, {});
        const Emission emission(test.scene, lights);
        constexpr uint64_t count = 1 << 14;
        double flux = 0, hits = 0;
        for (uint64_t i = 0; i < count; ++i) {
            Sequence sequence(i, 3);
            const auto photon = emission.emit_caustic(sequence);
            if (!passes(photon->ray, {}, radius)) continue;
            flux += static_cast<double>(photon->flux.x);
            ++hits;
        }
        checks.near(flux / count, expected.flux, 0.02 * expected.flux, expected.name + ": flux through a small ball");
        checks.that(hits / count > 0.4, expected.name + ": of the photons 40 % go to the ball");
    }
}

/// A small pane of radiance L and area A: 2 pi A L in all, and through a ball that it sees at an angle t to its normal
/// by a half angle h, L A pi sin(h)^2 cos(t); whether or not photons are aimed at the ball.
void check_glowing_pane(test::Checks &checks) {
    constexpr float radius = 0.5f, distance = 2, radiance = 3, width = 0.02f, height = 0.04f;
    const Vec3 center{distance * std::numbers::sqrt3_v<float> / 2, 0, distance / 2};  // at 60 degrees
    test::TestScene test;
    test.add(test::pane_mesh(width, height), {}, test::glow);
    test.add(test::sphere_mesh(radius), center, test::glass);
    test.scene.freeze();
    const Lights lights(test.scene, {}, {});
    const Emission emission(test.scene, lights);
    const double to_one_side = std::numbers::pi * double{width} * double{height} * double{radiance};
    const double power = 2 * to_one_side, through = to_one_side / 16 / 2;
    const auto check = [&](const std::string &name, const Emit &emit) {
        constexpr uint64_t count = 1 << 18;
        Mean all, ball;
        for (uint64_t i = 0; i < count; ++i) {
            Sequence sequence(i, 5);
            const std::optional<PhotonEmission> photon = emit(sequence);
            if (!photon) continue;
            all.add({photon->flux.x, 0, 0});
            if (passes(photon->ray, center, radius)) ball.add({photon->flux.x, 0, 0});
        }
        checks.near(all.mean(count), power, 5 * std::sqrt(all.variance(count)) + 1e-4 * power, name + ": all flux");
        checks.near(ball.mean(count), through, 5 * std::sqrt(ball.variance(count)) + 1e-3 * through,
                    name + ": flux through a ball");
    };
    check("glowing pane", [&](Sequence &s) { return emission.emit(s); });
    check("glowing pane, aimed", [&](Sequence &s) { return emission.emit_caustic(s); });
}

/// Of many lamps, or many glowing panes, the one by the pool gets the caustic photons.
void check_near_lamp(test::Checks &checks) {
    for (const bool are_meshes : {false, true}) {
        test::TestScene test;
        test.add(test::pane_mesh(200, 200), {}, test::matte);
        test.add(test::pane_mesh(4, 4), {-80, 0, 0.5f}, test::glass);
        std::vector<Lamp> lamps;
        for (int i = 0; i < 51; ++i) {
            const Vec3 origin = i == 0 ? Vec3{-80, 0, 4} : Vec3{static_cast<float>(i), 50, 4};
            if (are_meshes)
                test.add(test::pane_mesh(0.5f, 0.5f), origin, test::glow);
            else
                lamps.push_back(lamp_of(LightType::point, origin, 0.1f));
        }
        test.scene.freeze();
        const Lights lights(test.scene, lamps, {});
        const Emission emission(test.scene, lights);
        const auto near_share = [&](const Emit &emit) {
            constexpr uint64_t count = 1 << 13;
            double near = 0;
            for (uint64_t i = 0; i < count; ++i) {
                Sequence sequence(i, 4);
                near += emit(sequence)->ray.origin.x < -70 ? 1 : 0;
            }
            return near / count;
        };
        checks.near(near_share([&](Sequence &s) { return emission.emit(s); }), 1.0 / 51, 0.005,
                    "all lamps share the photons of the whole scene");
        checks.that(near_share([&](Sequence &s) { return emission.emit_caustic(s); }) > 0.75,
                    "the lamp by the pool has most of the caustic photons");
    }
}

void check_nothing_to_do(test::Checks &checks) {
    test::TestScene test;
    test.add(test::pane_mesh(2, 2), {}, test::matte);
    test.scene.freeze();
    Sequence sequence(0, 0);
    const Lights no_lights(test.scene, {}, {});
    const Emission dark(test.scene, no_lights);
    checks.that(dark.empty() && !dark.emit(sequence) && !dark.emit_caustic(sequence), "no light, no photons");

    Lamp lamp = lamp_of(LightType::point, {0, 0, 1});
    lamp.visibility = 1u << PM_RAY_GLOSSY;
    const Lights lights(test.scene, {lamp}, {});
    const Emission emission(test.scene, lights);
    checks.that(!emission.has_casters(), "nothing focuses light");
    for (uint64_t i = 0; i < 64; ++i) {
        Sequence a(i, 0), b(i, 0);
        const auto whole = emission.emit(a), caustic = emission.emit_caustic(b);
        checks.that(whole->ray.direction == caustic->ray.direction && whole->flux == caustic->flux,
                    "without casters no photon is aimed");
        checks.that(whole->visibility == lamp.visibility, "photons know what their light is visible to");
    }
}

}  // namespace

int main() {
    test::Checks checks;
    check_same_fields(checks);
    check_small_caster(checks);
    check_glowing_pane(checks);
    check_near_lamp(checks);
    check_nothing_to_do(checks);
    return checks.report();
}
