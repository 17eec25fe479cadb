// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface to renders: makes them, runs them and reads them.
#include <algorithm>

#include "api.h"
#include "convert.h"

pm_status pm_render_create(pm_scene *scene, const pm_camera *camera, const pm_settings *settings, pm_render **render) {
    return pm::guarded([&] {
        pm::require_handle(scene, "scene");
        pm::require_handle(camera, "camera");
        pm::require_handle(settings, "settings");
        pm::require_handle(render, "render");
        pm::validate(*camera);
        pm::validate(*settings);
        if (!scene->state->lights) scene->state->scene.view = pm::to_view(*camera);  // shaders see the first one's
        scene->state->freeze();
        const auto [x, y, width, height] = std::to_array(camera->region);
        pm::require_memory(pm::memory_limit_or_usual(settings->memory_limit),
                           scene->state->scene.memory_bytes() + pm::picture_bytes(width, height, settings->passes),
                           "the scene and its picture");
        *render =
            std::make_unique<pm_render>(scene->state, pm::to_camera(*camera), pm::to_settings(*settings)).release();
    });
}

pm_status pm_render_set_camera(pm_render *render, const pm_camera *camera) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require_handle(camera, "camera");
        pm::validate(*camera);
        render->render.set_camera(pm::to_camera(*camera));
    });
}

pm_status pm_render_keep_maps(pm_render *render, uint64_t bytes) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        render->render.keep_maps(bytes);
    });
}

pm_status pm_render_pass(pm_render *render, uint32_t index) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        render->render.render_pass(index);
    });
}

pm_status pm_render_cancel(pm_render *render) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        render->render.cancel();
    });
}

pm_status pm_render_read(const pm_render *render, uint32_t pass, float *pixels, uint64_t count) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require_handle(pixels, "pixels");
        pm::require(pass < PM_PASS_COUNT, "unknown pass " + std::to_string(pass));
        const auto buffer = static_cast<pm::Buffer>(pass);
        const pm::Film &film = render->render.film();
        if (!film.has(buffer)) throw pm::InvalidOperation("pass " + std::to_string(pass) + " was not asked for");
        pm::require(count == film.size(buffer),
                    "the pass has " + std::to_string(film.size(buffer)) + " floats, not " + std::to_string(count));
        if (buffer == pm::Buffer::error)
            render->render.error()->read({pixels, count});
        else
            film.read(buffer, {pixels, count});
    });
}

pm_status pm_render_statistics(const pm_render *render, pm_statistics *statistics) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require_handle(statistics, "statistics");
        pm::require(statistics->struct_size == sizeof(pm_statistics), "pm_statistics has another struct_size");
        const pm::RenderStatistics &s = render->render.statistics();
        const uint32_t passes = render->render.film().passes();
        statistics->passes = passes;
        const pm::PhotonCounts counts = render->render.photon_counts();
        statistics->photon_count = counts.global;
        statistics->caustic_photon_count = counts.caustic;
        statistics->photons_emitted = s.photons_emitted;
        statistics->photons_stored = s.photons_stored;
        statistics->photons_stored_last = s.photons_stored_last;
        statistics->is_limited = render->render.is_limited();
        statistics->rays = s.rays.rays;
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
        statistics->indirect = static_cast<uint32_t>(render->render.indirect());
        statistics->light_samples = render->render.light_samples();
        statistics->shadow_rays = s.rays.shadow_rays;
        statistics->spared_shadow_rays = s.rays.spared_shadow_rays;
        statistics->seconds_trace = s.seconds_trace;
        statistics->seconds_build = s.seconds_build;
        statistics->seconds_gather = s.seconds_gather;
        const pm::ErrorEstimate *error = render->render.error();
        statistics->error = error ? error->error() : pm::infinity;
        statistics->noise = error ? error->noise() : pm::infinity;
        statistics->blur = error ? error->blur() : pm::infinity;
        statistics->done = render->render.done();
        const pm::PilotNoise &pilot = render->render.pilot_noise();
        statistics->pilot_camera_noise = static_cast<float>(std::sqrt(pilot.camera_variance));
        statistics->pilot_global_noise = static_cast<float>(pilot.global.deviation(counts.global));
        statistics->pilot_caustic_noise = static_cast<float>(pilot.caustic.deviation(counts.caustic));
    });
}

pm_status pm_render_photon_count(const pm_render *render, uint32_t kind, uint64_t *count) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require_handle(count, "count");
        *count = render->photons(kind).size();
    });
}

pm_status pm_render_photons(const pm_render *render, uint32_t kind, uint64_t first, uint64_t count,
                            pm_photon *photons) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
        pm::require(photons || count == 0, "photons is null");
        const std::vector<pm::Photon> &source = render->photons(kind);
        pm::require(first <= source.size() && count <= source.size() - first,
                    "there are only " + std::to_string(source.size()) + " photons of this kind");
        for (uint64_t i = 0; i < count; ++i) photons[i] = pm::to_pm_photon(source[first + i]);
    });
}

pm_status pm_render_irradiance(const pm_render *render, uint32_t kind, uint64_t count, const float *points,
                               const float *normals, float *irradiance) {
    return pm::guarded([&] {
        pm::require_handle(render, "render");
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
