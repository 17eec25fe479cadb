// SPDX-License-Identifier: GPL-3.0-or-later
#include "nested_film.h"

#include <algorithm>
#include <cmath>

#include "relative_error.h"

namespace photon_maps {

namespace {

constexpr size_t largest_level = level_count - 1;

/// Returns the largest level whose interval meets those of all smaller ones.
size_t last_that_agrees(Float8 value, Float8 deviation) {
    const Float8 low = value - deviation, high = value + deviation;
    float highest_low = low[0], lowest_high = high[0];
    for (size_t level = 1; level < level_count; ++level) {
        highest_low = std::max(highest_low, low[level]);
        lowest_high = std::min(lowest_high, high[level]);
        if (highest_low > lowest_high) return level - 1;
    }
    return largest_level;
}

/// Returns what lies between two levels.
float interpolated(Float8 values, float level) {
    const auto below = static_cast<size_t>(level), above = std::min(below + 1, largest_level);
    return values[below] + (values[above] - values[below]) * (level - static_cast<float>(below));
}

}  // namespace

NestedFilm::NestedFilm(uint32_t width, uint32_t height) : grid_{width, height}, tiles_(grid_.count()) {}

void NestedFilm::set(uint32_t x, uint32_t y, const Levels &levels) {
    std::unique_ptr<Tile> &tile = tiles_[tile_of(x, y)];
    if (!tile) {
        if (!(max_component(levels.color(largest_level)) > 0)) return;
        tile = std::make_unique<Tile>();
    }
    (*tile)[y % Tiles::side * Tiles::side + x % Tiles::side] = {levels.red, levels.green, levels.blue, levels.variance};
}

void NestedFilm::make_room(const NestedFilm &pass) {
    for (size_t tile = 0; tile < tiles_.size(); ++tile)
        if (pass.tiles_[tile] && !tiles_[tile]) tiles_[tile] = std::make_unique<Tile>();
}

void NestedFilm::add(const NestedFilm &pass, size_t tile) {
    const std::unique_ptr<Tile> &brought = pass.tiles_[tile];
    if (!brought) return;
    for (size_t i = 0; i < brought->size(); ++i) {
        Sums &sums = (*tiles_[tile])[i];
        const Sums &added = (*brought)[i];
        sums.red += added.red;
        sums.green += added.green;
        sums.blue += added.blue;
        sums.variance += added.variance;
    }
}

const NestedFilm::Sums *NestedFilm::at(uint32_t x, uint32_t y) const {
    const Tile *tile = tiles_[tile_of(x, y)].get();
    return tile ? &(*tile)[y % Tiles::side * Tiles::side + x % Tiles::side] : nullptr;
}

/// Calls visit(u, v) for a pixel and those around it.
template <typename Visit>
void NestedFilm::visit_around(uint32_t x, uint32_t y, const Visit &visit) const {
    for (uint32_t v = std::max(y, 1u) - 1; v < std::min(y + 2, grid_.height); ++v)
        for (uint32_t u = std::max(x, 1u) - 1; u < std::min(x + 2, grid_.width); ++u) visit(u, v);
}

/// Returns the variance of each level's brightness. That no photon came does not mean that none could: with Jeffreys'
/// prior the rate of a Poisson process that brought n is n + 1/2.
Float8 NestedFilm::variance_around(uint32_t x, uint32_t y, const std::vector<uint32_t> &passes) const {
    const auto own = static_cast<float>(passes[tile_of(x, y)]);
    Float8 variance{}, brightness{};
    float count = 0;
    visit_around(x, y, [&](uint32_t u, uint32_t v) {
        ++count;
        const Sums *sums = at(u, v);
        if (!sums) return;
        // Neighbours in other tiles may have had other numbers of passes.
        const float scale = own / static_cast<float>(passes[tile_of(u, v)]);
        variance += sums->variance * scale;
        brightness += sums->brightness() * scale;
    });
    // What one photon brings to the largest radius, where most are seen, and to the others by their areas.
    const float largest = brightness[largest_level];
    const Float8 one = (largest > 0 ? variance[largest_level] / largest : 0.0f) / level_areas();
    return variance / count + 0.5f * one * one;
}

/// Returns for every pixel the largest level that agrees with all smaller ones.
std::vector<float> NestedFilm::agreeing_levels(const std::vector<uint32_t> &passes) const {
    std::vector<float> chosen(size_t{grid_.width} * grid_.height, static_cast<float>(largest_level));
    for (uint32_t y = 0; y < grid_.height; ++y) {
        for (uint32_t x = 0; x < grid_.width; ++x) {
            if (const Sums *sums = at(x, y)) {
                const Float8 deviation = sqrt(variance_around(x, y, passes));
                chosen[size_t{y} * grid_.width + x] =
                    static_cast<float>(last_that_agrees(sums->brightness(), deviation));
            }
        }
    }
    return chosen;
}

std::vector<float> NestedFilm::chosen_levels(const std::vector<uint32_t> &passes) const {
    const std::vector<float> agreeing = agreeing_levels(passes);
    std::vector<float> chosen(agreeing.size(), static_cast<float>(largest_level));
    for (uint32_t y = 0; y < grid_.height; ++y) {
        for (uint32_t x = 0; x < grid_.width; ++x) {
            if (!at(x, y)) continue;
            float sum = 0, count = 0;
            visit_around(x, y, [&](uint32_t u, uint32_t v) {
                sum += agreeing[size_t{v} * grid_.width + u];
                ++count;
            });
            chosen[size_t{y} * grid_.width + x] = sum / count;
        }
    }
    return chosen;
}

void NestedFilm::choose(const std::vector<uint32_t> &passes, std::span<float> pixels, size_t channels) const {
    const std::vector<float> chosen = chosen_levels(passes);
    for (uint32_t y = 0; y < grid_.height; ++y) {
        for (uint32_t x = 0; x < grid_.width; ++x) {
            const Sums *sums = at(x, y);
            if (!sums) continue;
            const size_t index = size_t{y} * grid_.width + x;
            const std::span pixel = pixels.subspan(index * channels, 3);
            const auto count = static_cast<float>(passes[tile_of(x, y)]);
            const auto exchange = [&](float &channel, Float8 sum) {
                const float better = interpolated(sum, chosen[index]) - sum[provisional_level];
                channel = std::max(channel + better / count, 0.0f);
            };
            exchange(pixel[0], sums->red);
            exchange(pixel[1], sums->green);
            exchange(pixel[2], sums->blue);
        }
    }
}

NestedFilm::Error NestedFilm::error(uint32_t x, uint32_t y, float level, uint32_t passes) const {
    const Sums *sums = at(x, y);
    if (!sums) return {};
    const float scale = 1 / static_cast<float>(passes);
    const Float8 variance = sums->variance * (scale * scale), value = sums->brightness() * scale;

    // The smaller of two kernels sees a part of what the larger one sees: of their difference only the rest is noise.
    constexpr float half_the_radius = 2;
    const float smaller = std::max(level - half_the_radius, 0.0f);
    const float chosen_variance = interpolated(variance, level);
    const float difference = interpolated(value, level) - interpolated(value, smaller);
    const float noise = interpolated(variance, smaller) - chosen_variance;
    return {chosen_variance, variance[provisional_level],
            blur_of_difference * blur_of_difference * (difference * difference - noise)};
}

size_t NestedFilm::memory_bytes() const {
    const auto kept = std::ranges::count_if(tiles_, [](const auto &tile) { return tile != nullptr; });
    return static_cast<size_t>(kept) * sizeof(Tile) + tiles_.size() * sizeof(tiles_[0]);
}

}  // namespace photon_maps
