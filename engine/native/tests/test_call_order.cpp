// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface called in any order, and cancelled at any moment: an error code and a message, never a crash, and
// what is rendered afterwards is the same.
#include <random>
#include <thread>

#include "api_scenes.h"
#include "seeds.h"

using namespace photon_maps::test;

namespace {

/// Handles as a careless program might hold them, and the worst order to call with them.
class Careless {
  public:
    Careless(Checks &checks, pm_device *device, uint32_t seed) : checks_(checks), device_(device), random_(seed) {
        arrays_.settings.photon_count = 50;
        choose_parts(arrays_.settings, random_());
        mesh_ = mesh_of(arrays_);
        material_ = material_of(arrays_);
        instances_ = instances_of(arrays_);
    }

    /// Makes one call, any of all that there are.
    void call() {
        pm_scene *scene = scene_.get();
        pm_render *render = render_.get();
        pm_snapshot *snapshot = snapshot_.get();
        switch (below(20)) {
            case 0:
                return make(scene_, [&](pm_scene **made) { return pm_scene_create(device_, made); });
            case 1:
                return expect(pm_scene_add_mesh(scene, &mesh_, &number_));
            case 2:
                return expect(pm_scene_set_materials(scene, &material_, below(2)));
            case 3:
                return expect(pm_scene_set_instances(scene, &instances_));
            case 4:
                return expect(pm_scene_set_lights(scene, arrays_.lights.data(), below(arrays_.lights.size() + 1)));
            case 5:
                return expect(pm_scene_set_world(scene, below(2), ~0u));
            case 6:
            case 7:
                return make(render_, [&](pm_render **made) {
                    return pm_render_create(scene, &arrays_.camera, &arrays_.settings, made);
                });
            case 8:
                return expect(pm_render_set_camera(render, &arrays_.camera));
            case 9:
                return expect(pm_render_keep_maps(render, below(2) * 1'000'000));
            case 10:
            case 11:
                return expect(pm_render_pass(render, below(4)));
            case 12:
                return expect(pm_render_cancel(render));
            case 13:
                return expect(pm_render_read(render, below(PM_PASS_COUNT + 1), floats_.data(), 64 * (below(5))));
            case 14:
                return expect(pm_render_photons(render, below(5), below(4), below(4), photons_.data()));
            case 15:
                return expect(pm_render_irradiance(render, below(5), below(2), floats_.data(), normal_.data(),
                                                   floats_.data() + 8));
            case 16:
                return make(snapshot_, [&](pm_snapshot **made) { return pm_snapshot_create(render, below(3), made); });
            case 17:
                return expect(pm_snapshot_photons(snapshot, below(5), 0, below(4), traced_.data()));
            case 18:
                return release();
            default:
                return expect(pm_snapshot_received(snapshot, received_.data(), below(4), &count_));
        }
    }

  private:
    /// A number below `end`.
    uint32_t below(size_t end) { return static_cast<uint32_t>(random_() % end); }

    void expect(pm_status status) {
        const bool is_known = status == PM_OK || status == PM_INVALID_ARGUMENT || status == PM_INVALID_OPERATION ||
                              status == PM_CANCELLED;
        checks_.that(is_known, std::string("status: ") + pm_last_error());
        checks_.that(status == PM_OK || pm_last_error()[0] != '\0', "a refusal says why");
    }

    template <class Handle, class Make>
    void make(Handle &handle, Make create) {
        typename Handle::pointer made = nullptr;
        expect(create(&made));
        if (made) handle.reset(made);
    }

    /// Whichever goes first, the others go on.
    void release() {
        const auto which = below(3);
        if (which == 0) scene_.reset();
        if (which == 1) render_.reset();
        if (which == 2) snapshot_.reset();
    }

    Checks &checks_;
    pm_device *device_;
    std::mt19937 random_;
    Arrays arrays_;
    pm_mesh mesh_;
    pm_material material_;
    pm_instances instances_;
    Scene scene_;
    Render render_;
    Snapshot snapshot_;
    uint32_t number_ = 0;
    uint64_t count_ = 0;
    std::array<float, 3> normal_ = {0, 0, 1};
    std::vector<float> floats_ = std::vector<float>(4 * 64);
    std::vector<pm_photon> photons_ = std::vector<pm_photon>(4);
    std::vector<pm_traced_photon> traced_ = std::vector<pm_traced_photon>(4);
    std::vector<pm_received> received_ = std::vector<pm_received>(4);
};

void test_any_order_of_calls(Checks &checks, pm_device *device, uint32_t seed) {
    Careless careless(checks, device, seed);
    for (int i = 0; i < 60; ++i) careless.call();
}

/// A cancel from another thread at a random moment; what is begun then is as if there had been none.
void test_a_cancel_leaves_no_trace(Checks &checks, pm_device *device, uint32_t seed) {
    std::mt19937 random(seed);
    Arrays arrays;
    choose_parts(arrays.settings, random());
    arrays.settings.photon_count = 3000;
    arrays.settings.use_auto = static_cast<uint32_t>(random() % 2);
    const auto picture = [&](bool is_disturbed) {
        pm_status status{};
        const Render render = make_render(device, arrays, status);
        checks.that(status == PM_OK, pm_last_error());
        {
            const std::chrono::microseconds delay(random() % 3000);
            const std::jthread watcher([&, delay] {
                std::this_thread::sleep_for(delay);
                if (is_disturbed) pm_render_cancel(render.get());
            });
            if (is_disturbed) status = pm_render_pass(render.get(), 0);
        }
        checks.that(status == PM_OK || status == PM_CANCELLED, pm_last_error());
        const uint32_t finished = is_disturbed && status == PM_OK;
        uint32_t next = finished;
        for (int tries = 0; next < 2 && tries < 4; ++tries)  // a cancel that came late is met by the next pass
            next += pm_render_pass(render.get(), next) == PM_OK;
        checks.that(next == 2, "passes go on after a cancel");
        std::vector<float> pixels(size_t{4} * 64);
        checks.that(pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()) == PM_OK, "is read");
        return pixels;
    };
    checks.that(picture(true) == picture(false), "seed " + std::to_string(seed) + ": the same bits after a cancel");
}

}  // namespace

/// Usage: test_call_order [first seed] [seconds], see seeds.h.
int main(int argc, char **argv) {
    Checks checks;
    const Device device = make_device(checks);
    if (!device) return checks.report();
    try_seeds(argc, argv, [&](uint32_t seed) {
        test_any_order_of_calls(checks, device.get(), seed);
        if (seed % 20 == 0) test_a_cancel_leaves_no_trace(checks, device.get(), seed);
    });
    return checks.report();
}
