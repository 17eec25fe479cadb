// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups of images against what interpolation, extension and projection are by definition.
#include <cstring>

#include "check.h"
#include "projection.h"
#include "texture.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

/// An image of floats whose pixel (x, y) is value(x, y).
template <class Value>
Image image_of(uint32_t width, uint32_t height, uint32_t channels, Value value) {
    Image image{PM_PIXEL_FLOAT32, width, height, channels, {}, {}};
    image.pixels.resize(size_t{4} * width * height * channels);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t c = 0; c < channels; ++c) {
                const float v = value(x, y, c);
                std::memcpy(&image.pixels[4 * (size_t{y * width + x} * channels + c)], &v, 4);
            }
    return image;
}

Texture texture_of(pm_interpolation interpolation, pm_extension extension) {
    return {interpolation, extension, PM_PROJECTION_FLAT, PM_ALPHA_STRAIGHT, 0, {0}, {}};
}

float red_at(const Texture &texture, const Image &image, float u, float v) {
    return look_up(texture, {&image, 1}, {u, v, 0}, {0, 0, 1}).color.x;
}

void test_halves_are_converted(Checks &checks) {
    for (uint32_t bits = 0; bits < 0x10000; ++bits) {
        const int exponent = static_cast<int>(bits >> 10 & 31u), mantissa = static_cast<int>(bits & 1023u);
        if (exponent == 31) continue;
        const double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
        checks.that(half_to_float(static_cast<uint16_t>(bits)) == (bits & 0x8000u ? -size : size), "half is exact");
    }
    checks.that(std::isinf(half_to_float(0x7c00)) && std::isnan(half_to_float(0x7e00)), "infinity and no number");
}

void test_interpolation_keeps_what_is_linear(Checks &checks) {
    const Image ramp = image_of(
        8, 4, 1, [](uint32_t x, uint32_t y, uint32_t) { return 2 * static_cast<float>(x) - static_cast<float>(y); });
    for (const pm_interpolation interpolation : {PM_INTERPOLATION_LINEAR, PM_INTERPOLATION_CUBIC}) {
        const Texture texture = texture_of(interpolation, PM_EXTENSION_EXTEND);
        for (const float x : {2.0f, 3.25f, 4.9f})  // in pixels, away from the border
            checks.near(red_at(texture, ramp, x / 8, 2.1f / 4), 2 * (x - 0.5) - 1.6, 1e-5, "a plane is kept");
    }
    const Texture closest = texture_of(PM_INTERPOLATION_CLOSEST, PM_EXTENSION_EXTEND);
    checks.near(red_at(closest, ramp, 3.99f / 8, 0.99f), 2 * 3 - 3, 0, "the pixel itself");
}

void test_the_cubic_is_a_b_spline(Checks &checks) {
    const Image impulse = image_of(9, 1, 1, [](uint32_t x, uint32_t, uint32_t) { return x == 4 ? 1.0f : 0.0f; });
    const Texture texture = texture_of(PM_INTERPOLATION_CUBIC, PM_EXTENSION_EXTEND);
    const auto at = [&](float distance) { return red_at(texture, impulse, (4.5f + distance) / 9, 0.5f); };
    checks.near(at(0), 2.0 / 3, 1e-5, "in the middle");
    checks.near(at(1), 1.0 / 6, 1e-5, "a pixel away");
    checks.near(at(-0.5f), 23.0 / 48, 1e-5, "half a pixel away");
    checks.near(at(1.5f), 1.0 / 48, 1e-5, "one and a half away");
    checks.near(at(2), 0, 1e-5, "beyond its support");
}

