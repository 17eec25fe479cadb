// SPDX-License-Identifier: GPL-3.0-or-later
// Images in their own depth, and how they are looked up; functions of a number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "photon_maps.h"
#include "vec.h"

namespace photon_maps {

/// A colour with alpha.
struct Rgba {
    Vec3 color;
    float alpha = 1;
};

/// A raster, rows from the bottom.
struct Image {
    pm_pixel_type type;
    uint32_t width, height, channels;
    std::vector<std::byte> pixels;
    std::array<std::array<float, 3>, 256> decode;  ///< uint8: linear values
};

struct Texture {
    pm_interpolation interpolation;
    pm_extension extension;
    pm_projection projection;
    pm_alpha alpha;
    float blend;
    std::vector<uint32_t> images;
    std::vector<uint32_t> tiles;  ///< UDIM numbers; empty: one image without tiles
};

/// A function of 0 ... 1 by its values at equal steps.
struct Table {
    bool is_stepped;
    std::vector<Rgba> entries;
};

/// Looks a texture up.
/// @param normal unit, in the object's space: box projection alone asks for it
Rgba look_up(const Texture &texture, std::span<const Image> images, Vec3 position, Vec3 normal);

/// Converts an IEEE half precision number.
float half_to_float(uint16_t half);

}  // namespace photon_maps
