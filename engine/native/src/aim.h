// SPDX-License-Identifier: GPL-3.0-or-later
// Rays drawn from a mixture of a light's own density and uniform ones towards the casters: one sample, weighted by the
// density of the whole mixture (Veach 1997, section 9.2.4).
#pragma once

#include <optional>
#include <span>

#include "caster.h"
#include "fixed_vector.h"

namespace photon_maps {

/// The share of a light's photons that is aimed at nothing, so that all that it shines on gets some.
constexpr float unaimed_share = 0.1f;

/// The directions from a point to a sphere outside which it lies.
struct Cone {
    Vec3 axis;  ///< unit
    float sine_squared;
    float one_minus_cosine;

    float solid_angle() const { return 2 * pi * one_minus_cosine; }
    /// Cosine of the least angle between a unit direction and the cone.
    float nearest_cosine(Vec3 direction) const;
    bool contains(Vec3 unit_direction) const;
};

/// @return nothing where the point lies in the sphere
std::optional<Cone> cone_towards(Vec3 from, Vec3 center, float radius);

/// What the photons that leave one point are aimed at.
class DirectionAim {
  public:
    /// @param widest 1 - cos of cones that the light's own density meets as well: no photons are aimed at wider ones
    explicit DirectionAim(float widest) : widest_(widest) {}

    /// Adds a target: nothing for a point within it.
    /// @param share of the light's flux that is wanted from the target
    void add(const std::optional<Cone> &cone, float share);
    /// Sum of the shares added.
    float total() const { return total_; }

    /// Draws a direction; nothing where the light's own density has the turn.
    /// @param choice uniform in [0, 1); becomes the number of the target, for pdf()
    std::optional<Vec3> sample(float choice, float u, float v);
    /// Density by solid angle of the whole mixture in the direction drawn.
    /// @param unaimed the light's own density there
    float pdf(Vec3 direction, float unaimed) const;

  private:
    float widest_;
    float total_ = 0;
    /// What photons are aimed at, and its share.
    struct Target {
        Cone cone;
        float share;
    };
    FixedVector<Target, max_casters> targets_;
    size_t drawn_ = max_casters;  ///< number of the target drawn
};

/// The disks across which parallel light reaches the scene and the casters: none aimed where the disk is as wide.
class DiskAim {
  public:
    DiskAim(Vec3 center, float radius, std::span<const Caster> casters);

    /// Share of the light across the scene that is wanted from the casters.
    float total() const { return total_; }

    /// A line through the scene.
    struct Line {
        Vec3 origin;  ///< before all of the scene
        float pdf;    ///< by area across the direction
    };
    Line sample(Vec3 direction, float choice, float u, float v) const;

  private:
    float share_of(const Caster &caster) const;
    bool is_aimed_at(const Caster &caster) const { return caster.radius * caster.radius < radius_ * radius_ / 2; }

    Vec3 center_;
    float radius_;
    std::span<const Caster> casters_;
    float total_ = 0;
};

}  // namespace photon_maps
