// SPDX-License-Identifier: GPL-3.0-or-later
// The squares that a picture is rendered in: neighbouring pixels gather the same photons.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace photon_maps {

/// Squares of pixels, row by row from the bottom left; those at the right and the top may be smaller.
struct Tiles {
    static constexpr uint32_t side = 16;

    uint32_t width, height;  ///< of the picture in pixels

    uint32_t columns() const { return (width + side - 1) / side; }
    uint32_t rows() const { return (height + side - 1) / side; }
    size_t count() const { return size_t{columns()} * rows(); }
    size_t of_pixel(size_t pixel) const { return pixel / width / side * columns() + pixel % width / side; }

    /// Calls visit(x, y, pixel) for the pixels of a tile, row by row.
    template <typename Visit>
    void visit(size_t tile, Visit &&visit) const {
        const auto x0 = static_cast<uint32_t>(tile % columns()) * side,
                   y0 = static_cast<uint32_t>(tile / columns()) * side;
        for (uint32_t y = y0; y < std::min(y0 + side, height); ++y)
            for (uint32_t x = x0; x < std::min(x0 + side, width); ++x) visit(x, y, size_t{y} * width + x);
    }
};

}  // namespace photon_maps
