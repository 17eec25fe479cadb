// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface end to end: a room is rendered and read back.
#include <atomic>
#include <chrono>
#include <thread>

#include "api_scenes.h"

using namespace photon_maps::test;

namespace {

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

}  // namespace

int main() {
    Checks checks;
    const Device device = make_device(checks);
    if (!device) return checks.report();
    test_a_room_is_rendered_and_read(checks, device.get());
    test_photons_are_read_and_estimated(checks, device.get());
    test_a_snapshot_tells_the_photons_of_a_pass(checks, device.get());
    test_a_cancel_from_another_thread_ends_a_pass(checks, device.get());
    return checks.report();
}
