// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_pass.h"

#include <numeric>

#include "camera_path.h"
#include "parallel.h"

namespace photon_maps {

namespace {

constexpr uint32_t tile_size = 16;

PixelSample render_pixel(const CameraPass &pass, uint32_t x, uint32_t y, RayCounts &counts) {
    Sequence sequence(pass.index, hash(hash(pass.seed, x), y));
    const auto u = sequence.next();
    const Vec2 offset = pass.pixel_sampler.sample(u[0], u[1]);
    const Vec2 pixel{static_cast<float>(x) + 0.5f + offset.x, static_cast<float>(y) + 0.5f + offset.y};
    return trace_camera_path(pass, pass.camera.ray(pixel, {u[2], u[3]}), sequence, counts);
}

}  // namespace

RayCounts render_camera_pass(const CameraPass &pass, Film &film, const std::atomic<bool> *cancel) {
    // Square tiles: neighbouring pixels gather the same photons.
    const Camera &camera = pass.camera;
    const uint32_t tiles_x = (camera.width + tile_size - 1) / tile_size;
    const uint32_t tiles_y = (camera.height + tile_size - 1) / tile_size;
    std::vector<RayCounts> counts(size_t{tiles_x} * tiles_y);
    parallel_for(pass.threads, size_t{tiles_x} * tiles_y, cancel, [&](size_t tile) {
        const auto x0 = static_cast<uint32_t>(tile % tiles_x) * tile_size;
        const auto y0 = static_cast<uint32_t>(tile / tiles_x) * tile_size;
        for (uint32_t y = y0; y < std::min(y0 + tile_size, camera.height); ++y) {
            for (uint32_t x = x0; x < std::min(x0 + tile_size, camera.width); ++x) {
                throw_if_cancelled(cancel);
                film.set(size_t{y} * camera.width + x, render_pixel(pass, camera.x + x, camera.y + y, counts[tile]));
            }
        }
    });
    return std::accumulate(counts.begin(), counts.end(), RayCounts{},
                           [](RayCounts sum, const RayCounts &tile) { return sum += tile; });
}

}  // namespace photon_maps
