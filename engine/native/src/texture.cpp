// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture.h"

#include <bit>
#include <cstring>

#include "projection.h"
#include "shader_math.h"

namespace photon_maps {

namespace {

/// Weights and places of the pixels along one axis that a look-up mixes; places outside the image are -1.
struct Taps {
    int count;
    std::array<int, 4> places;
    std::array<float, 4> weights;
};

/// Where pixel `i` of an endless row lies in an image of `size`; -1: nowhere.
int extended(pm_extension extension, int i, int size) {
    switch (extension) {
        case PM_EXTENSION_REPEAT: {
            const int rest = i % size;
            return rest < 0 ? rest + size : rest;
        }
        case PM_EXTENSION_EXTEND:
            return std::clamp(i, 0, size - 1);
        case PM_EXTENSION_CLIP:
            return i >= 0 && i < size ? i : -1;
        case PM_EXTENSION_MIRROR: {
            const int phase = (i < 0 ? -(i + 1) : i) % (2 * size);
            return phase < size ? phase : 2 * size - 1 - phase;
        }
    }
    return -1;
}

Taps taps(const Texture &texture, float coordinate, uint32_t pixel_count) {
    const int size = static_cast<int>(pixel_count);
    float place = coordinate * static_cast<float>(size);
    if (!(std::abs(place) < 1e9f)) place = 0;  // far beyond what single precision tells apart
    if (texture.interpolation != PM_INTERPOLATION_CLOSEST) place -= 0.5f;
    const float whole = std::floor(place), t = place - whole;
    const int i = static_cast<int>(whole);
    const auto at = [&](int offset) { return extended(texture.extension, i + offset, size); };
    switch (texture.interpolation) {
        case PM_INTERPOLATION_CLOSEST:
            return {1, {at(0)}, {1}};
        case PM_INTERPOLATION_LINEAR:
            return {2, {at(0), at(1)}, {1 - t, t}};
        case PM_INTERPOLATION_CUBIC:
            break;
    }
    // The cubic B-spline, which smooths and does not overshoot.
    const float s = 1 - t;
    return {4,
            {at(-1), at(0), at(1), at(2)},
            {s * s * s / 6, (t * t * (t - 2) * 3 + 4) / 6, (s * s * (s - 2) * 3 + 4) / 6, t * t * t / 6}};
}

float channel_value(const Image &image, size_t index) {
    switch (image.type) {
        case PM_PIXEL_UINT8:
            return static_cast<float>(image.pixels[index]) / 255;
        case PM_PIXEL_FLOAT16: {
            uint16_t half;
            std::memcpy(&half, &image.pixels[2 * index], sizeof half);
            return half_to_float(half);
        }
        case PM_PIXEL_FLOAT32: {
            float value;
            std::memcpy(&value, &image.pixels[4 * index], sizeof value);
            return value;
        }
    }
    return 0;
}

/// A pixel as it is stored, bytes as shares of 255.
Rgba stored_pixel(const Image &image, int x, int y) {
    const size_t first = (static_cast<size_t>(y) * image.width + static_cast<size_t>(x)) * image.channels;
    const float red = channel_value(image, first);
    if (image.channels == 1) return {splat(red), 1};
    return {{red, channel_value(image, first + 1), channel_value(image, first + 2)},
            image.channels == 4 ? channel_value(image, first + 3) : 1};
}

/// The linear values of bytes' shares, which interpolation has left between entries.
Vec3 decoded(const Image &image, Vec3 shares) {
    const auto at = [&](float share, size_t channel) {
        const float place = saturate(share) * 255;
        const size_t i = std::min(static_cast<size_t>(place), size_t{254});
        const float t = place - static_cast<float>(i);
        return image.decode[i][channel] * (1 - t) + image.decode[i + 1][channel] * t;
    };
    return {at(shares.x, 0), at(shares.y, 1), at(shares.z, 2)};
}

/// Pixels are mixed as stored, then divided by alpha, and made linear last, as Cycles does it.
Rgba look_up_image(const Texture &texture, const Image &image, float u, float v) {
    const Taps columns = taps(texture, u, image.width), rows = taps(texture, v, image.height);
    Rgba sum{{}, 0};
    for (int row = 0; row < rows.count; ++row) {
        for (int column = 0; column < columns.count; ++column) {
            const int x = columns.places[static_cast<size_t>(column)], y = rows.places[static_cast<size_t>(row)];
            if (x < 0 || y < 0) continue;
            const float weight = columns.weights[static_cast<size_t>(column)] * rows.weights[static_cast<size_t>(row)];
            const Rgba pixel = stored_pixel(image, x, y);
            sum.color += pixel.color * weight;
            sum.alpha += (texture.alpha == PM_ALPHA_IGNORED ? 1 : pixel.alpha) * weight;
        }
    }
    if (texture.alpha == PM_ALPHA_PREMULTIPLIED && sum.alpha != 0) sum.color = sum.color / sum.alpha;
    if (image.type == PM_PIXEL_UINT8) sum.color = decoded(image, sum.color);
    return sum;
}

/// What Blender shows where an image is missing.
constexpr Rgba missing{{1, 0, 1}, 1};

Rgba look_up_tile(const Texture &texture, std::span<const Image> images, Place2 place) {
    if (texture.tiles.empty()) return look_up_image(texture, images[texture.images[0]], place.u, place.v);
    if (!(place.u > -1 && place.u < 10 && place.v > -1 && place.v < 100)) return missing;
    const float column = std::trunc(place.u), row = std::trunc(place.v);
    const auto number = static_cast<uint32_t>(1001 + 10 * row + column);
    for (size_t i = 0; i < texture.tiles.size(); ++i)
        if (texture.tiles[i] == number)
            return look_up_image(texture, images[texture.images[i]], place.u - column, place.v - row);
    return missing;
}

}  // namespace

float half_to_float(uint16_t half) {
    // Shifted into place, the exponent is 112 too small; the product mends it for numbers below the normal ones, too.
    const uint32_t magnitude = half & 0x7fffu, sign = (half & 0x8000u) << 16;
    const bool is_finite = magnitude < 0x7c00u;
    const float value = is_finite ? std::bit_cast<float>(magnitude << 13) * 0x1p112f
                                  : std::bit_cast<float>(0x7f800000u | magnitude << 13);
    return std::bit_cast<float>(std::bit_cast<uint32_t>(value) | sign);
}

Rgba look_up(const Texture &texture, std::span<const Image> images, Vec3 position, Vec3 normal) {
    if (texture.projection != PM_PROJECTION_BOX)
        return look_up_tile(texture, images, project(texture.projection, position));
    Rgba sum{{}, 0};
    const Vec3 weights = box_weights(normal, texture.blend);
    for (int axis = 0; axis < 3; ++axis) {
        if (weights[axis] <= 0) continue;
        const Rgba side = look_up_tile(texture, images, project_on_side(position, normal, axis));
        sum.color += side.color * weights[axis];
        sum.alpha += side.alpha * weights[axis];
    }
    return sum;
}

}  // namespace photon_maps
