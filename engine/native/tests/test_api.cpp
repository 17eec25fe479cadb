// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface end to end: a room is rendered and read back, random garbage is refused or rendered, and nothing
// crashes; under the sanitizers nothing is read out of bounds either.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "check.h"
#include "photon_maps.h"
#include "photon_maps_shader.h"
#include "shader_ops.h"

using photon_maps::test::Checks;

namespace {

template <auto Release>
struct Releaser {
    template <class Handle>
    void operator()(Handle *handle) const {
        Release(handle);
    }
};
using Device = std::unique_ptr<pm_device, Releaser<pm_device_release>>;
using Scene = std::unique_ptr<pm_scene, Releaser<pm_scene_release>>;
using Render = std::unique_ptr<pm_render, Releaser<pm_render_release>>;
using Snapshot = std::unique_ptr<pm_snapshot, Releaser<pm_snapshot_release>>;

constexpr std::array<float, 12> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// Arrays of a scene; as made, a unit cube seen from inside, lit by one lamp of every type and by its own walls.
struct Arrays {
    std::vector<float> vertices;
    std::vector<uint32_t> triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    std::vector<float> transforms{identity.begin(), identity.end()};
    std::vector<uint32_t> meshes = {0}, first_slots = {0}, slot_materials = {0};
    std::vector<float> constants = {0.7f, 0.5f, 0.3f, 0, 0, 0, 0.1f, 0.1f, 0.1f};
    std::vector<pm_instruction> instructions = {
        {PM_OP_INPUT, PM_INPUT_NORMAL, 0, 3, 0, 0}, {PM_OP_DIFFUSE, 0, 0, 4, 0, 3}, {PM_OP_EMISSION, 0, 0, 4, 3, 1}};
    std::vector<uint32_t> arguments = {0, 1, 3, 2};
    std::vector<pm_light> lights;
    uint32_t world = 0;
    pm_camera camera{};
    pm_settings settings{};