void test_what_is_beyond_the_border(Checks &checks) {
    const Image image = image_of(4, 1, 1, [](uint32_t x, uint32_t, uint32_t) { return 1 + static_cast<float>(x); });
    const auto at = [&](pm_extension extension, int pixel) {
        const float u = (static_cast<float>(pixel) + 0.5f) / 4;
        const float closest = red_at(texture_of(PM_INTERPOLATION_CLOSEST, extension), image, u, 0.5f);
        const float linear = red_at(texture_of(PM_INTERPOLATION_LINEAR, extension), image, u, 0.5f);
        checks.near(linear, closest, 1e-5, "at a pixel's middle both agree");
        return closest;
    };
    checks.that(at(PM_EXTENSION_REPEAT, -1) == 4 && at(PM_EXTENSION_REPEAT, 5) == 2, "repeat");
    checks.that(at(PM_EXTENSION_EXTEND, -9) == 1 && at(PM_EXTENSION_EXTEND, 9) == 4, "extend");
    checks.that(at(PM_EXTENSION_CLIP, -1) == 0 && at(PM_EXTENSION_CLIP, 4) == 0, "clip");
    checks.that(at(PM_EXTENSION_MIRROR, -1) == 1 && at(PM_EXTENSION_MIRROR, -2) == 2, "mirror below");
    checks.that(at(PM_EXTENSION_MIRROR, 4) == 4 && at(PM_EXTENSION_MIRROR, 7) == 1, "mirror above");
    checks.that(at(PM_EXTENSION_MIRROR, 8) == 1, "mirror of the mirror");
    const Texture texture = texture_of(PM_INTERPOLATION_CUBIC, PM_EXTENSION_REPEAT);
    for (const float u : {1e30f, -1e30f, std::numeric_limits<float>::quiet_NaN()})
        checks.that(std::isfinite(red_at(texture, image, u, u)), "far away is still somewhere");
}

void test_alpha_is_what_the_texture_says(Checks &checks) {
    // One pixel is half clear and its colour multiplied, one is clear.
    const Image image = image_of(2, 1, 4, [](uint32_t x, uint32_t, uint32_t c) {
        return x == 1 ? 0.0f : c == 3 ? 0.5f : 0.4f;
    });
    Texture texture = texture_of(PM_INTERPOLATION_LINEAR, PM_EXTENSION_EXTEND);
    const auto at = [&](pm_alpha alpha) {
        texture.alpha = alpha;
        return look_up(texture, {&image, 1}, {0.5f, 0.5f, 0}, {});
    };
    checks.near(at(PM_ALPHA_STRAIGHT).color.x, 0.2, 1e-6, "straight colour");
    checks.near(at(PM_ALPHA_STRAIGHT).alpha, 0.25, 1e-6, "straight alpha");
    checks.near(at(PM_ALPHA_PREMULTIPLIED).color.x, 0.8, 1e-6, "what is clear does not darken");
    checks.near(at(PM_ALPHA_PREMULTIPLIED).alpha, 0.25, 1e-6, "multiplied alpha");
    checks.near(at(PM_ALPHA_IGNORED).alpha, 1, 1e-6, "ignored alpha");
}

void test_bytes_are_decoded_by_channel(Checks &checks) {
    Image image{PM_PIXEL_UINT8, 2, 1, 3, {}, {}};
    for (const unsigned v : {0u, 100u, 255u, 10u, 100u, 255u}) image.pixels.push_back(static_cast<std::byte>(v));
    for (size_t i = 0; i < 256; ++i) {
        const auto v = static_cast<float>(i);
        image.decode[i] = {v * v, 2 * v, 3};
    }
    const Texture texture = texture_of(PM_INTERPOLATION_LINEAR, PM_EXTENSION_EXTEND);
    const Rgba middle = look_up(texture, {&image, 1}, {0.5f, 0.5f, 0}, {});
    checks.near(middle.color.x, 25, 1e-3, "bytes are mixed before they are made linear, as in Cycles");
    checks.near(middle.color.y, 200, 1e-3, "green's own table");
    checks.near(middle.color.z, 3, 1e-5, "blue's own table");
}

