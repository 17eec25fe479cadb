// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is refused once, at any of the calls for it: an error code and no crash, and what is tried again
// succeeds.
#include <atomic>
#include <new>

#include "api_scenes.h"

using namespace photon_maps::test;

namespace {

std::atomic<long> calls = 0;     ///< for memory, since counting began
std::atomic<long> refused = -1;  ///< the number of the call to refuse

void *allocate(size_t size, size_t alignment) {
    if (calls.fetch_add(1) == refused.load()) throw std::bad_alloc();
    const size_t whole = (std::max<size_t>(size, 1) + alignment - 1) / alignment * alignment;
    void *memory = std::aligned_alloc(alignment, whole);
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void *operator new(size_t size) { return allocate(size, alignof(std::max_align_t)); }
void *operator new(size_t size, std::align_val_t alignment) { return allocate(size, static_cast<size_t>(alignment)); }
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, size_t) noexcept { std::free(memory); }
void operator delete(void *memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void *memory, size_t, std::align_val_t) noexcept { std::free(memory); }

namespace {

/// Renders two passes of a room, with each call that is refused memory made again.
class Attempt {
  public:
    Attempt(Checks &checks, pm_device *device, const Arrays &arrays)
        : checks_(checks), device_(device), arrays_(arrays) {}

    /// @param number of the call for memory to refuse; none: -1
    std::vector<float> run(long number) {
        std::vector<float> pixels(size_t{4} * 64);
        calls = 0;
        refused = number;
        Scene scene;
        Render render;
        uint32_t index = 0;
        const pm_mesh mesh = mesh_of(arrays_);
        const pm_material material = material_of(arrays_);
        const pm_instances instances = instances_of(arrays_);
        make(scene, [&](pm_scene **made) { return pm_scene_create(device_, made); });
        again([&] { return pm_scene_add_mesh(scene.get(), &mesh, &index); });
        again([&] { return pm_scene_set_materials(scene.get(), &material, 1); });
        again([&] { return pm_scene_set_instances(scene.get(), &instances); });
        again([&] { return pm_scene_set_lights(scene.get(), arrays_.lights.data(), arrays_.lights.size()); });
        again([&] { return pm_scene_set_world(scene.get(), arrays_.world, ~0u); });
        make(render,
             [&](pm_render **made) { return pm_render_create(scene.get(), &arrays_.camera, &arrays_.settings, made); });
        calls_before_passes_ = calls;
        // A pass that was refused memory at its very end may count.
        for (uint32_t pass = 0; pass < 2; ++pass)
            again([&] { return passes_of(render.get()) > pass ? PM_OK : pm_render_pass(render.get(), pass); });
        again([&] { return pm_render_read(render.get(), PM_PASS_COMBINED, pixels.data(), pixels.size()); });
        refused = -1;
        return pixels;
    }

    long calls_before_passes() const { return calls_before_passes_; }
    long failures() const { return failures_; }

  private:
    static uint32_t passes_of(const pm_render *render) {
        pm_statistics statistics{};
        statistics.struct_size = sizeof statistics;
        return pm_render_statistics(render, &statistics) == PM_OK ? statistics.passes : 0;
    }

    template <class Call>
    void again(Call call) {
        pm_status status = call();
        if (status == PM_OK) return;
        ++failures_;
        checks_.that(status == PM_OUT_OF_MEMORY, std::string("what is said is: ") + pm_last_error());
        status = call();
        checks_.that(status == PM_OK, std::string("tried again: ") + pm_last_error());
    }

    template <class Handle, class Make>
    void make(Handle &handle, Make create) {
        again([&] {
            typename Handle::pointer made = nullptr;
            const pm_status status = create(&made);
            handle.reset(made);
            return status;
        });
    }

    Checks &checks_;
    pm_device *device_;
    const Arrays &arrays_;
    long calls_before_passes_ = 0, failures_ = 0;
};

/// @param step between calls that are refused while the scene is made; the passes' are many, and some of them are tried
void test_memory_may_be_refused_anywhere(Checks &checks, pm_device *device, uint64_t parts, long step) {
    Arrays arrays;
    arrays.settings.photon_count = 200;
    choose_parts(arrays.settings, parts);
    Attempt attempt(checks, device, arrays);
    attempt.run(-1);
    const std::vector<float> expected = attempt.run(-1);  // by now nothing is made for the first time
    const long count = calls, before_passes = attempt.calls_before_passes();

    constexpr long tries = 40;
    const long stride = std::max((count - before_passes) / tries, 1L);
    long differing = 0;
    for (long number = 0; number < count; number += number < before_passes ? step : stride) {
        const std::vector<float> pixels = attempt.run(number);
        checks.that(all_finite(pixels), "call " + std::to_string(number) + " refused: the picture is finite");
        differing += pixels != expected;
    }
    checks.that(attempt.failures() > before_passes / (2 * step), "refusals are met");
    checks.that(differing == 0, std::to_string(differing) + " pictures are other than without refusals");
    std::cerr << "parts " << parts << ": " << count << " calls for memory, " << attempt.failures() << " refused\n";
}

}  // namespace

int main() {
    Checks checks;
    const Device device = make_device(checks);
    if (!device) return checks.report();
    // By bits as choose_parts() has them: the usual method; adaptive with guiding; nearest with final gather and
    // shadows.
    test_memory_may_be_refused_anywhere(checks, device.get(), 0b1, 1);
    test_memory_may_be_refused_anywhere(checks, device.get(), 0b11000001, 5);
    test_memory_may_be_refused_anywhere(checks, device.get(), 0b110101, 5);
    return checks.report();
}
