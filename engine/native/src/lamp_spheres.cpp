// SPDX-License-Identifier: GPL-3.0-or-later
#include "lamp_spheres.h"

namespace photon_maps {

namespace {

/// Spheres are larger than what they hold by this share, for rounding errors of their own size.
constexpr float widening = 1.01f;

/// Rounding errors of distances along a ray, and squared 100 times those of distances from it, as shares of the
/// distance (squared): (r + e)^2 <= 1.01 r^2 + 101 e^2.
constexpr float along_error = 1e-6f, off_error = 1e-10f;

/// A sphere about all.
LampSphere sphere_about(std::span<const LampSphere> parts) {
    Bounds bounds;
    for (const LampSphere &part : parts) bounds.add(part.center);
    LampSphere whole{0, bounds.center(), 0};
    for (const LampSphere &part : parts)
        whole.radius = std::max(whole.radius, length(part.center - whole.center) + part.radius);
    return whole;
}

}  // namespace

LampSpheres::LampSpheres(std::span<const LampSphere> spheres) {
    std::vector<Vec3> centers;
    for (const LampSphere &sphere : spheres) centers.push_back(sphere.center);
    std::vector<LampSphere> parts;
    for (const uint32_t i : order_in_eights(centers)) {
        parts.push_back(spheres[i]);
        lamps_.push_back(spheres[i].lamp);
    }
    do {
        std::vector<Spheres> &level = levels_.emplace_back(node_count(parts.size()));
        std::vector<LampSphere> above;
        for (size_t i = 0; i < parts.size(); ++i) level[i / lanes].set(i % lanes, parts[i]);
        for (size_t first = 0; first < parts.size(); first += lanes)
            above.push_back(
                sphere_about(std::span<const LampSphere>(parts).subspan(first, std::min(lanes, parts.size() - first))));
        parts = std::move(above);
    } while (levels_.back().size() > 1);
}

LampSpheres::Line::Line(const Ray &ray) : origin(ray.origin) {
    const float scale = length(ray.direction);
    direction = ray.direction / scale;
    far = ray.far * scale;
}

void LampSpheres::Spheres::set(size_t lane, const LampSphere &sphere) {
    x[lane] = sphere.center.x;
    y[lane] = sphere.center.y;
    z[lane] = sphere.center.z;
    radius[lane] = sphere.radius * widening;
}

uint64_t LampSpheres::Spheres::met_by(const Line &line) const {
    const Float8 to_x = load(x) - broadcast(line.origin.x), to_y = load(y) - broadcast(line.origin.y),
                 to_z = load(z) - broadcast(line.origin.z);
    const Float8 along =
        to_x * broadcast(line.direction.x) + to_y * broadcast(line.direction.y) + to_z * broadcast(line.direction.z);
    const Float8 off_x = to_x - broadcast(line.direction.x) * along, off_y = to_y - broadcast(line.direction.y) * along,
                 off_z = to_z - broadcast(line.direction.z) * along;
    const Float8 squared = to_x * to_x + to_y * to_y + to_z * to_z;
    const Float8 own = load(radius);
    const Float8 reach = own * own + squared * broadcast(off_error);
    const Int8 near_line = off_x * off_x + off_y * off_y + off_z * off_z <= reach;
    const Int8 before_end = along - abs(along) * broadcast(along_error) - own <= broadcast(line.far);
    const Int8 ahead = (along >= broadcast(0)) | (squared <= reach);
    return bytes((own >= broadcast(0)) & near_line & before_end & ahead);
}

}  // namespace photon_maps
