// SPDX-License-Identifier: GPL-3.0-or-later
// Lenses against the closed forms of their apertures, panoramas against spherical coordinates.
#include <string>
#include <vector>

#include "camera.h"
#include "check.h"

using namespace photon_maps;

namespace {

constexpr int steps = 1024;

/// A camera at (3, -2, 5) that looks along +x with z up: its axes are -y, z, -x.
Camera camera_of(pm_camera_type type) {
    Camera camera;
    camera.type = type;
    camera.transform = {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {3, -2, 5}};
    camera.left = -0.4f;
    camera.right = 0.6f;
    camera.bottom = -0.3f;
    camera.top = 0.5f;
    camera.frame_width = 20;
    camera.frame_height = 16;
    camera.x = camera.y = 0;
    camera.width = 20;
    camera.height = 16;
    camera.clip_start = 0.25f;
    camera.clip_end = 50;
    camera.focus_distance = 4;
    return camera;
}

/// A vector of the world in the axes of camera_of.
Vec3 local(Vec3 v) { return {-v.y, v.z, -v.x}; }

/// Calls `visit` with the points of the lens in units of its radius, the anamorphic ratio taken off.
template <typename Visit>
void for_each_lens_point(const Camera &camera, Visit visit) {
    const Camera pinhole = camera_of(PM_CAMERA_PERSPECTIVE);
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const Vec2 lens{(static_cast<float>(i) + 0.5f) / steps, (static_cast<float>(j) + 0.5f) / steps};
            const Vec3 offset = local(camera.ray({7, 3}, lens).origin - pinhole.ray({7, 3}, lens).origin);
            visit(Vec2{offset.x / camera.aperture_radius * camera.aperture_ratio, offset.y / camera.aperture_radius},
                  offset.z);
        }
    }
}

void check_round_aperture(test::Checks &checks) {
    Camera camera = camera_of(PM_CAMERA_PERSPECTIVE);
    camera.aperture_radius = 0.3f;
    camera.aperture_ratio = 2;
    double second_moment = 0, farthest = 0, off_plane = 0;
    for_each_lens_point(camera, [&](Vec2 p, float z) {
        const double squared = double{p.x} * double{p.x} + double{p.y} * double{p.y};
        second_moment += squared / (steps * steps);
        farthest = std::max(farthest, std::sqrt(squared));
        off_plane = std::max(off_plane, double{std::abs(z)});
    });
    checks.near(second_moment, 0.5, 1e-3, "mean square of the radius of a disk");
    checks.near(farthest, 1, 0.01, "radius of the lens");
    checks.near(off_plane, 0, 1e-6, "the lens is a plane");
}

void check_polygon(test::Checks &checks, uint32_t blades, float rotation) {
    const std::string name = std::to_string(blades) + " blades";
    Camera camera = camera_of(PM_CAMERA_PERSPECTIVE);
    camera.aperture_radius = 0.3f;
    camera.aperture_ratio = 0.5f;
    camera.aperture_blades = blades;
    camera.aperture_rotation = rotation;
    const double half = std::numbers::pi / blades;

    // How far it reaches towards its corners and its sides.
    std::vector<double> corners(blades, 0), sides(blades, 0);
    double second_moment = 0, inside_half = 0;
    for_each_lens_point(camera, [&](Vec2 p, float) {
        double side_reach = 0;
        for (uint32_t k = 0; k < blades; ++k) {
            const double side = double{rotation} + 2 * half * k, corner = side + half;
            corners[k] = std::max(corners[k], double{p.x} * std::cos(corner) + double{p.y} * std::sin(corner));
            const double reach = double{p.x} * std::cos(side) + double{p.y} * std::sin(side);
            sides[k] = std::max(sides[k], reach);
            side_reach = std::max(side_reach, reach);
        }
        if (side_reach < std::cos(half) / 2) inside_half += 1.0 / (steps * steps);
        second_moment += (double{p.x} * double{p.x} + double{p.y} * double{p.y}) / (steps * steps);
    });
    for (uint32_t k = 0; k < blades; ++k) {
        checks.near(corners[k], 1, 0.03, name + ": corner");
        checks.near(sides[k], std::cos(half), 0.004, name + ": side");
    }
    // The polar second moment of a regular polygon over its area.
    checks.near(second_moment, (2 + std::cos(2 * half)) / 6, 2e-3, name + ": mean square of the radius");
    checks.near(inside_half, 0.25, 0.01, name + ": share in the polygon of half the size");
}