void test_tiles_are_found_by_their_numbers(Checks &checks) {
    const auto plain = [](float v) { return image_of(1, 1, 1, [v](uint32_t, uint32_t, uint32_t) { return v; }); };
    const std::vector<Image> images = {plain(1), plain(2), plain(3)};
    Texture texture = texture_of(PM_INTERPOLATION_LINEAR, PM_EXTENSION_REPEAT);
    texture.images = {0, 1, 2};
    texture.tiles = {1001, 1002, 1013};
    const auto at = [&](float u, float v) { return look_up(texture, images, {u, v, 0}, {}).color; };
    checks.that(at(0.5f, 0.5f).x == 1 && at(1.5f, 0.5f).x == 2 && at(2.5f, 1.5f).x == 3, "tile by column and row");
    for (const Vec3 nowhere : {at(3.5f, 0.5f), at(-1.5f, 0.5f), at(10.5f, 0.5f)})
        checks.that(nowhere == Vec3{1, 0, 1}, "pink where there is none");
}

void test_projections(Checks &checks) {
    for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.3f, -0.4f, 0.8f}, Vec3{-0.2f, 0.1f, -0.9f}}) {
        const Vec3 unit = normalize(d);
        // Back from the place by the definition: longitude falls with u, latitude rises with v.
        const Place2 place = project(PM_PROJECTION_EQUIRECTANGULAR, d);
        const float phi = (0.5f - place.u) * 2 * pi, latitude = (place.v - 0.5f) * pi;
        const Vec3 back{std::cos(latitude) * std::cos(phi), std::cos(latitude) * std::sin(phi), std::sin(latitude)};
        checks.near(length(back - unit), 0, 1e-5, "equirectangular and back");
        if (unit.y == 1) continue;  // the whole rim shows what lies behind the ball
        // The ball's normal at the place reflects the view along +y into the direction.
        const Place2 on_ball = project(PM_PROJECTION_MIRROR_BALL, d);
        const float x = 2 * on_ball.u - 1, z = 2 * on_ball.v - 1;
        const Vec3 normal{x, -std::sqrt(std::max(1 - x * x - z * z, 0.0f)), z}, view{0, 1, 0};
        checks.near(length(view - normal * (2 * dot(view, normal)) - unit), 0, 1e-3, "mirror ball and back");
    }
    const Place2 sphere = project(PM_PROJECTION_SPHERE, {0.5f, 0.5f, 1}),
                 tube = project(PM_PROJECTION_TUBE, {0.5f, 1, 0.25f});
    checks.near(sphere.v, 1, 1e-6, "the top of the sphere");
    checks.near(tube.u, 0.5, 1e-6, "the tube's middle is along +y");
    checks.near(tube.v, 0.25, 1e-6, "the tube's height");
}

void test_a_box_shows_its_sides(Checks &checks) {
    checks.that(box_weights({0, -1, 0}, 0) == Vec3{0, 1, 0}, "a side alone");
    for (const float blend : {0.0f, 0.2f, 0.7f, 1.0f})
        for (int i = 0; i < 500; ++i) {
            const auto t = static_cast<float>(i);
            const Vec3 n = normalize({std::sin(t), std::cos(3 * t) + 0.01f, std::sin(7 * t + 1)});
            const Vec3 w = box_weights(n, blend);
            checks.near(w.x + w.y + w.z, 1, 1e-5, "shares add up to 1");
            checks.that(std::min(w.x, std::min(w.y, w.z)) > -1e-5f, "none is negative");
        }
    const Vec3 even = box_weights(normalize({1, 1, 1}), 0.5f);
    checks.near(even.x, 1.0 / 3, 1e-5, "the corner shows all three alike");
}

}  // namespace

int main() {
    Checks checks;
    test_halves_are_converted(checks);
    test_interpolation_keeps_what_is_linear(checks);
    test_the_cubic_is_a_b_spline(checks);
    test_what_is_beyond_the_border(checks);
    test_alpha_is_what_the_texture_says(checks);
    test_bytes_are_decoded_by_channel(checks);
    test_tiles_are_found_by_their_numbers(checks);
    test_projections(checks);
    test_a_box_shows_its_sides(checks);
    return checks.report();
}
