// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: checks what comes in, turns it into the helper's own types, and turns exceptions into codes.
#include <algorithm>
#include <memory>
#include <new>

#include "convert.h"
#include "parallel.h"
#include "photon_maps.h"
#include "render.h"
#include "validate.h"

namespace pm = photon_maps;

namespace {

/// A scene and its lights, kept alive by every render of it.
struct SceneState {
    explicit SceneState(std::shared_ptr<const pm::Embree> embree) : scene(std::move(embree)) {}

    pm::Scene scene;
    std::vector<pm::Lamp> lamps;
    pm::World world;
    std::unique_ptr<pm::Lights> lights;  // once frozen, as is the next
    std::unique_ptr<pm::Emission> emission;

    void freeze() {
        if (lights) return;
        scene.freeze();
        lights = std::make_unique<pm::Lights>(scene, lamps, world);
        emission = std::make_unique<pm::Emission>(scene, *lights);
    }
};

struct InvalidOperation : std::logic_error {
    using std::logic_error::logic_error;
};

std::string &last_error() {
    thread_local std::string message;
    return message;
}

pm_status fail(pm_status status, const char *message) noexcept {
    try {
        last_error() = message;
    } catch (const std::bad_alloc &) {
        last_error().clear();  // the code alone must do
    }
    return status;
}

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
    } catch (const std::length_error &error) {
        return fail(PM_OUT_OF_MEMORY, error.what());
    } catch (const pm::Cancelled &error) {
        return fail(PM_CANCELLED, error.what());
    } catch (const pm::EmbreeError &error) {
        return fail(PM_EMBREE_ERROR, error.what());
    } catch (const std::exception &error) {
        return fail(PM_INTERNAL_ERROR, error.what());
    } catch (...) {
        return fail(PM_INTERNAL_ERROR, "an unknown error");
    }
}

template <class Pointer>
void require_handle(const Pointer *handle, const char *name) {
    pm::require(handle != nullptr, std::string(name) + " is null");
}

}  // namespace

struct pm_device {
    std::shared_ptr<const pm::Embree> embree;
};

struct pm_scene {
    std::shared_ptr<SceneState> state;

    SceneState &open() {
        if (state->scene.frozen()) throw InvalidOperation("the scene is being rendered and does not change any more");
        return *state;
    }
};

struct pm_render {
    pm_render(std::shared_ptr<SceneState> scene, const pm::Camera &camera, const pm::RenderSettings &settings)
        : state(std::move(scene)), render(state->scene, *state->lights, *state->emission, camera, settings) {}

    std::shared_ptr<SceneState> state;
    pm::Render render;

    const std::vector<pm::Photon> &photons(uint32_t kind) const {
        pm::require(kind <= PM_PHOTONS_CAUSTIC, "unknown kind of photons " + std::to_string(kind));
        return render.photons(static_cast<pm_photon_kind>(kind));
    }
};

uint32_t pm_abi_version(void) { return PM_ABI_VERSION; }

const char *pm_last_error(void) { return last_error().c_str(); }

pm_status pm_device_create(const char *embree_path, pm_device **device) {
    return guarded([&] {
        require_handle(embree_path, "embree_path");
        require_handle(device, "device");
        *device = std::make_unique<pm_device>(pm_device{std::make_shared<const pm::Embree>(embree_path)}).release();
    });
}

pm_status pm_device_embree_version(const pm_device *device, uint32_t *version) {
    return guarded([&] {
        require_handle(device, "device");
        require_handle(version, "version");
        *version = device->embree->version();
    });
}

void pm_device_release(pm_device *device) { const std::unique_ptr<pm_device> owned(device); }

pm_status pm_scene_create(pm_device *device, pm_scene **scene) {
    return guarded([&] {
        require_handle(device, "device");
        require_handle(scene, "scene");
        auto created = std::make_unique<pm_scene>();
        created->state = std::make_shared<SceneState>(device->embree);
        *scene = created.release();
    });
}

pm_status pm_scene_add_mesh(pm_scene *scene, const pm_mesh *mesh, uint32_t *index) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(mesh, "mesh");
        require_handle(index, "index");
        SceneState &state = scene->open();
        pm::validate(*mesh);
        uint32_t slots = mesh->triangle_count > 0 ? 1 : 0;
        if (mesh->slots && mesh->triangle_count > 0) {
            const uint32_t largest = *std::max_element(mesh->slots, mesh->slots + mesh->triangle_count);
            pm::require(largest < 0xffffffffu, "slots: 2^32 - 1 is no material slot");
            slots = largest + 1;
        }
        pm::Mesh copy = pm::to_mesh(*mesh);
        copy.slot_count = slots;
        state.scene.meshes.push_back(std::move(copy));
        *index = static_cast<uint32_t>(state.scene.meshes.size() - 1);
    });
}

