// SPDX-License-Identifier: GPL-3.0-or-later
// What the functions of the C interface share: their handles, and the guard that turns exceptions into codes.
#pragma once

#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "memory_limit.h"
#include "parallel.h"
#include "photon_maps.h"
#include "render.h"
#include "validate.h"

namespace photon_maps {

/// A scene and its lights, kept alive by every render of it.
struct SceneState {
    explicit SceneState(std::shared_ptr<const Embree> embree) : scene(std::move(embree)) {}

    Scene scene;
    std::vector<Lamp> lamps;
    World world;
    std::unique_ptr<Lights> lights;  // once frozen, as is the next
    std::unique_ptr<Emission> emission;

    void freeze() {
        if (lights) return;
        scene.freeze();
        // Both or none: there may be no memory left for the second.
        auto new_lights = std::make_unique<Lights>(scene, lamps, world);
        emission = std::make_unique<Emission>(scene, *new_lights);
        lights = std::move(new_lights);
    }
};

/// A call out of order.
struct InvalidOperation : std::logic_error {
    using std::logic_error::logic_error;
};

/// Keeps what was wrong for pm_last_error().
/// @return the status
pm_status fail(pm_status status, const char *message) noexcept;

/// Runs a body; nothing is thrown across the C interface.
template <class Body>
pm_status guarded(Body &&body) noexcept {
    try {
        body();
        return PM_OK;
    } catch (const std::invalid_argument &error) {
        return fail(PM_INVALID_ARGUMENT, error.what());
    } catch (const InvalidOperation &error) {
        return fail(PM_INVALID_OPERATION, error.what());
    } catch (const std::bad_alloc &) {
        return fail(PM_OUT_OF_MEMORY, "out of memory");
    } catch (const MemoryLimitExceeded &error) {
        return fail(PM_OUT_OF_MEMORY, error.what());
    } catch (const std::length_error &error) {
        return fail(PM_OUT_OF_MEMORY, error.what());
    } catch (const Cancelled &error) {
        return fail(PM_CANCELLED, error.what());
    } catch (const EmbreeError &error) {
        return fail(PM_EMBREE_ERROR, error.what());
    } catch (const std::exception &error) {
        return fail(PM_INTERNAL_ERROR, error.what());
    } catch (...) {
        return fail(PM_INTERNAL_ERROR, "an unknown error");
    }
}

template <class Pointer>
void require_handle(const Pointer *handle, const char *name) {
    require(handle != nullptr, std::string(name) + " is null");
}

}  // namespace photon_maps

namespace pm = photon_maps;

struct pm_device {
    std::shared_ptr<const pm::Embree> embree;
};

struct pm_scene {
    std::shared_ptr<pm::SceneState> state;

    pm::SceneState &open() {
        if (state->scene.frozen())
            throw pm::InvalidOperation("the scene is being rendered and does not change any more");
        return *state;
    }
};

struct pm_snapshot {
    std::shared_ptr<pm::SceneState> state;
    std::unique_ptr<const pm::PhotonSnapshot> snapshot;
};

struct pm_render {
    pm_render(std::shared_ptr<pm::SceneState> scene, const pm::Camera &camera, const pm::RenderSettings &settings)
        : state(std::move(scene)), render(state->scene, *state->lights, *state->emission, camera, settings) {}

    std::shared_ptr<pm::SceneState> state;
    pm::Render render;

    const std::vector<pm::Photon> &photons(uint32_t kind) const {
        pm::require(kind <= PM_PHOTONS_CAUSTIC, "unknown kind of photons " + std::to_string(kind));
        if (!render.keeps_photons())
            throw pm::InvalidOperation("photons were not kept: the settings' keep_photons is 0");
        return render.photons(static_cast<pm_photon_kind>(kind));
    }
};
