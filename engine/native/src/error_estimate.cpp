// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_estimate.h"

#include <bit>

namespace photon_maps {

namespace {

constexpr double probe_count = 4096;

/// By how much the mean of n passes varies more than it would if its variance went on as at n = doubling <= n, a power
/// of two, by half for each doubling: it is the mean of stretches of the low-discrepancy sequence whose lengths are
/// powers of two, the longer the more evenly spread.
/// @param decay by how much more than half the variance of a stretch falls with its doubling
float between_doublings(uint32_t n, uint32_t doubling, float decay) {
    float sum = 0;
    float variance = 1;  // of a stretch, over that of `doubling` passes
    for (uint32_t length = doubling; length > 0; length /= 2) {
        if (n & length) sum += static_cast<float>(length) * static_cast<float>(length) * variance;
        variance *= 2 / decay;
    }
    return sum / (static_cast<float>(n) * static_cast<float>(doubling));
}

bool is_power_of_two(uint32_t n) { return (n & (n - 1)) == 0; }

/// Errors fall slowly: to look at all pixels after one pass of eight is enough, once there are many.
bool is_time_to_look(uint32_t passes) {
    constexpr uint32_t looks_between_doublings = 8;
    return passes > 1 && passes % std::max(std::bit_floor(passes) / looks_between_doublings, 1u) == 0;
}

}  // namespace

ErrorEstimate::ErrorEstimate(uint32_t width, uint32_t height)
    : tiles_{width, height},
      stride_(static_cast<uint32_t>(std::max(1.0, std::sqrt(static_cast<double>(width) * height / probe_count)))),
      probe_columns_((width + stride_ - 1) / stride_),
      squares_(size_t{width} * height),
      half_(squares_.size()),
      pass_blur_(size_t{probe_columns_} * ((height + stride_ - 1) / stride_)),
      probes_(pass_blur_.size()),
      pixel_squares_(squares_.size()),
      nested_squares_(squares_.size()),
      tile_squares_(tiles_.count()) {}

void ErrorEstimate::add(const Film &film, const Film &pass, const std::vector<bool> &left_out) {
    // What the pass saw.
    for (size_t tile = 0; tile < tiles_.count(); ++tile) {
        if (left_out[tile]) continue;
        tiles_.visit(tile, [&](uint32_t x, uint32_t y, size_t pixel) {
            const Vec3 radiance = pass.sum(pixel);
            squares_[pixel] += radiance * radiance;
            if (!is_probe(x, y)) return;
            const Vec3 blur = pass_blur_[probe(x, y)];
            probes_[probe(x, y)].sum += blur;
            probes_[probe(x, y)].squares += blur * blur;
        });
    }

    // What all passes tell.
    ++passes_;
    if (is_time_to_look(passes_)) {
        find_floor(film);
        estimate_noise(film);
        if (is_power_of_two(passes_)) compare_halves(film);
        gain_ = measured_gain_ * between_doublings(passes_, measured_at_, decay_);
        estimate_blur(film);
        if (film.nested()) add_nested(film);
        sum_up();
    }
    if (is_power_of_two(passes_))
        for (size_t pixel = 0; pixel < half_.size(); ++pixel) half_[pixel] = film.sum(pixel);
}

void ErrorEstimate::find_floor(const Film &film) {
    std::vector<Vec3> means(squares_.size());
    for (size_t pixel = 0; pixel < means.size(); ++pixel)
        means[pixel] = film.sum(pixel) / static_cast<float>(film.passes_of(tiles_.of_pixel(pixel)));
    floor_ = squared_floor(means);
}

void ErrorEstimate::estimate_noise(const Film &film) {
    for (size_t pixel = 0; pixel < squares_.size(); ++pixel) {
        const uint32_t n = film.passes_of(tiles_.of_pixel(pixel));
        const Vec3 total = film.sum(pixel);
        pixel_squares_[pixel] = relative(variance_of_mean(total, squares_[pixel], n), total / static_cast<float>(n));
    }
}

/// Passes take consecutive stretches of one low-discrepancy sequence: the mean of twice as many varies by less than
/// half as much. By how much less cannot be told from the variance between passes, but from how the two halves
/// differ. If the variance of the mean falls by rho with each doubling, a quarter of the halves' squared difference is
/// V(n / 2) - V(n) = V(n) (1 - rho) / rho.
void ErrorEstimate::compare_halves(const Film &film) {
    std::vector<float> halves, independent;
    const auto passes = static_cast<float>(passes_);
    for (size_t tile = 0; tile < tiles_.count(); ++tile) {
        if (film.passes_of(tile) != passes_) continue;
        tiles_.visit(tile, [&](uint32_t, uint32_t, size_t pixel) {
            const Vec3 total = film.sum(pixel), first = half_[pixel];
            const Vec3 difference = (total - first * 2) / passes;
            halves.push_back(relative(difference * difference, total / passes));
            independent.push_back(pixel_squares_[pixel]);
        });
    }
    const float expected = trimmed_mean(independent);
    if (!(expected > 0)) {  // nothing varies, or all is done: what was measured last holds on
        measured_gain_ = gain_;
        measured_at_ = passes_;
        return;
    }
    const float ratio = trimmed_mean(halves) / expected;
    constexpr float usual_decay = 0.85f, least_decay = 0.4f;
    if (passes_ == 2) {
        decay_ = usual_decay;  // it takes four to tell
    } else if (halves_ratio_ > 0) {
        const float decay = std::clamp(ratio / halves_ratio_, least_decay, 1.0f);
        // The more passes, the less they stratify each other further.
        decay_ = (1 + (passes_ == 4 ? decay : (decay_ * 2 - 1 + decay) / 2)) / 2;
    }
    halves_ratio_ = ratio;
    measured_gain_ = ratio * decay_ / (2 - decay_);
    measured_at_ = passes_;
}

/// From what kernels of half the radius take away, less the noise of that difference.
void ErrorEstimate::estimate_blur(const Film &film) {
    std::vector<float> squares;
    for (uint32_t y = stride_ / 2; y < tiles_.height; y += stride_)
        for (uint32_t x = stride_ / 2; x < tiles_.width; x += stride_) {
            const size_t pixel = size_t{y} * tiles_.width + x;
            const uint32_t n = film.passes_of(tiles_.of_pixel(pixel));
            const auto passes = static_cast<float>(n);
            const Moments &moments = probes_[probe(x, y)];
            const Vec3 mean = moments.sum / passes;
            const Vec3 noise = variance_of_mean(moments.sum, moments.squares, n);
            squares.push_back(relative(mean * mean - noise, film.sum(pixel) / passes));
        }
    blur_ = blur_of_difference * std::sqrt(std::max(0.0f, trimmed_mean(squares)));
}

/// Where caustics are read by another radius than the passes' own, that one's variance takes the place of theirs, and
/// its blur counts too.
void ErrorEstimate::add_nested(const Film &film) {
    const std::vector<float> levels = film.nested()->chosen_levels(film.tile_passes());
    std::vector<float> blur(squares_.size());
    for (size_t pixel = 0; pixel < squares_.size(); ++pixel) {
        const auto x = static_cast<uint32_t>(pixel % tiles_.width), y = static_cast<uint32_t>(pixel / tiles_.width);
        const uint32_t n = film.passes_of(tiles_.of_pixel(pixel));
        const NestedFilm::Error error = film.nested()->error(x, y, levels[pixel], n);
        const Vec3 mean = film.sum(pixel) / static_cast<float>(n);
        const float change = error.variance - gain_ * error.provisional_variance;
        nested_squares_[pixel] = relative({change, change, change}, mean);
        blur[pixel] = relative({error.blur, error.blur, error.blur}, mean);
    }
    blur_ = std::sqrt(std::max(0.0f, blur_ * blur_ + trimmed_mean(blur)));
}

void ErrorEstimate::sum_up() {
    std::vector<float> squares(squares_.size());
    for (size_t tile = 0; tile < tiles_.count(); ++tile) {
        float sum = 0, count = 0;
        tiles_.visit(tile, [&](uint32_t, uint32_t, size_t pixel) {
            squares[pixel] = pixel_square(pixel);
            sum += squares[pixel];
            ++count;
        });
        tile_squares_[tile] = sum / count;
    }
    noise_ = std::sqrt(std::max(0.0f, trimmed_mean(squares)));
}

void ErrorEstimate::read(std::span<float> pixels) const {
    for (size_t pixel = 0; pixel < pixels.size(); ++pixel)
        pixels[pixel] = std::sqrt(std::max(0.0f, pixel_square(pixel)));
}

size_t ErrorEstimate::memory_bytes() const {
    return (squares_.size() + half_.size() + pass_blur_.size() + 2 * probes_.size()) * sizeof(Vec3) +
           (pixel_squares_.size() + nested_squares_.size() + tile_squares_.size()) * sizeof(float);
}

}  // namespace photon_maps
