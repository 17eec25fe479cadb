// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of shaders: blend modes, colour models, curves and ramps.
#pragma once

#include "photon_maps_shader.h"
#include "texture.h"
#include "vec.h"

namespace photon_maps {

/// Luminance of linear Rec. 709 colour, white's being 1.
constexpr float luminance(Vec3 c) { return 0.21263901f * c.x + 0.71516868f * c.y + 0.07219232f * c.z; }

/// PM_OP_BLEND.
Vec3 blend(pm_blend mode, float factor, Vec3 a, Vec3 b);
/// PM_OP_CONVERT.
Vec3 convert(pm_convert type, Vec3 color);
/// PM_OP_HUE_SATURATION.
Vec3 hue_saturation(float hue, float saturation, float value, float factor, Vec3 color);
/// PM_OP_BRIGHT_CONTRAST.
Vec3 bright_contrast(Vec3 color, float bright, float contrast);
/// PM_OP_GAMMA.
Vec3 gamma(Vec3 color, float exponent);
/// PM_OP_TABLE: at a number from 0 to 1, which is clamped.
Rgba look_up(const Table &table, float position);
/// PM_OP_CURVES.
Vec3 curves(const Table &table, float factor, Vec3 color, float least, float greatest);

}  // namespace photon_maps
