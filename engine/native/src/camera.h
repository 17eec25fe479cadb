// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "sampling.h"
#include "scene.h"

namespace photon_maps {

/// The weight of a point by its distance from the pixel's centre.
enum class PixelFilter : uint32_t { box = 0, gaussian = 1, blackman_harris = 2 };

/// An offset from a pixel's centre, in pixels, with the filter's own density: samples then count equally, and a pixel
/// depends on no other (Ernst et al. 2006, filter importance sampling).
class PixelSampler {
  public:
    /// @param width of the filter in pixels as Blender gives it, > 0; Blackman-Harris reaches over two, a Gaussian
    /// over three
    PixelSampler(PixelFilter filter, float width);

    Vec2 sample(float u, float v) const { return {offset(u), offset(v)}; }

  private:
    float offset(float u) const;

    static constexpr size_t steps = 1024;
    std::array<float, steps + 1> inverse_{};  ///< inverse of the filter's cumulative distribution
};

/// The camera, the frame it fills and the region of it that is rendered.
struct Camera {
    pm_camera_type type = PM_CAMERA_PERSPECTIVE;
    Transform transform;             ///< camera to world, rigid; looks along -z
    float left, right, bottom, top;  ///< window of the whole frame at z = -1, in scene units, or in radians
    uint32_t frame_width, frame_height;
    uint32_t x, y, width, height;  ///< region: its first pixel, and how many; y counts from the bottom
    uint32_t stride = 1;           ///< of the frame's pixels that a pixel of the region stands for, along each axis
    float clip_start, clip_end;    ///< depths: along the view direction, of a panorama distances
    float aperture_radius = 0, focus_distance = 1, aperture_rotation = 0, aperture_ratio = 1;
    uint32_t aperture_blades = 0;

    /// The pixel of the frame that one of the region is: not the same of all that each stands for, so that edges along
    /// rows and columns of the frame have their share.
    std::array<uint32_t, 2> frame_pixel(uint32_t column, uint32_t row) const {
        return {std::min(x + column * stride + row % stride, frame_width - 1),
                std::min(y + row * stride + column % stride, frame_height - 1)};
    }

    /// The ray through a point of the frame and a point of the lens; a length of its direction is one unit of depth.
    /// @param pixel a point of the frame in pixels
    /// @param lens two numbers in [0, 1), uniform over the aperture; without one they do not count
    Ray ray(Vec2 pixel, Vec2 lens) const;

    /// The side of a square as large as what one pixel sees, square to the view, at a depth in scene units.
    float footprint(float depth) const;
};

}  // namespace photon_maps
