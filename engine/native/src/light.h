// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines: lamps, emissive triangles and the world; sampled from a point.
// Units follow Blender: see each member of Lamp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "emissive_triangles.h"
#include "lamp_spheres.h"
#include "light_choice.h"
#include "light_sample.h"
#include "scene.h"
#include "world_light.h"

namespace photon_maps {

enum class LightType : uint32_t { point = 0, sun = 1, spot = 2, rectangle = 3, ellipse = 4 };

/// A lamp as Blender has it; it shines along its local -z.
struct Lamp {
    LightType type;
    Transform transform;  ///< light to world; columns may be scaled, which widens a spot's cone
    Vec3 power;           ///< W; sun: irradiance across the beam, W/m2; spot: of the whole sphere
    float width = 0;      ///< point, spot: radius; sun: full angle; rectangle, ellipse: full extent along x
    float height = 0;     ///< rectangle, ellipse: full extent along y
    float spot_angle = 0, spot_blend = 0;
    float spread = pi;          ///< rectangle, ellipse: full angle
    bool soft_falloff = false;  ///< point, spot: scaled by d2/(d2 + r2)
    uint32_t visibility = ~0u;  ///< bits 1 << pm_ray
};

/// All lights of a scene; the scene must outlive it.
class Lights {
  public:
    Lights(const Scene &scene, std::vector<Lamp> lamps, const World &world);

    bool empty() const { return total_power_ <= 0; }
    bool has_emissive_triangles() const { return triangles_.shines(); }
    const EmissiveTriangles &emissive_triangles() const { return triangles_; }
    const WorldLight &world_light() const { return world_; }
    std::span<const Lamp> lamps() const { return lamps_; }
    uint32_t world_visibility() const { return world_.visibility(); }

    /// Lamps, all emissive triangles, the world: each is a source. Some may be dark.
    size_t source_count() const { return lamps_.size() + 2; }
    size_t triangles_source() const { return lamps_.size(); }
    size_t world_source() const { return lamps_.size() + 1; }
    bool shines(size_t source) const { return power_[source] > 0; }
    /// Power of a source, mean of RGB, W.
    float power(size_t source) const { return power_[source]; }

    /// Chances of the sources by the irradiance that they might bring to a point, a little also by how many might bring
    /// any.
    LightChoice::Chances chances_at(Vec3 position) const { return choice_.at(position); }

    /// Chooses a source; nothing where none brings anything.
    std::optional<LightChoice::Choice> choose(const LightChoice::Chances &chances, float u) const {
        return choice_.choose(chances, u);
    }

    /// Probability with which choose() takes a source.
    float choice_probability(size_t source, Vec3 position) const {
        return choice_.probability(choice_.at(position), source);
    }

    /// Chooses a direction to a source that shines. What is invisible to the receiver is not left out: see
    /// LightSample::visibility.
    /// @param normal for shading; the world is chosen about it
    /// @param both_sides the receiver sends on light from both sides of its surface
    /// @param receiver with which a ray scattered by the receiver would come to the light
    /// @param u by u[0], u[1]; of emissive triangles one is chosen by u[2], of the world's densities too
    /// @return nothing where the source cannot reach the position
    std::optional<LightSample> sample(size_t source, Vec3 position, Vec3 normal, bool both_sides,
                                      const RayState &receiver, const std::array<float, 3> &u) const;

    /// Where a ray meets a lamp, if that has an extent and is visible to one of the ray's kinds.
    /// @param is_open no surface ends the ray: lamps at infinity are met wherever the ray is clipped
    std::optional<LampHit> meet(size_t source, const Ray &ray, bool is_open) const;

    /// Calls visit(LampHit) for each lamp that the ray meets, in no order: lamps hide nothing, so who weighs them
    /// against sample() adds up all.
    template <class Visit>
    void meet_all(const Ray &ray, bool is_open, Visit &&visit) const {
        const auto ask = [&](size_t source) {
            if (const std::optional<LampHit> hit = meet(source, ray, is_open)) visit(*hit);
        };
        for (const uint32_t source : far_lamps_) ask(source);
        spheres_.visit(ray, ask);
    }

    /// Density by solid angle with which sample() chooses the direction from a position to a point of an emissive
    /// triangle, once their source is chosen.
    float triangle_pdf(Vec3 position, const SurfacePoint &emitter) const { return triangles_.pdf(position, emitter); }

    /// Radiance that arrives along a ray that leaves the scene; black where the world is invisible to it.
    Vec3 world_radiance(Vec3 direction, const RayState &ray) const;

    /// Density by solid angle with which sample() chooses a direction to the world, once that is chosen.
    float world_pdf(Vec3 direction, Vec3 normal, bool both_sides) const;

  private:
    std::vector<LightReach> reaches() const;
    std::optional<LightSample> sample_world(Vec3 normal, bool both_sides, const RayState &receiver,
                                            const std::array<float, 3> &u) const;

    std::vector<Lamp> lamps_;
    EmissiveTriangles triangles_;
    WorldLight world_;
    std::vector<float> power_;  // of each source, mean of RGB, W
    float total_power_ = 0;
    LightChoice choice_;
    std::vector<uint32_t> far_lamps_;  // that are met whichever way the ray goes: suns of a width
    LampSpheres spheres_;              // of the others that can be met
};

}  // namespace photon_maps