void check_focus(test::Checks &checks, pm_camera_type type) {
    Camera camera = camera_of(type);
    const Ray pinhole = camera.ray({13.5f, 2.25f}, {0, 0});
    const Vec3 expected = pinhole.origin + pinhole.direction * camera.focus_distance;
    camera.aperture_radius = 0.5f;
    camera.aperture_blades = 6;
    for (const Vec2 lens : {Vec2{0.1f, 0.9f}, Vec2{0.55f, 0.5f}, Vec2{0.99f, 0.01f}, Vec2{0.7f, 0.3f}}) {
        const Ray ray = camera.ray({13.5f, 2.25f}, lens);
        const Vec3 focus = ray.origin + ray.direction * camera.focus_distance;
        checks.near(double{length(focus - expected)}, 0, 5e-6, "rays of a pixel meet in the plane of focus");
        checks.that(length(ray.origin - pinhole.origin) > 0.01f, "rays start all over the lens");
        const Vec3 forward = type == PM_CAMERA_EQUIRECTANGULAR ? pinhole.direction : Vec3{1, 0, 0};
        checks.near(double{dot(ray.direction, forward)}, 1, 1e-6, "a length of the direction is one unit of depth");
        checks.near(double{dot(ray.origin - pinhole.origin, forward)}, 0, 1e-6, "the lens stands square to the view");
        checks.that(ray.near == camera.clip_start && ray.far == camera.clip_end, "clip distances");
    }
}

void check_panorama(test::Checks &checks) {
    Camera camera = camera_of(PM_CAMERA_EQUIRECTANGULAR);
    camera.left = -pi;
    camera.right = pi;
    camera.bottom = -pi / 2;
    camera.top = pi / 2;
    const auto direction = [&](float x, float y) { return local(camera.ray({x * 20, y * 16}, {0, 0}).direction); };
    const auto same = [&](Vec3 a, Vec3 b, const char *what) { checks.near(double{length(a - b)}, 0, 1e-6, what); };
    same(direction(0.5f, 0.5f), {0, 0, -1}, "the middle is straight ahead");
    same(direction(0.75f, 0.5f), {1, 0, 0}, "right of it is right");
    same(direction(0.25f, 0.5f), {-1, 0, 0}, "left of it is left");
    same(direction(0, 0.5f), {0, 0, 1}, "the border is behind");
    same(direction(0.3f, 1), {0, 1, 0}, "the top is up");
    same(direction(0.5f, 0.75f), {0, std::sqrt(0.5f), -std::sqrt(0.5f)}, "between ahead and up");
    const Ray ahead = camera.ray({10, 8}, {0.5f, 0.5f});
    same(ahead.origin, {3, -2, 5}, "a panorama has one point of view");
    camera.aperture_radius = 0.1f;
    checks.that(is_finite(camera.ray({10, 8}, {0.1f, 0.2f}).origin), "a lens straight ahead");
}

void check_footprints(test::Checks &checks) {
    for (const auto &[type, depth_counts] :
         {std::pair{PM_CAMERA_PERSPECTIVE, true}, {PM_CAMERA_ORTHOGRAPHIC, false}, {PM_CAMERA_EQUIRECTANGULAR, true}}) {
        const Camera camera = camera_of(type);
        // Two neighbours, at the middle of the frame's window.
        const Ray a = camera.ray({8, 6}, {0, 0}), b = camera.ray({9, 6}, {0, 0}), c = camera.ray({8, 7}, {0, 0});
        const auto at = [](const Ray &ray) { return ray.origin + ray.direction * 10.0f; };
        const double area = double{length(cross(at(b) - at(a), at(c) - at(a)))};
        const double side = double{camera.footprint(10)};
        checks.near(side * side, area, 0.01 * area, "area that a pixel sees");
        checks.near(double{camera.footprint(20)}, depth_counts ? 2 * side : side, 1e-6, "footprint by depth");
    }
}

/// Samples of a pixel filter lie about its middle, as wide as the filter reaches.
void check_pixel_filters(test::Checks &checks) {
    for (const auto &[filter, reach] : {std::pair{PixelFilter::box, 1.0}, std::pair{PixelFilter::gaussian, 3.0},
                                        std::pair{PixelFilter::blackman_harris, 2.0}}) {
        constexpr float width = 1.5f;
        const PixelSampler sampler(filter, width);
        const Vec2 middle = sampler.sample(0.5f, 0.5f), lowest = sampler.sample(0, 0), highest = sampler.sample(1, 1);
        checks.near(double{middle.x}, 0, 0.01, "a pixel filter lies about its middle");
        checks.near(double{lowest.x + highest.x}, 0, 0.01, "a pixel filter is the same on both sides");
        checks.that(double{highest.y} <= reach * double{width} / 2 + 1e-6, "a pixel filter ends where it should");
    }
}

}  // namespace

int main() {
    test::Checks checks;
    check_round_aperture(checks);
    for (const uint32_t blades : {3u, 5u, 8u}) check_polygon(checks, blades, 0.4f);
    for (const pm_camera_type type : {PM_CAMERA_PERSPECTIVE, PM_CAMERA_ORTHOGRAPHIC, PM_CAMERA_EQUIRECTANGULAR})
        check_focus(checks, type);
    check_panorama(checks);
    check_footprints(checks);
    check_pixel_filters(checks);
    return checks.report();
}
