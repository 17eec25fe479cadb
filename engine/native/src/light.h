// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines: lamps, emissive triangles and the world; sampled from a point, and emitting photons.
// Units follow Blender: see each member of Lamp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene.h"
#include "sequence.h"

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
    uint32_t visibility = 0;    ///< bits 1 << pm_ray
};

/// What surrounds the scene.
struct World {
    std::optional<uint32_t> material;  ///< whose emission it is; none: black
    uint32_t visibility = ~0u;         ///< bits 1 << pm_ray
};

/// A direction towards a light, chosen with a known density.
struct LightSample {
    Vec3 direction;  ///< unit
    float distance;  ///< up to where a shadow ray must be free
    Vec3 radiance;   ///< arriving along the direction, divided by the density of the choice
    float pdf;       ///< density by solid angle where closure sampling can meet the same light; else 0
};

/// A photon as it leaves a light.
struct PhotonEmission {
    Ray ray;
    Vec3 flux;  ///< W, divided by the density of the choice; still to be divided by the number of photons
    /// Soft falloff: flux arriving at distance d of `falloff_center` is scaled by d2/(d2 + falloff_radius2).
    Vec3 falloff_center;
    float falloff_radius_squared = 0;
};

/// All lights of a scene; the scene must outlive it.
class Lights {
  public:
    Lights(const Scene &scene, std::vector<Lamp> lamps, const World &world);

    bool empty() const { return total_power_ <= 0; }
    Vec3 world() const { return world_; }
    bool has_emissive_triangles() const { return !triangles_.empty(); }

    /// Lamps, all emissive triangles, the world: each is a source. Some may be dark.
    size_t source_count() const { return lamps_.size() + 2; }
    bool shines(size_t source) const { return power_[source] > 0; }

    /// A source chosen by chance.
    struct Choice {
        size_t source;
        float probability;
        float left;  ///< what is left of the random number, uniform in [0, 1) again
    };

    /// Chooses a source by the irradiance that it might bring to the point.
    std::optional<Choice> choose(Vec3 position, float u) const;

    /// Chooses a direction to a source, by u[0] and u[1], of emissive triangles one by u[2].
    /// @return nothing where the source cannot reach the side that `shading_normal` is on
    std::optional<LightSample> sample(size_t source, Vec3 position, Vec3 shading_normal,
                                      const std::array<float, 3> &u) const;

    /// Density by solid angle with which sample() chooses the direction from `position` to a point of an emissive
    /// triangle, once their source is chosen.
    float pdf(Vec3 position, const SurfacePoint &emitter) const;

    /// Probability with which choose() takes the emissive triangles.
    float triangles_probability(Vec3 position) const {
        return importance(triangles_source(), position) / total_importance(position);
    }

    /// Emits one photon: a light by its share of the power, then a point and direction by its radiance
    /// (Jensen 1996, section 4.1). Nothing if the lights have no power.
    std::optional<PhotonEmission> emit(Sequence &sequence) const;

    /// Radiance of the nearest lamp that the camera sees along a ray, and its distance, if before the ray's end.
    /// @param is_open no surface ends the ray: lamps at infinity are seen wherever the ray is clipped
    std::optional<std::pair<Vec3, float>> seen(const Ray &ray, bool is_open) const;

  private:
    struct Emitter {  // an emissive triangle
        uint32_t instance, triangle;
        double cumulative;  // share of the emitted power up to and with this one
    };

    void find_emissive_triangles();
    size_t triangles_source() const { return lamps_.size(); }
    size_t world_source() const { return lamps_.size() + 1; }
    float importance(size_t source, Vec3 position) const;
    float total_importance(Vec3 position) const;
    std::optional<LightSample> sample_triangles(Vec3 position, float choice, float u, float v) const;
    size_t choose_emitter(double choice) const;
    PhotonEmission emit_from_triangle(float choice, float side, const std::array<float, 4> &u) const;
    PhotonEmission emit_from_world(const std::array<float, 4> &u) const;

    const Scene &scene_;
    std::vector<Lamp> lamps_;
    Vec3 world_;
    std::vector<Emitter> triangles_;
    Bounds triangle_bounds_;
    float triangle_power_ = 0;
    std::vector<float> power_;  // of each source, mean of RGB, W
    float total_power_ = 0;
};

}  // namespace photon_maps
