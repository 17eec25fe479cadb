// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface under attack: random garbage is refused or rendered, and nothing crashes;
// under the sanitizers nothing is read out of bounds either.
#include <limits>

#include "api_scenes.h"
#include "seeds.h"
#include "shader_ops.h"

using namespace photon_maps::test;

namespace {

/// A number from the worst there are.
float garbage(std::mt19937 &random) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array values = {std::numeric_limits<float>::quiet_NaN(),
                                   infinity,
                                   -infinity,
                                   0.0f,
                                   -0.0f,
                                   1.0f,
                                   -1.0f,
                                   1e-45f,
                                   1e-30f,
                                   1e-10f,
                                   1e9f,
                                   -1e9f,
                                   1e20f,
                                   3e38f,
                                   0.5f,
                                   0.25f};
    return values[random() % values.size()];
}

/// What became of garbage.
struct Outcomes {
    uint32_t refused = 0, rendered = 0;
};

void test_garbage_is_refused_or_rendered(Checks &checks, pm_device *device, uint32_t seed, Outcomes &outcomes) {
    std::mt19937 random(seed);
    // Spoil a few numbers of one array, or several.
    Arrays arrays;
    arrays.settings.photon_count = 20;
    choose_parts(arrays.settings, random());
    const auto spoil = [&](auto &&values, auto make) {
        for (auto &value : values)
            if (random() % 40 == 0) value = make();
    };
    const auto number = [&] { return garbage(random); };
    const auto index = [&] { return static_cast<uint32_t>(random() % 4 == 0 ? random() : random() % 9); };
    if (random() % 2) spoil(arrays.vertices, number);
    if (random() % 3 == 0) spoil(arrays.triangles, index);
    if (random() % 3 == 0) spoil(arrays.transforms, number);
    if (random() % 5 == 0) spoil(arrays.first_slots, index);
    if (random() % 5 == 0) arrays.triangles.resize(3 * (random() % 4));
    if (random() % 5 == 0) spoil(arrays.constants, number);
    if (random() % 5 == 0) spoil(arrays.arguments, index);
    for (pm_instruction &instruction : arrays.instructions) {
        const auto fields = {&instruction.op,     &instruction.option,         &instruction.shift,
                             &instruction.output, &instruction.first_argument, &instruction.argument_count};
        if (random() % 5 == 0)
            for (uint32_t *field : fields)
                if (random() % 4 == 0) *field = index();
    }
    if (random() % 5 == 0) spoil(arrays.camera.transform, number);
    if (random() % 9 == 0) spoil(arrays.camera.region, index);
    if (random() % 9 == 0) arrays.camera.stride = index();
    if (random() % 9 == 0) arrays.settings.radius = number();
    if (random() % 9 == 0) arrays.settings.cone_k = number();
    for (pm_light &light : arrays.lights) {
        if (random() % 9 == 0) spoil(light.transform, number);
        if (random() % 9 == 0) spoil(light.size, number);
        if (random() % 9 == 0) light.spot_angle = light.spread = number();
        if (random() % 19 == 0) light.type = index();
    }
    pm_status status{};
    const Render render = make_render(device, arrays, status);
    if (status == PM_OK) status = pm_render_pass(render.get(), 0);
    checks.that(status == PM_OK || status == PM_INVALID_ARGUMENT, std::string("status: ") + pm_last_error());
    checks.that(status == PM_OK || pm_last_error()[0] != '\0', "a refusal says why");
    ++(status == PM_OK ? outcomes.rendered : outcomes.refused);
    if (status != PM_OK) return;
    std::vector<float> pixels(4 * size_t{arrays.camera.region[2]} * arrays.camera.region[3]);
    checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
    checks.that(all_finite(pixels), "seed " + std::to_string(seed) + " is finite");
}

/// A shader that passes all checks, of random operations on the worst numbers there are.
void make_random_shader(Arrays &arrays, std::mt19937 &random) {
    constexpr uint32_t constant_count = 6;
    arrays.constants.clear();
    while (arrays.constants.size() < 3 * constant_count) {
        const float v = garbage(random);
        if (std::abs(v) <= 1e15f) arrays.constants.push_back(v);
    }
    arrays.instructions.clear();
    arrays.arguments.clear();
    uint32_t written = constant_count;
    for (uint32_t count = 0; count < 12; ++count) {
        const bool is_last = count >= 9;
        const auto op = static_cast<uint32_t>(is_last ? PM_OP_DIFFUSE + random() % (PM_OP_COUNT - PM_OP_DIFFUSE)
                                                      : random() % (PM_OP_GRADIENT + 1));
        if (op == PM_OP_TABLE || op == PM_OP_CURVES || op == PM_OP_TEXTURE) continue;
        const uint32_t limit = photon_maps::shape_of(op, 0)->option_count;
        const auto option = static_cast<uint32_t>(limit > 0 ? random() % limit : 0);
        const auto shape = *photon_maps::shape_of(op, option);
        arrays.instructions.push_back({op, option, static_cast<uint32_t>(shape.can_shift ? random() % 3 : 0), written,
                                       static_cast<uint32_t>(arrays.arguments.size()), shape.argument_count});
        for (uint32_t i = 0; i < shape.argument_count; ++i)
            arrays.arguments.push_back(static_cast<uint32_t>(random() % written));
        written += shape.output_count;
    }
}

void test_any_shader_renders(Checks &checks, pm_device *device, uint32_t seed) {
    std::mt19937 random(seed);
    Arrays arrays;
    arrays.settings.photon_count = 20;
    choose_parts(arrays.settings, random());
    make_random_shader(arrays, random);
    pm_status status{};
    const Render render = make_render(device, arrays, status);
    checks.that(status == PM_OK, pm_last_error());
    if (status == PM_OK) status = pm_render_pass(render.get(), 0);
    checks.that(status == PM_OK, pm_last_error());
    std::vector<float> pixels(size_t{4} * 64);
    checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
    checks.that(all_finite(pixels), "shader " + std::to_string(seed) + " is finite");

    ask_snapshot(checks, render.get(), 0);

    // The same photons from elsewhere, in a picture of another size.
    pm_camera camera = arrays.camera;
    camera.transform[3] = 0.6f;
    camera.resolution[0] = camera.region[2] = 16;
    camera.resolution[1] = camera.region[3] = 4;
    checks.that(pm_render_keep_maps(render.get(), seed % 8 == 0 ? 0 : 1 << 20) == PM_OK, pm_last_error());
    for (uint32_t pass = 0; pass < 3; ++pass) {
        if (pass == 1) checks.that(pm_render_set_camera(render.get(), &camera) == PM_OK, pm_last_error());
        checks.that(pm_render_pass(render.get(), pass / 2) == PM_OK, pm_last_error());
    }
    checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
    checks.that(all_finite(pixels), "shader " + std::to_string(seed) + " is finite from elsewhere");
}

}  // namespace

/// Usage: test_fuzz [first seed] [seconds], see seeds.h.
int main(int argc, char **argv) {
    Checks checks;
    const Device device = make_device(checks);
    if (!device) return checks.report();
    Outcomes outcomes;
    const uint32_t count = try_seeds(argc, argv, [&](uint32_t seed) {
        test_garbage_is_refused_or_rendered(checks, device.get(), seed, outcomes);
        if (seed % 4 == 0) test_any_shader_renders(checks, device.get(), seed);
    });
    std::cerr << outcomes.rendered << " scenes rendered, " << outcomes.refused << " refused\n";
    checks.that(outcomes.refused > count / 10 && outcomes.rendered > count / 10, "both happened");
    return checks.report();
}
