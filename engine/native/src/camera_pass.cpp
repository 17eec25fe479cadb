// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_pass.h"

#include "parallel.h"
#include "sampling.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t tile_size = 16;

/// Weight of a sample against another way to choose it (Veach 1997, section 9.2.4: the power heuristic).
float power_heuristic(float pdf, float other_pdf) {
    const float ratio = other_pdf / pdf;
    return 1 / (1 + ratio * ratio);
}

/// What the eye sees first asks every source while they are few: choosing among them costs more in noise than the
/// rays saved are worth.
constexpr size_t few_sources = 8;

bool asks_every_source(const CameraPass &pass, uint32_t vertex) {
    return vertex == 0 && pass.lights.source_count() <= few_sources;
}

/// Light that a point receives from one source and sends on.
Vec3 sample_source(const CameraPass &pass, const SurfacePoint &hit, const Lights::Choice &choice,
                   const std::array<float, 4> &u, uint64_t &rays) {
    const std::optional<LightSample> light =
        pass.lights.sample(choice.source, hit.position, hit.shading_normal, {u[0], u[1], choice.left});
    if (!light) return {};
    const float cosine = dot(light->direction, hit.shading_normal);
    if (cosine <= 0 || dot(light->direction, hit.normal) <= 0) return {};
    ++rays;
    if (pass.scene.occluded({hit.origin_above(), light->direction, 0, light->distance})) return {};
    // Emissive triangles can also be met by closure sampling, whose density is cosine / pi.
    const float weight = light->pdf > 0 ? power_heuristic(light->pdf * choice.probability, cosine / pi) : 1;
    return albedo(shade(pass.scene, hit, hit.normal, {}), all_lobes) * light->radiance *
           (cosine / pi * weight / choice.probability);
}

/// Light that a point receives straight from the lights and sends on.
Vec3 sample_lights(const CameraPass &pass, const SurfacePoint &hit, uint32_t vertex, Sequence &sequence,
                   uint64_t &rays) {
    Vec3 received;
    if (asks_every_source(pass, vertex)) {
        for (size_t source = 0; source < pass.lights.source_count(); ++source) {
            if (!pass.lights.shines(source)) continue;
            const auto u = sequence.next();
            received += sample_source(pass, hit, {source, 1, u[2]}, u, rays);
        }
    } else {
        const auto u = sequence.next();
        if (const auto choice = pass.lights.choose(hit.position, u[2]))
            received = sample_source(pass, hit, *choice, u, rays);
    }
    return received;
}

/// One camera path from its first surface on. `throughput` starts at 1; light found at vertex 0 is direct.
void trace_path(const CameraPass &pass, SurfacePoint hit, Sequence &sequence, PixelSample &sample, uint64_t &rays) {
    const uint32_t last_vertex = pass.gather ? 0 : pass.max_bounces;
    Vec3 throughput{1, 1, 1};
    for (uint32_t vertex = 0;; ++vertex) {
        Vec3 &received = vertex == 0 ? sample.direct : sample.indirect;

        // Direct light at this vertex by sampling the lights.
        if (!pass.lights.empty()) received += throughput * sample_lights(pass, hit, vertex, sequence, rays);

        // A direction by the closure: it may meet an emissive surface, and is where the path goes on.
        if (vertex == last_vertex && !pass.lights.has_emissive_triangles()) return;
        const auto u = sequence.next();
        const Vec3 direction = Frame(hit.shading_normal).to_world(sample_cosine_hemisphere(u[0], u[1]));
        if (dot(direction, hit.normal) <= 0) return;
        throughput *= albedo(shade(pass.scene, hit, hit.normal, {}), all_lobes);
        if (max_component(throughput) <= 0) return;
        SurfacePoint next;
        ++rays;
        if (!pass.scene.intersect({hit.origin_above(), direction}, next)) return;
        if (next.material->emits()) {
            const float pdf = dot(direction, hit.shading_normal) / pi;
            const float choice = asks_every_source(pass, vertex) ? 1 : pass.lights.triangles_probability(hit.position);
            const float weight = power_heuristic(pdf, choice * pass.lights.pdf(hit.position, next));
            received += throughput * shade(pass.scene, next, -direction, {}).emission * weight;
        }
        if (vertex == last_vertex) return;

        // Russian roulette by throughput, once the path is some bounces long.
        if (vertex >= 3) {
            const float survival = std::min(1.0f, max_component(throughput));
            if (u[2] >= survival) return;
            throughput = throughput / survival;
        }
        hit = next;
    }
}

