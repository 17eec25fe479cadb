// SPDX-License-Identifier: GPL-3.0-or-later
#include "film.h"

namespace photon_maps {

namespace {

bool is_of_first_pass(size_t buffer) {
    return buffer == static_cast<size_t>(Buffer::depth) || buffer == static_cast<size_t>(Buffer::position);
}

}  // namespace

Film::Film(uint32_t width, uint32_t height, uint32_t wanted) : pixels_(size_t{width} * height) {
    for (size_t b = 0; b < buffer_count; ++b)
        if ((wanted >> b) & 1) buffers_[b].resize(pixels_ * buffer_channels[b]);
}

void Film::set(Buffer buffer, size_t pixel, Vec3 value) {
    std::vector<float> &target = buffers_[static_cast<size_t>(buffer)];
    if (target.empty()) return;
    target[3 * pixel] = value.x;
    target[3 * pixel + 1] = value.y;
    target[3 * pixel + 2] = value.z;
}

void Film::set(size_t pixel, const PixelSample &sample) {
    if (std::vector<float> &combined = buffers_[static_cast<size_t>(Buffer::combined)]; !combined.empty()) {
        const Vec3 radiance = sample.radiance();
        combined[4 * pixel] = radiance.x;
        combined[4 * pixel + 1] = radiance.y;
        combined[4 * pixel + 2] = radiance.z;
        combined[4 * pixel + 3] = sample.alpha;
    }
    if (std::vector<float> &depth = buffers_[static_cast<size_t>(Buffer::depth)]; !depth.empty())
        depth[pixel] = sample.depth;
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
    if (std::vector<float> &density = buffers_[static_cast<size_t>(Buffer::photon_density)]; !density.empty())
        density[pixel] = sample.photon_density;
}

void Film::add(const Film &pass) {
    for (size_t b = 0; b < buffer_count; ++b) {
        if (passes_ > 0 && is_of_first_pass(b)) continue;
        for (size_t i = 0; i < buffers_[b].size(); ++i) buffers_[b][i] += pass.buffers_[b][i];
    }
    ++passes_;
}

void Film::read(Buffer buffer, std::span<float> pixels) const {
    const bool summed = passes_ > 0 && !is_of_first_pass(static_cast<size_t>(buffer));
    const float count = summed ? static_cast<float>(passes_) : 1.0f;
    const std::vector<float> &source = values(buffer);
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = source[i] / count;
}

size_t Film::memory_bytes() const {
    size_t floats = 0;
    for (const std::vector<float> &buffer : buffers_) floats += buffer.size();
    return floats * sizeof(float);
}

}  // namespace photon_maps