pm_status pm_scene_set_instances(pm_scene *scene, const pm_instances *instances) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(instances, "instances");
        SceneState &state = scene->open();
        std::vector<uint32_t> mesh_slots;
        for (const pm::Mesh &mesh : state.scene.meshes) mesh_slots.push_back(mesh.slot_count);
        pm::validate(*instances, mesh_slots, state.scene.materials.size());
        state.scene.instances = pm::to_instances(*instances);
        state.scene.slot_materials.assign(instances->slot_materials,
                                          instances->slot_materials + instances->slot_material_count);
    });
}

pm_status pm_scene_add_image(pm_scene *scene, const pm_image *image, uint32_t *index) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(image, "image");
        require_handle(index, "index");
        SceneState &state = scene->open();
        pm::validate(*image);
        state.scene.images.push_back(pm::to_image(*image));
        *index = static_cast<uint32_t>(state.scene.images.size() - 1);
    });
}

pm_status pm_scene_add_texture(pm_scene *scene, const pm_texture *texture, uint32_t *index) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(texture, "texture");
        require_handle(index, "index");
        SceneState &state = scene->open();
        pm::validate(*texture, state.scene.images.size());
        state.scene.textures.push_back(pm::to_texture(*texture));
        *index = static_cast<uint32_t>(state.scene.textures.size() - 1);
    });
}

pm_status pm_scene_add_table(pm_scene *scene, const pm_table *table, uint32_t *index) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(table, "table");
        require_handle(index, "index");
        SceneState &state = scene->open();
        pm::validate(*table);
        state.scene.tables.push_back(pm::to_table(*table));
        *index = static_cast<uint32_t>(state.scene.tables.size() - 1);
    });
}

pm_status pm_scene_set_materials(pm_scene *scene, const pm_material *materials, uint64_t count) {
    return guarded([&] {
        require_handle(scene, "scene");
        pm::require(materials || count == 0, "materials is null");
        pm::validate_count(count, "materials");
        SceneState &state = scene->open();
        if (!state.scene.instances.empty()) throw InvalidOperation("materials are set before the instances");
        std::vector<pm::Material> converted;
        for (size_t i = 0; i < count; ++i) {
            pm::validate(materials[i], i, state.scene.textures.size(), state.scene.tables.size());
            converted.push_back(pm::to_material(materials[i]));
            pm::prepare(converted.back(), state.scene);
        }
        state.scene.materials = std::move(converted);
    });
}

pm_status pm_scene_set_lights(pm_scene *scene, const pm_light *lights, uint64_t count) {
    return guarded([&] {
        require_handle(scene, "scene");
        pm::require(lights || count == 0, "lights is null");
        pm::validate_count(count, "lights");
        SceneState &state = scene->open();
        std::vector<pm::Lamp> converted;
        for (size_t i = 0; i < count; ++i) {
            pm::validate(lights[i], i);
            converted.push_back(pm::to_lamp(lights[i]));
        }
        state.lamps = std::move(converted);
    });
}

pm_status pm_scene_set_world(pm_scene *scene, uint32_t material, uint32_t visibility) {
    return guarded([&] {
        require_handle(scene, "scene");
        SceneState &state = scene->open();
        pm::require(material < state.scene.materials.size(),
                    "the world's material " + std::to_string(material) + " does not exist");
        state.world = {material, visibility};
    });
}

void pm_scene_release(pm_scene *scene) { const std::unique_ptr<pm_scene> owned(scene); }

pm_status pm_render_create(pm_scene *scene, const pm_camera *camera, const pm_settings *settings, pm_render **render) {
    return guarded([&] {
        require_handle(scene, "scene");
        require_handle(camera, "camera");
        require_handle(settings, "settings");
        require_handle(render, "render");
        pm::validate(*camera);
        pm::validate(*settings);
        if (!scene->state->lights) scene->state->scene.view = pm::to_view(*camera);  // shaders see the first one's
        scene->state->freeze();
        *render =
            std::make_unique<pm_render>(scene->state, pm::to_camera(*camera), pm::to_settings(*settings)).release();
    });
}

pm_status pm_render_pass(pm_render *render, uint32_t index) {
    return guarded([&] {
        require_handle(render, "render");
        render->render.render_pass(index);
    });
}

pm_status pm_render_cancel(pm_render *render) {
    return guarded([&] {
        require_handle(render, "render");
        render->render.cancel();
    });
}

