// SPDX-License-Identifier: GPL-3.0-or-later
#include "film.h"

namespace photon_maps {

namespace {

bool is_of_first_pass(size_t buffer) {
    return buffer == static_cast<size_t>(Buffer::depth) || buffer == static_cast<size_t>(Buffer::position);
}

}  // namespace

Film::Film(uint32_t width, uint32_t height, uint32_t wanted, bool is_nested)
    : tiles_{width, height}, wanted_(wanted), tile_passes_(tiles_.count()) {
    if (is_nested) nested_.emplace(width, height);
    for (size_t b = 0; b < buffer_count; ++b) {
        const auto buffer = static_cast<Buffer>(b);
        // An error is estimated from the combined buffer.
        const bool is_kept =
            buffer != Buffer::error && (has(buffer) || (buffer == Buffer::combined && has(Buffer::error)));
        if (is_kept) buffers_[b].resize(size(buffer));
    }
}

void Film::set(Buffer buffer, size_t pixel, Vec3 value) {
    std::vector<float> &target = values(buffer);
    if (target.empty()) return;
    target[3 * pixel] = value.x;
    target[3 * pixel + 1] = value.y;
    target[3 * pixel + 2] = value.z;
}

void Film::set(size_t pixel, const PixelSample &sample) {
    if (std::vector<float> &combined = values(Buffer::combined); !combined.empty()) {
        const Vec3 radiance = sample.radiance();
        combined[4 * pixel] = radiance.x;
        combined[4 * pixel + 1] = radiance.y;
        combined[4 * pixel + 2] = radiance.z;
        combined[4 * pixel + 3] = sample.alpha;
    }
    if (std::vector<float> &depth = values(Buffer::depth); !depth.empty()) depth[pixel] = sample.depth;
    set(Buffer::normal, pixel, sample.normal);
    set(Buffer::position, pixel, sample.position);
    set(Buffer::albedo, pixel, sample.albedo);
    set(Buffer::emission, pixel, sample.emission);
    set(Buffer::direct, pixel, sample.direct);
    set(Buffer::indirect, pixel, sample.indirect());
    set(Buffer::specular, pixel, sample.specular);
    set(Buffer::soft_indirect, pixel, sample.soft_indirect);
    set(Buffer::caustic, pixel, sample.caustic);
    set(Buffer::background, pixel, sample.background);
    if (std::vector<float> &density = values(Buffer::photon_density); !density.empty())
        density[pixel] = sample.photon_density;
}

void Film::add(const Film &pass, const std::vector<bool> &left_out) {
    if (nested_) nested_->make_room(*pass.nested_);  // all that may fail: a pass is added as a whole
    for (size_t tile = 0; tile < tiles_.count(); ++tile) {
        if (!left_out.empty() && left_out[tile]) continue;
        for (size_t b = 0; b < buffer_count; ++b) {
            if (buffers_[b].empty() || (passes_ > 0 && is_of_first_pass(b))) continue;
            const size_t channels = buffer_channels[b];
            tiles_.visit(tile, [&](uint32_t, uint32_t, size_t pixel) {
                for (size_t i = channels * pixel; i < channels * (pixel + 1); ++i)
                    buffers_[b][i] += pass.buffers_[b][i];
            });
        }
        if (nested_) nested_->add(*pass.nested_, tile);
        ++tile_passes_[tile];
    }
    ++passes_;
}

void Film::read(Buffer buffer, std::span<float> pixels) const {
    const auto b = static_cast<size_t>(buffer);
    const std::vector<float> &source = buffers_[b];
    const size_t channels = buffer_channels[b];
    for (size_t tile = 0; tile < tiles_.count(); ++tile) {
        const bool is_summed = tile_passes_[tile] > 0 && !is_of_first_pass(b);
        const float count = is_summed ? static_cast<float>(tile_passes_[tile]) : 1.0f;
        tiles_.visit(tile, [&](uint32_t, uint32_t, size_t pixel) {
            for (size_t i = channels * pixel; i < channels * (pixel + 1); ++i) pixels[i] = source[i] / count;
        });
    }
    if (nested_ && passes_ > 0 && (buffer == Buffer::combined || buffer == Buffer::caustic))
        nested_->choose(tile_passes_, pixels, channels);
}

Vec3 Film::sum(size_t pixel) const {
    const float *combined = &buffers_[static_cast<size_t>(Buffer::combined)][4 * pixel];
    return {combined[0], combined[1], combined[2]};
}

size_t Film::memory_bytes() const {
    size_t floats = 0;
    for (const std::vector<float> &buffer : buffers_) floats += buffer.size();
    return floats * sizeof(float) + tile_passes_.size() * sizeof(uint32_t) + (nested_ ? nested_->memory_bytes() : 0);
}

}  // namespace photon_maps
