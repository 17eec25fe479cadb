// SPDX-License-Identifier: GPL-3.0-or-later
// Caustics of a picture by eight nested radii, of which each pixel's is chosen when the picture is read: a radius
// chosen from all passes, after they were traced, and fed back into none of them, does not brighten the picture as one
// does that stops where photons happen to be dense.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "levels.h"
#include "tiles.h"

namespace photon_maps {

/// Level whose estimate stands for the chosen one in a single sample: half of the largest radius.
constexpr size_t provisional_level = 5;

/// Sums over the passes. Only tiles that caustics reach take memory.
class NestedFilm {
  public:
    NestedFilm(uint32_t width, uint32_t height);

    /// Sets a pixel to one sample. Different tiles may be set by different threads.
    void set(uint32_t x, uint32_t y, const Levels &levels);
    /// Makes room for what a pass brought, a film of the same size: adding it needs no more memory then.
    void make_room(const NestedFilm &pass);
    /// Adds a tile of a pass that room was made for.
    void add(const NestedFilm &pass, size_t tile);

    /// Chooses a radius for every pixel and puts its mean over the passes in the place of the provisional level's.
    ///
    /// From the smallest radius on the intervals estimate +- deviation are intersected until nothing is left, and the
    /// last radius that agrees with all smaller ones is the pixel's (Goldenshluger and Nemirovski 1997, "On spatially
    /// adaptive estimation of nonparametric regression"). Variances are means over 3x3 pixels, and so is the index of
    /// the radius, between two of which the estimates are interpolated: pixels beside the border of a part of a frame
    /// may differ from the whole's, by two pixels at most. In a picture of some of the frame's pixels neighbours are
    /// further apart.
    /// @param passes for each tile the number of passes added
    /// @param pixels rows from the bottom; the first three of `channels` are changed
    void choose(const std::vector<uint32_t> &passes, std::span<float> pixels, size_t channels) const;

    /// Returns the place of every pixel's radius among the levels, as choose() reads it; that of the largest where no
    /// caustic is.
    /// @param passes for each tile the number of passes added
    std::vector<float> chosen_levels(const std::vector<uint32_t> &passes) const;

    /// What is known of the error of a pixel's mean brightness.
    struct Error {
        float variance = 0, provisional_variance = 0;  ///< by the chosen radius and by the provisional level
        float blur = 0;                                ///< squared error by the width of the chosen kernel, less noise
    };
    /// @param level of chosen_levels()
    Error error(uint32_t x, uint32_t y, float level, uint32_t passes) const;

    size_t memory_bytes() const;

  private:
    /// What is kept of a pixel.
    struct Sums {
        Float8 red, green, blue, variance;

        Float8 brightness() const { return (red + green + blue) / 3; }
    };
    using Tile = std::array<Sums, size_t{Tiles::side} * Tiles::side>;

    const Sums *at(uint32_t x, uint32_t y) const;
    template <typename Visit>
    void visit_around(uint32_t x, uint32_t y, const Visit &visit) const;
    Float8 variance_around(uint32_t x, uint32_t y, const std::vector<uint32_t> &passes) const;
    std::vector<float> agreeing_levels(const std::vector<uint32_t> &passes) const;

    size_t tile_of(uint32_t x, uint32_t y) const { return grid_.of_pixel(size_t{y} * grid_.width + x); }

    Tiles grid_;
    std::vector<std::unique_ptr<Tile>> tiles_;  ///< null: nothing but zero
};

}  // namespace photon_maps