pm_status pm_render_read(const pm_render *render, uint32_t pass, float *pixels, uint64_t count) {
    return guarded([&] {
        require_handle(render, "render");
        require_handle(pixels, "pixels");
        pm::require(pass < PM_PASS_COUNT, "unknown pass " + std::to_string(pass));
        const auto buffer = static_cast<pm::Buffer>(pass);
        const pm::Film &film = render->render.film();
        if (!film.has(buffer)) throw InvalidOperation("pass " + std::to_string(pass) + " was not asked for");
        pm::require(count == film.size(buffer),
                    "the pass has " + std::to_string(film.size(buffer)) + " floats, not " + std::to_string(count));
        film.read(buffer, {pixels, count});
    });
}

pm_status pm_render_statistics(const pm_render *render, pm_statistics *statistics) {
    return guarded([&] {
        require_handle(render, "render");
        require_handle(statistics, "statistics");
        pm::require(statistics->struct_size == sizeof(pm_statistics), "pm_statistics has another struct_size");
        const pm::RenderStatistics &s = render->render.statistics();
        const uint32_t passes = render->render.film().passes();
        statistics->passes = passes;
        statistics->photon_count = render->render.photon_count();
        statistics->photons_emitted = s.photons_emitted;
        statistics->photons_stored = s.photons_stored;
        statistics->rays = s.rays;
        statistics->memory_bytes = s.peak_memory_bytes;
        statistics->radius_first = s.radius_first;
        statistics->radius_last = s.radius_last;
        for (size_t c = 0; c < 3; ++c) {
            const double scale = passes > 0 ? 1.0 / passes : 0.0;
            statistics->emitted[c] = s.balance.emitted[c] * scale;
            statistics->absorbed[c] = s.balance.absorbed[c] * scale;
            statistics->escaped[c] = s.balance.escaped[c] * scale;
            statistics->cut[c] = s.balance.cut[c] * scale;
        }
        statistics->caustic_photons = s.caustic_photons;
        statistics->caustic_radius_first = s.caustic_radius_first;
        statistics->caustic_radius_last = s.caustic_radius_last;
        statistics->caster_count = render->state->emission->caster_count();
        statistics->reserved = 0;
        statistics->seconds_trace = s.seconds_trace;
        statistics->seconds_build = s.seconds_build;
        statistics->seconds_gather = s.seconds_gather;
    });
}

pm_status pm_render_photon_count(const pm_render *render, uint32_t kind, uint64_t *count) {
    return guarded([&] {
        require_handle(render, "render");
        require_handle(count, "count");
        *count = render->photons(kind).size();
    });
}

pm_status pm_render_photons(const pm_render *render, uint32_t kind, uint64_t first, uint64_t count,
                            pm_photon *photons) {
    return guarded([&] {
        require_handle(render, "render");
        pm::require(photons || count == 0, "photons is null");
        const std::vector<pm::Photon> &source = render->photons(kind);
        pm::require(first <= source.size() && count <= source.size() - first,
                    "there are only " + std::to_string(source.size()) + " photons of this kind");
        for (uint64_t i = 0; i < count; ++i) {
            const pm::Photon &photon = source[first + i];
            const pm::Vec3 d = pm::unpack_direction(photon.direction), n = pm::unpack_normal(photon.normal);
            const pm::Vec3 p = photon.position, f = photon.flux;
            photons[i] = {{p.x, p.y, p.z}, {d.x, d.y, d.z}, {n.x, n.y, n.z}, {f.x, f.y, f.z}, photon.bounce()};
        }
    });
}

pm_status pm_render_irradiance(const pm_render *render, uint32_t kind, uint64_t count, const float *points,
                               const float *normals, float *irradiance) {
    return guarded([&] {
        require_handle(render, "render");
        pm::require(count == 0 || (points && normals && irradiance), "an array of the points is null");
        pm::validate_count(count, "points");
        const pm::PhotonMap map = render->render.map_of(render->photons(kind));
        for (uint64_t i = 0; i < count; ++i) {
            const pm::Vec3 point = pm::vec3(points + 3 * i), normal = pm::vec3(normals + 3 * i);
            pm::require(pm::is_finite(point) && pm::max_component(pm::abs(point)) <= pm::max_coordinate,
                        "point " + std::to_string(i) + " is not finite or beyond 1e9");
            pm::require(std::abs(pm::length(normal) - 1) < 1e-3f, "normal " + std::to_string(i) + " is no unit vector");
            const pm::Vec3 e = render->render.irradiance(map, static_cast<pm_photon_kind>(kind), point, normal);
            irradiance[3 * i] = e.x;
            irradiance[3 * i + 1] = e.y;
            irradiance[3 * i + 2] = e.z;
        }
    });
}

void pm_render_release(pm_render *render) { const std::unique_ptr<pm_render> owned(render); }
