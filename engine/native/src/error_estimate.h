// SPDX-License-Identifier: GPL-3.0-or-later
// How far a picture still is from the converged one, as far as its own passes tell: noise from the variance between
// them, blur from what kernels of half the radius would change.
#pragma once

#include "film.h"
#include "relative_error.h"

namespace photon_maps {

/// Follows a picture pass by pass. Errors are relative (relative_error.h), and root mean squares over channels and
/// pixels, the worst thousandth left out.
class ErrorEstimate {
  public:
    ErrorEstimate(uint32_t width, uint32_t height);

    /// Whether a pixel's samples are to tell their blur; a regular few do.
    bool is_probe(uint32_t x, uint32_t y) const { return x % stride_ == stride_ / 2 && y % stride_ == stride_ / 2; }
    /// Takes what a probe of the present pass saw; pixels may come from any thread.
    void set_blur(uint32_t x, uint32_t y, Vec3 blur) { pass_blur_[probe(x, y)] = blur; }

    /// Counts a pass.
    /// @param film with that pass
    /// @param left_out the tiles that it lacks
    void add(const Film &film, const Film &pass, const std::vector<bool> &left_out);

    /// Relative standard error of the picture; infinite before the second pass, as nothing is known then. Like all
    /// that follows it is up to date after 2 to 16 passes, and then behind by an eighth of the passes at most.
    float noise() const { return noise_; }
    /// Relative error by the width of the kernels, which no further pass of the same radius would take away.
    float blur() const { return blur_; }
    float error() const { return std::sqrt(noise() * noise() + blur() * blur()); }

    /// Relative standard error of a tile: the root mean square over its pixels.
    float tile_noise(size_t tile) const { return std::sqrt(std::max(tile_squares_[tile], 0.0f)); }
    /// Copies the relative standard error of each pixel; zero before the second pass.
    void read(std::span<float> pixels) const;
    size_t memory_bytes() const;

  private:
    /// Sum over the passes of what one pixel brought, and of its squares.
    struct Moments {
        Vec3 sum, squares;
    };

    size_t probe(uint32_t x, uint32_t y) const { return size_t{y / stride_} * probe_columns_ + x / stride_; }
    void find_floor(const Film &film);
    float relative(Vec3 square, Vec3 mean) const { return relative_square(square, mean, floor_); }
    void estimate_noise(const Film &film);
    void compare_halves(const Film &film);
    void estimate_blur(const Film &film);
    void add_nested(const Film &film);
    void sum_up();
    float pixel_square(size_t pixel) const { return gain_ * pixel_squares_[pixel] + nested_squares_[pixel]; }

    Tiles tiles_;
    uint32_t stride_, probe_columns_;
    uint32_t passes_ = 0;
    std::vector<Vec3> squares_;    ///< sum over the passes of a pixel's squared radiance
    std::vector<Vec3> half_;       ///< sum over the passes up to the last power of two
    std::vector<Vec3> pass_blur_;  ///< of the present pass, by probe
    std::vector<Moments> probes_;
    std::vector<float> pixel_squares_;   ///< relative variance of each pixel's mean, as if passes were independent
    std::vector<float> nested_squares_;  ///< what choosing among nested radii adds to each pixel's square, or takes off
    std::vector<float> tile_squares_;    ///< mean of both together
    float floor_ = 0;                    ///< squared
    float noise_ = infinity;
    /// Passes stratify each other: by how much less their mean varies than that of independent ones, when last
    /// measured; how that goes on with each doubling; and after how many passes it was measured.
    float measured_gain_ = 1, decay_ = 1;
    uint32_t measured_at_ = 1;
    float halves_ratio_ = 1;  ///< of the halves' difference to that of independent passes
    float gain_ = 1;          ///< now
    float blur_ = 0;
};

}  // namespace photon_maps
