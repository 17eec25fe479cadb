// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_color.h"

#include "shader_math.h"

namespace photon_maps {

namespace {

Vec3 rgb_to_hsv(Vec3 c) {
    const float value = max_component(c), least = std::min(c.x, std::min(c.y, c.z)), range = value - least;
    const float saturation = safe_divide(range, value);
    if (saturation == 0) return {0, 0, value};
    // The sector by the greatest channel, the place in it by the two others.
    float hue = c.x == value ? (c.y - c.z) / range : c.y == value ? 2 + (c.z - c.x) / range : 4 + (c.x - c.y) / range;
    hue /= 6;
    return {hue < 0 ? hue + 1 : hue, saturation, value};
}

Vec3 hsv_to_rgb(Vec3 hsv) {
    const float saturation = hsv.y, value = hsv.z;
    if (saturation == 0) return splat(value);
    const float hue = hsv.x == 1 ? 0 : hsv.x * 6, sector = std::floor(hue), f = hue - sector;
    const float p = value * (1 - saturation), q = value * (1 - saturation * f);
    const float t = value * (1 - saturation * (1 - f));
    if (sector == 0) return {value, t, p};
    if (sector == 1) return {q, value, p};
    if (sector == 2) return {p, value, t};
    if (sector == 3) return {p, q, value};
    if (sector == 4) return {t, p, value};
    return {value, p, q};
}

Vec3 rgb_to_hsl(Vec3 c) {
    const float greatest = max_component(c), least = std::min(c.x, std::min(c.y, c.z)), range = greatest - least;
    const float lightness = std::min(1.0f, (greatest + least) / 2);
    if (range == 0) return {0, 0, lightness};
    const float saturation = lightness > 0.5f ? range / (2 - greatest - least) : range / (greatest + least);
    const float hue = c.x == greatest   ? (c.y - c.z) / range + (c.y < c.z ? 6.0f : 0.0f)
                      : c.y == greatest ? (c.z - c.x) / range + 2
                                        : (c.x - c.y) / range + 4;
    return {hue / 6, saturation, lightness};
}

Vec3 hsl_to_rgb(Vec3 hsl) {
    const float h = hsl.x * 6, chroma = (1 - std::abs(2 * hsl.z - 1)) * hsl.y;
    const Vec3 pure = saturate({std::abs(h - 3) - 1, 2 - std::abs(h - 2), 2 - std::abs(h - 4)});
    return (pure - splat(0.5f)) * chroma + splat(hsl.z);
}

float overlay(float t, float a, float b) {
    return a < 0.5f ? a * (1 - t + 2 * t * b) : 1 - (1 - t + 2 * t * (1 - b)) * (1 - a);
}

float divided(float t, float a, float b) { return b != 0 ? (1 - t) * a + t * a / b : a; }

float dodge(float t, float a, float b) {
    if (a == 0) return 0;
    const float rest = 1 - t * b;
    return rest <= 0 ? 1 : std::min(a / rest, 1.0f);
}

float burn(float t, float a, float b) {
    const float rest = 1 - t + t * b;
    return rest <= 0 ? 0 : std::clamp(1 - (1 - a) / rest, 0.0f, 1.0f);
}

Vec3 soft_light(float t, Vec3 a, Vec3 b) {
    const Vec3 one = splat(1), screen = one - (one - b) * (one - a);
    return a * (1 - t) + ((one - a) * b * a + a * screen) * t;
}

/// The modes that take hue, saturation or value from the second colour; grey has no hue to give.
Vec3 blend_hsv(pm_blend mode, float t, Vec3 a, Vec3 b) {
    Vec3 hsv = rgb_to_hsv(a);
    const Vec3 other = rgb_to_hsv(b);
    switch (mode) {
        case PM_BLEND_HUE:
            return other.y == 0 ? a : mix(a, hsv_to_rgb({other.x, hsv.y, hsv.z}), t);
        case PM_BLEND_COLOR:
            return other.y == 0 ? a : mix(a, hsv_to_rgb({other.x, other.y, hsv.z}), t);
        case PM_BLEND_SATURATION:
            return hsv.y == 0 ? a : hsv_to_rgb({hsv.x, (1 - t) * hsv.y + t * other.y, hsv.z});
        default:
            return hsv_to_rgb({hsv.x, hsv.y, (1 - t) * hsv.z + t * other.z});
    }
}

/// The value beyond the ends follows the slope there.
float continued(const Table &table, float position, int channel) {
    const auto entry = [&](size_t i) { return table.entries[i].color[channel]; };
    const size_t last = table.entries.size() - 1;
    if (last == 0 || (position >= 0 && position <= 1)) return look_up(table, position).color[channel];
    const float steps = static_cast<float>(last);
    return position < 0 ? entry(0) + (entry(1) - entry(0)) * position * steps
                        : entry(last) + (entry(last) - entry(last - 1)) * (position - 1) * steps;
}

}  // namespace

Vec3 blend(pm_blend mode, float factor, Vec3 a, Vec3 b) {
    const float t = saturate(factor);
    const auto each = [&](auto function) {
        return Vec3{function(t, a.x, b.x), function(t, a.y, b.y), function(t, a.z, b.z)};
    };
    const Vec3 one = splat(1);
    switch (mode) {
        case PM_BLEND_MIX:
            return mix(a, b, t);
        case PM_BLEND_DARKEN:
            return mix(a, min(a, b), t);
        case PM_BLEND_MULTIPLY:
            return mix(a, a * b, t);
        case PM_BLEND_BURN:
            return each(burn);
        case PM_BLEND_LIGHTEN:
            return mix(a, max(a, b), t);
        case PM_BLEND_SCREEN:
            return one - (splat(1 - t) + (one - b) * t) * (one - a);
        case PM_BLEND_DODGE:
            return each(dodge);
        case PM_BLEND_ADD:
            return a + b * t;
        case PM_BLEND_OVERLAY:
            return each(overlay);
        case PM_BLEND_SOFT_LIGHT:
            return soft_light(t, a, b);
        case PM_BLEND_LINEAR_LIGHT:
            return a + (b * 2 - one) * t;
        case PM_BLEND_DIFFERENCE:
            return mix(a, abs(a - b), t);
        case PM_BLEND_EXCLUSION:
            return max(mix(a, a + b - a * b * 2, t), {});
        case PM_BLEND_SUBTRACT:
            return a - b * t;
        case PM_BLEND_DIVIDE:
            return each(divided);
        case PM_BLEND_HUE:
        case PM_BLEND_SATURATION:
        case PM_BLEND_COLOR:
        case PM_BLEND_VALUE:
            return blend_hsv(mode, t, a, b);
        case PM_BLEND_COUNT:
            break;
    }
    return {};
}

Vec3 convert(pm_convert type, Vec3 color) {
    switch (type) {
        case PM_CONVERT_RGB_TO_HSV:
            return rgb_to_hsv(color);
        case PM_CONVERT_HSV_TO_RGB:
            return hsv_to_rgb(color);
        case PM_CONVERT_RGB_TO_HSL:
            return rgb_to_hsl(color);
        case PM_CONVERT_HSL_TO_RGB:
            return hsl_to_rgb(color);
        case PM_CONVERT_COUNT:
            break;
    }
    return {};
}

Vec3 hue_saturation(float hue, float saturation, float value, float factor, Vec3 color) {
    const Vec3 hsv = rgb_to_hsv(color);
    const float turned = hsv.x + hue + 0.5f;  // the node's hue of 0.5 leaves it as it is
    const Vec3 changed = hsv_to_rgb({turned - std::floor(turned), saturate(hsv.y * saturation), hsv.z * value});
    return max(mix(color, changed, factor), {});
}

Vec3 bright_contrast(Vec3 color, float bright, float contrast) {
    return max(color * (1 + contrast) + splat(bright - contrast * 0.5f), {});
}

Vec3 gamma(Vec3 color, float exponent) {
    return by_component([exponent](float v) { return exponent == 0 ? 1 : v > 0 ? std::pow(v, exponent) : v; }, color);
}

Rgba look_up(const Table &table, float position) {
    const size_t last = table.entries.size() - 1;
    const float place = saturate(position) * static_cast<float>(last);
    const size_t i = std::min(static_cast<size_t>(place), last);
    const float t = place - static_cast<float>(i);
    const Rgba &a = table.entries[i];
    if (table.is_stepped || i == last) return a;
    const Rgba &b = table.entries[i + 1];
    return {mix(a.color, b.color, t), a.alpha * (1 - t) + b.alpha * t};
}

Vec3 curves(const Table &table, float factor, Vec3 color, float least, float greatest) {
    const auto at = [&](int channel) {
        return continued(table, safe_divide(color[channel] - least, greatest - least), channel);
    };
    return mix(color, {at(0), at(1), at(2)}, factor);
}

}  // namespace photon_maps