    Arrays() {
        for (unsigned corner = 0; corner < 8; ++corner)
            for (unsigned axis = 0; axis < 3; ++axis) vertices.push_back(corner >> axis & 1 ? 1.0f : 0.0f);
        for (uint32_t type = PM_LIGHT_POINT; type <= PM_LIGHT_ELLIPSE; ++type) {
            pm_light light{};
            light.struct_size = sizeof light;
            light.type = type;
            std::copy(identity.begin(), identity.end(), light.transform);
            light.transform[3] = light.transform[7] = 0.5f;
            light.transform[11] = 0.9f;
            light.power[0] = light.power[1] = light.power[2] = 1;
            light.size[0] = light.size[1] = 0.05f;
            light.spot_angle = light.spread = 1;
            lights.push_back(light);
        }
        camera = {
            sizeof camera, PM_CAMERA_PERSPECTIVE, {}, {-1, 1, -1, 1}, {8, 8}, {0, 0, 8, 8}, 0, 100, 0, 0, 0, 0, 0, 0};
        std::copy(identity.begin(), identity.end(), camera.transform);
        camera.transform[3] = camera.transform[7] = 0.4f;
        camera.transform[11] = 0.8f;
        settings.struct_size = sizeof settings;
        settings.photon_count = 500;
        settings.use_caustics = settings.use_indirect = 1;
        settings.filter = PM_FILTER_EPANECHNIKOV;
        settings.cone_k = settings.pixel_filter_width = 1;
        settings.nearest_count = 10;
        settings.max_bounces = 5;
        settings.use_progressive = 1;
        settings.threads = 2;
        settings.passes = (1u << PM_PASS_COUNT) - 1;
        settings.keep_photons = 1;
    }
};

/// Sets the parts of the method by the bits of a number.
void choose_parts(pm_settings &settings, uint64_t bits) {
    const auto bit = [bits](unsigned i) { return static_cast<uint32_t>(bits >> i & 1); };
    settings.integrator = bit(0) ? PM_PHOTON_MAP : bit(1) ? PM_PATH_TRACING : PM_REGULAR_SHADING;
    settings.estimate = bit(7) ? PM_ESTIMATE_ADAPTIVE : bit(2) ? PM_ESTIMATE_NEAREST : PM_ESTIMATE_RADIUS;
    settings.brdf_direction = bit(3);
    settings.use_final_gather = bit(4);
    settings.use_shadow_photons = bit(5);
    settings.use_photon_guiding = bit(6);
}

/// Makes a render of the arrays; null and a status where a call refuses them.
Render make_render(pm_device *device, const Arrays &arrays, pm_status &status) {
    pm_scene *created = nullptr;
    status = pm_scene_create(device, &created);
    const Scene scene(created);
    const auto then = [&status](auto call) {
        if (status == PM_OK) status = call();
    };
    pm_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = arrays.vertices.size() / 3;
    mesh.triangle_count = arrays.triangles.size() / 3;
    mesh.vertices = arrays.vertices.data();
    mesh.triangles = arrays.triangles.data();
    pm_instances instances{};
    instances.struct_size = sizeof instances;
    instances.count = arrays.meshes.size();
    instances.slot_material_count = arrays.slot_materials.size();
    instances.meshes = arrays.meshes.data();
    instances.transforms = arrays.transforms.data();
    instances.first_slots = arrays.first_slots.data();
    instances.slot_materials = arrays.slot_materials.data();
    const pm_material material = {sizeof(pm_material),         0,
                                  arrays.constants.size() / 3, arrays.instructions.size(),
                                  arrays.arguments.size(),     arrays.constants.data(),
                                  arrays.instructions.data(),  arrays.arguments.data()};
    uint32_t index = 0;
    pm_render *render = nullptr;
    then([&] { return pm_scene_add_mesh(scene.get(), &mesh, &index); });
    then([&] { return pm_scene_set_materials(scene.get(), &material, 1); });
    then([&] { return pm_scene_set_instances(scene.get(), &instances); });
    then([&] { return pm_scene_set_lights(scene.get(), arrays.lights.data(), arrays.lights.size()); });
    then([&] { return pm_scene_set_world(scene.get(), arrays.world, ~0u); });
    then([&] { return pm_render_create(scene.get(), &arrays.camera, &arrays.settings, &render); });
    return Render(render);
}

bool all_finite(const std::vector<float> &values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

void test_a_room_is_rendered_and_read(Checks &checks, pm_device *device) {
    for (const uint32_t integrator : {PM_PHOTON_MAP, PM_PATH_TRACING, PM_REGULAR_SHADING}) {
        Arrays arrays;
        arrays.settings.integrator = integrator;
        pm_status status{};
        const Render render = make_render(device, arrays, status);
        checks.that(status == PM_OK, pm_last_error());
        for (uint32_t pass = 0; pass < 3; ++pass)
            checks.that(pm_render_pass(render.get(), pass) == PM_OK, pm_last_error());
        for (uint32_t pass = 0; pass < PM_PASS_COUNT; ++pass) {
            const bool is_number = pass == PM_PASS_DEPTH || pass == PM_PASS_PHOTON_DENSITY || pass == PM_PASS_ERROR;
            const bool is_lit =
                pass < PM_PASS_INDIRECT || (pass == PM_PASS_INDIRECT && integrator != PM_REGULAR_SHADING);
            const size_t channels = pass == PM_PASS_COMBINED ? 4 : is_number ? 1 : 3;
            std::vector<float> pixels(64 * channels);
            checks.that(pm_render_read(render.get(), pass, pixels.data(), pixels.size()) == PM_OK, pm_last_error());
            checks.that(all_finite(pixels), "pixels are finite");
            if (is_lit && pass != PM_PASS_NORMAL)  // a closed room without glass
                checks.that(*std::max_element(pixels.begin(), pixels.end()) > 0, "something is seen");
        }
    }
}

void test_photons_are_read_and_estimated(Checks &checks, pm_device *device) {
    pm_status status{};
    const Render render = make_render(device, Arrays(), status);
    checks.that(pm_render_pass(render.get(), 0) == PM_OK, pm_last_error());
    for (const uint32_t kind : {PM_PHOTONS_DIRECT, PM_PHOTONS_INDIRECT}) {
        uint64_t count = 0;
        checks.that(pm_render_photon_count(render.get(), kind, &count) == PM_OK && count > 100, "photons are kept");
        std::vector<pm_photon> photons(count);
        checks.that(pm_render_photons(render.get(), kind, 0, count, photons.data()) == PM_OK, pm_last_error());
        for (const pm_photon &photon : photons)
            checks.that((photon.bounce == 0) == (kind == PM_PHOTONS_DIRECT), "kinds are kept apart");
        checks.that(pm_render_photons(render.get(), kind, 1, count, photons.data()) == PM_INVALID_ARGUMENT,
                    "there are no more than all");
        const std::array<float, 3> point = {0.5f, 0.5f, 0}, normal = {0, 0, 1};
        std::array<float, 3> irradiance{};
        status = pm_render_irradiance(render.get(), kind, 1, point.data(), normal.data(), irradiance.data());
        checks.that(status == PM_OK && irradiance[0] > 0, "photons bring irradiance");
    }
}

void test_a_cancel_from_another_thread_ends_a_pass(Checks &checks, pm_device *device) {
    Arrays arrays;
    arrays.settings.photon_count = 100'000'000;
    pm_status status{};
    const Render render = make_render(device, arrays, status);
    std::atomic<bool> ended = false;
    std::jthread watcher([&] {
        while (!ended) {
            pm_render_cancel(render.get());
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    });
    checks.that(pm_render_pass(render.get(), 0) == PM_CANCELLED, "the pass was cancelled");
    ended = true;
}

/// Makes a snapshot and asks it everything; returns the photons of the pass.
uint64_t ask_snapshot(Checks &checks, pm_render *render, uint32_t index) {
    pm_snapshot *created = nullptr;
    checks.that(pm_snapshot_create(render, index, &created) == PM_OK, pm_last_error());
    const Snapshot snapshot(created);
    uint64_t stored = 0, received = 0;
    for (uint32_t kind = 0; kind <= PM_PHOTONS_SHADOW; ++kind) {
        uint64_t count = 0;
        checks.that(pm_snapshot_count(snapshot.get(), kind, &count) == PM_OK, pm_last_error());
        std::vector<pm_traced_photon> photons(count);
        checks.that(pm_snapshot_photons(snapshot.get(), kind, 0, count, photons.data()) == PM_OK, pm_last_error());
        if (kind != PM_PHOTONS_SHADOW) stored += count;
        std::vector<uint32_t> numbers;
        for (const pm_traced_photon &photon : photons) numbers.push_back(photon.number);
        if (kind == PM_PHOTONS_SHADOW || count == 0) continue;
        const uint32_t is_caustic = kind == PM_PHOTONS_CAUSTIC;
        std::vector<pm_photon_segment> segments(3);
        uint64_t segment_count = 0;
        checks.that(pm_snapshot_segments(snapshot.get(), is_caustic, numbers.data(), count, segments.data(), 3,
                                         &segment_count) == PM_OK,
                    pm_last_error());
        checks.that(segment_count >= count, "every photon came some way");
    }
    std::vector<pm_received> rows(1000);
    uint64_t row_count = 0;
    checks.that(pm_snapshot_received(snapshot.get(), rows.data(), rows.size(), &row_count) == PM_OK, pm_last_error());
    checks.that(row_count <= rows.size(), "there are few instances and lights");
    for (uint64_t i = 0; i < row_count; ++i) received += rows[i].stored;
    checks.that(received == stored, "instances received what is stored");
    pm_probe probe{};
    probe.struct_size = sizeof probe;
    const std::array<float, 3> origin = {0.5f, 0.4f, 0.6f}, down = {0, 0, -1};
    checks.that(pm_snapshot_probe(snapshot.get(), origin.data(), down.data(), &probe) == PM_OK, pm_last_error());
    for (const pm_map_probe &map : {probe.global_map, probe.caustic_map})
        checks.that(std::isfinite(map.irradiance[0]) && !(map.standard_error[0] < 0), "an estimate is a number");
    return stored;
}

void test_a_snapshot_tells_the_photons_of_a_pass(Checks &checks, pm_device *device) {
    Arrays arrays;
    arrays.settings.use_shadow_photons = 1;
    pm_status status{};
    const Render render = make_render(device, arrays, status);
    pm_snapshot *none = nullptr;
    checks.that(pm_snapshot_create(render.get(), 0, &none) == PM_INVALID_OPERATION, "there is no pass yet");
    for (uint32_t pass = 0; pass < 2; ++pass) checks.that(pm_render_pass(render.get(), pass) == PM_OK, pm_last_error());
    pm_statistics statistics{};
    statistics.struct_size = sizeof statistics;
    checks.that(pm_render_statistics(render.get(), &statistics) == PM_OK, pm_last_error());
    const uint64_t first = ask_snapshot(checks, render.get(), 0), second = ask_snapshot(checks, render.get(), 1);
    checks.that(second == statistics.photons_stored_last, "the photons are those of the pass");
    checks.that(first + second == statistics.photons_stored, "and of those before");
}

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

void test_garbage_is_refused_or_rendered(Checks &checks, pm_device *device) {
    std::mt19937 random(1);
    int refused = 0, rendered = 0;
    for (int trial = 0; trial < 1000; ++trial) {
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
        ++(status == PM_OK ? rendered : refused);
        if (status != PM_OK) continue;
        std::vector<float> pixels(4 * size_t{arrays.camera.region[2]} * arrays.camera.region[3]);
        checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
        checks.that(all_finite(pixels), "trial " + std::to_string(trial) + " is finite");
    }
    checks.that(refused > 100 && rendered > 100, "both happened");
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

void test_any_shader_renders(Checks &checks, pm_device *device) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 500; ++trial) {
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
        checks.that(all_finite(pixels), "shader " + std::to_string(trial) + " is finite");

        ask_snapshot(checks, render.get(), 0);

        // The same photons from elsewhere, in a picture of another size.
        pm_camera camera = arrays.camera;
        camera.transform[3] = 0.6f;
        camera.resolution[0] = camera.region[2] = 16;
        camera.resolution[1] = camera.region[3] = 4;
        checks.that(pm_render_keep_maps(render.get(), trial % 2 == 0 ? 0 : 1 << 20) == PM_OK, pm_last_error());
        for (uint32_t pass = 0; pass < 3; ++pass) {
            if (pass == 1) checks.that(pm_render_set_camera(render.get(), &camera) == PM_OK, pm_last_error());
            checks.that(pm_render_pass(render.get(), pass / 2) == PM_OK, pm_last_error());
        }
        checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
        checks.that(all_finite(pixels), "shader " + std::to_string(trial) + " is finite from elsewhere");
    }
}

}  // namespace

int main() {
    Checks checks;
    const char *path = std::getenv("PHOTON_MAPS_EMBREE");
    checks.that(path != nullptr && *path != '\0', "PHOTON_MAPS_EMBREE names the Embree library");
    pm_device *created = nullptr;
    checks.that(pm_device_create(path, &created) == PM_OK, pm_last_error());
    const Device device(created);
    if (!device) return checks.report();
    test_a_room_is_rendered_and_read(checks, device.get());
    test_photons_are_read_and_estimated(checks, device.get());
    test_a_snapshot_tells_the_photons_of_a_pass(checks, device.get());
    test_a_cancel_from_another_thread_ends_a_pass(checks, device.get());
    test_garbage_is_refused_or_rendered(checks, device.get());
    test_any_shader_renders(checks, device.get());
    return checks.report();
}