/// What the camera sees through one pixel in this pass.
PixelSample render_pixel(const CameraPass &pass, uint32_t x, uint32_t y, uint64_t &rays) {
    const Camera &camera = pass.camera;
    Sequence sequence(pass.index, hash(hash(pass.seed, x), y));
    const auto u = sequence.next();
    const Vec2 offset = pass.pixel_sampler.sample(u[0], u[1]);
    const Ray ray = camera.ray({static_cast<float>(x) + 0.5f + offset.x, static_cast<float>(y) + 0.5f + offset.y});

    PixelSample sample;
    SurfacePoint hit;
    ++rays;
    const bool met = pass.scene.intersect(ray, hit);

    // A lamp in front of the surface hides it.
    Ray until_hit = ray;
    if (met) until_hit.far = hit.distance;
    if (const auto lamp = pass.lights.seen(until_hit, !met)) {
        sample.emission = lamp->first;
        if (!std::isinf(lamp->second)) {
            sample.depth = lamp->second;
            sample.position = ray.origin + ray.direction * lamp->second;
            return sample;
        }
    }
    if (!met) {
        sample.background = pass.lights.world();
        if (pass.film_transparent) {
            sample.emission = sample.background = Vec3();
            sample.alpha = 0;
        }
        return sample;
    }

    sample.depth = hit.distance;
    sample.position = hit.position;
    sample.normal = hit.shading_normal;
    const Shading shading = shade(pass.scene, hit, -normalize(ray.direction), {});
    sample.albedo = albedo(shading, all_lobes);
    sample.emission = shading.emission;
    if (max_component(sample.albedo) <= 0) return sample;

    trace_path(pass, hit, sequence, sample, rays);
    if (pass.gather && pass.gather->map->size() > 0) {
        const PhotonGather &gather = *pass.gather;
        const Coverage::Disc disc = gather.coverage->disc(hit, gather.kernel.radius);
        const Query query{hit.position, hit.normal, hit.shading_normal, disc.share != 1};
        Kernel kernel = gather.kernel;
        kernel.radius = disc.radius;
        const Vec3 irradiance = estimate_irradiance(*gather.map, *gather.edges, query, kernel).irradiance / disc.share;
        sample.indirect = sample.albedo * irradiance / pi;
    }
    return sample;
}

}  // namespace

uint64_t render_camera_pass(const CameraPass &pass, Film &film, const std::atomic<bool> *cancel) {
    // Square tiles: neighbouring pixels gather the same photons.
    const Camera &camera = pass.camera;
    const uint32_t tiles_x = (camera.width + tile_size - 1) / tile_size;
    const uint32_t tiles_y = (camera.height + tile_size - 1) / tile_size;
    std::atomic<uint64_t> rays = 0;
    parallel_for(pass.threads, size_t{tiles_x} * tiles_y, cancel, [&](size_t tile) {
        const auto x0 = static_cast<uint32_t>(tile % tiles_x) * tile_size;
        const auto y0 = static_cast<uint32_t>(tile / tiles_x) * tile_size;
        uint64_t tile_rays = 0;
        for (uint32_t y = y0; y < std::min(y0 + tile_size, camera.height); ++y) {
            for (uint32_t x = x0; x < std::min(x0 + tile_size, camera.width); ++x) {
                throw_if_cancelled(cancel);
                film.set(size_t{y} * camera.width + x, render_pixel(pass, camera.x + x, camera.y + y, tile_rays));
            }
        }
        rays += tile_rays;
    });
    return rays;
}

bool first_hit(const Scene &scene, const Camera &camera, Vec2 pixel, SurfacePoint &hit) {
    return scene.intersect(camera.ray(pixel), hit);
}

}  // namespace photon_maps
