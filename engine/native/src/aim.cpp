// SPDX-License-Identifier: GPL-3.0-or-later
#include "aim.h"

#include "sampling.h"

namespace photon_maps {

float Cone::nearest_cosine(Vec3 direction) const {
    const float cosine = dot(direction, axis), edge = 1 - one_minus_cosine;
    if (cosine >= edge) return 1;
    return cosine * edge + std::sqrt(std::max(0.0f, 1 - cosine * cosine) * sine_squared);
}

bool Cone::contains(Vec3 unit_direction) const {
    // By the sine: the cosine of a narrow cone drowns in rounding.
    return dot(unit_direction, axis) > 0 && length_squared(cross(unit_direction, axis)) <= sine_squared;
}

std::optional<Cone> cone_towards(Vec3 from, Vec3 center, float radius) {
    const Vec3 to = center - from;
    const float squared = length_squared(to);
    const float sine_squared = radius * radius / squared;
    if (!(sine_squared < 1)) return {};
    return Cone{to / std::sqrt(squared), sine_squared, sine_squared / (1 + std::sqrt(1 - sine_squared))};
}

void DirectionAim::add(const std::optional<Cone> &cone, float share) {
    if (!(share > 0)) return;
    total_ += share;
    if (!cone || cone->one_minus_cosine > widest_) return;
    targets_.emplace_back() = {*cone, share};
}

std::optional<Vec3> DirectionAim::sample(float choice, float u, float v) {
    drawn_ = max_casters;
    float left = choice * total_ / (1 - unaimed_share);
    for (size_t t = 0; t < targets_.size(); ++t) {
        const Target &target = targets_[t];
        if (left < target.share) {
            drawn_ = t;
            return Frame(target.cone.axis).to_world(sample_cone(u, v, target.cone.one_minus_cosine));
        }
        left -= target.share;
    }
    return {};
}

float DirectionAim::pdf(Vec3 direction, float unaimed) const {
    if (targets_.empty()) return unaimed;
    float aimed = 0, density = 0;
    const std::span<const Target> targets = targets_.values();
    for (size_t t = 0; t < targets.size(); ++t) {
        const Target &target = targets[t];
        aimed += target.share;
        // The target drawn counts even where rounding puts the direction just outside.
        if (t == drawn_ || target.cone.contains(direction)) density += target.share / target.cone.solid_angle();
    }
    const float scale = (1 - unaimed_share) / total_;
    return (1 - scale * aimed) * unaimed + scale * density;
}

DiskAim::DiskAim(Vec3 center, float radius, std::span<const Caster> casters)
    : center_(center), radius_(radius), casters_(casters) {
    for (const Caster &caster : casters_) total_ += share_of(caster);
}

float DiskAim::share_of(const Caster &caster) const {
    return caster.strength * std::min(1.0f, caster.radius * caster.radius / (radius_ * radius_));
}

DiskAim::Line DiskAim::sample(Vec3 direction, float choice, float u, float v) const {
    // Choose the disk: the scene's by default.
    const Caster *drawn = nullptr;
    float left = choice * total_ / (1 - unaimed_share);
    for (const Caster &caster : casters_) {
        if (!is_aimed_at(caster)) continue;
        if (left < share_of(caster)) {
            drawn = &caster;
            break;
        }
        left -= share_of(caster);
    }

    // A point of it.
    const Vec2 d = sample_disk(u, v);
    const Frame frame(direction);
    const float radius = drawn ? drawn->radius : radius_;
    const Vec3 point = (drawn ? drawn->center : center_) + (frame.x * d.x + frame.y * d.y) * radius;

    // The density of the line, by all disks that it crosses; back to before the scene.
    const float scale = total_ > 0 ? (1 - unaimed_share) / total_ : 0;
    float unaimed = 1, density = 0;
    for (const Caster &caster : casters_) {
        if (!is_aimed_at(caster)) continue;
        const float share = scale * share_of(caster), squared = caster.radius * caster.radius;
        unaimed -= share;
        if (&caster == drawn || length_squared(cross(point - caster.center, direction)) <= squared)
            density += share / (pi * squared);
    }
    density += unaimed / (pi * radius_ * radius_);
    return {point - direction * (dot(point - center_, direction) + radius_), density};
}

}  // namespace photon_maps
