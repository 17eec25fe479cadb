// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_pass.h"

#include <numeric>

#include "camera_path.h"
#include "parallel.h"

namespace photon_maps {

PixelSample render_pixel(const CameraPass &pass, uint32_t x, uint32_t y, bool is_probe, RayCounts &counts,
                         Levels *levels) {
    Sequence sequence(pass.index, hash(hash(pass.seed, x), y));
    const auto u = sequence.next();
    const Vec2 offset = pass.pixel_sampler.sample(u[0], u[1]);
    const Vec2 pixel{static_cast<float>(x) + 0.5f + offset.x, static_cast<float>(y) + 0.5f + offset.y};
    return trace_camera_path(pass, pass.camera.ray(pixel, {u[2], u[3]}), is_probe, sequence, counts, levels);
}

RayCounts render_camera_pass(const CameraPass &pass, Film &film, ErrorEstimate *error,
                             const std::vector<bool> &left_out, const std::atomic<bool> *cancel) {
    const Tiles &tiles = film.tiles();
    std::vector<RayCounts> counts(tiles.count());
    parallel_for(pass.threads, tiles.count(), cancel, [&](size_t tile) {
        if (left_out[tile]) return;
        tiles.visit(tile, [&](uint32_t x, uint32_t y, size_t pixel) {
            throw_if_cancelled(cancel);
            const bool is_probe = error && error->is_probe(x, y);
            NestedFilm *nested = film.nested();
            std::optional<Levels> levels;
            if (nested) levels.emplace();
            const auto [column, row] = pass.camera.frame_pixel(x, y);
            const PixelSample sample =
                render_pixel(pass, column, row, is_probe, counts[tile], levels ? &*levels : nullptr);
            film.set(pixel, sample);
            if (levels) nested->set(x, y, *levels);
            if (is_probe) error->set_blur(x, y, sample.global.blur + sample.caustic_map.blur);
        });
    });
    return std::accumulate(counts.begin(), counts.end(), RayCounts{},
                           [](RayCounts sum, const RayCounts &tile) { return sum += tile; });
}

}  // namespace photon_maps
