// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles whose material emits, chosen by their power.
#pragma once

#include <optional>

#include "light_sample.h"
#include "scene.h"

namespace photon_maps {

class EmissiveTriangles {
  public:
    /// The scene must outlive it.
    explicit EmissiveTriangles(const Scene &scene);

    bool shines() const { return power_ > 0; }
    /// Emitted by both sides of all, mean of RGB, W; about right where the emission varies.
    float power() const { return power_; }
    const Bounds &bounds() const { return bounds_; }

    struct Emitter {
        uint32_t instance, triangle;
        float probability;  ///< with which choose() takes it
    };
    /// Triangles of all instances with a material that emits; some may be dark, their probability is 0.
    size_t size() const { return cumulative_.size(); }
    Emitter operator[](size_t index) const;

    /// Chooses a triangle by its power; one must shine.
    Emitter choose(float u) const;
    /// Probability with which choose() takes a triangle: above 0 for each that has an area and may emit, if any shines.
    float probability(uint32_t instance, uint32_t triangle) const;

    /// A point of a triangle, uniform by area, as seen against a direction of travel.
    SurfacePoint point(const Emitter &emitter, float u, float v, Vec3 travel) const;

    /// Chooses a triangle by u[2], and a point on it by u[0], u[1], uniform by area.
    /// @param receiver with which a ray from the position would come to the triangle; its length is set
    std::optional<LightSample> sample(Vec3 position, const RayState &receiver, const std::array<float, 3> &u) const;
    /// Density by solid angle with which sample() chooses the direction from the position to a point of a triangle.
    float pdf(Vec3 position, const SurfacePoint &emitter) const;

  private:
    static constexpr size_t none = ~size_t{0};

    void find_instances();
    void find_powers();

    const Scene &scene_;
    std::vector<size_t> first_;           // of each instance: index of its first triangle; none: it does not emit
    std::vector<uint32_t> instances_;     // that emit, and
    std::vector<size_t> instance_first_;  // the index of the first triangle of each
    std::vector<double> cumulative_;      // share of the power up to and with each triangle of these instances
    Bounds bounds_;
    float power_ = 0;
};

/// Area of a triangle.
inline float area(const WorldTriangle &t) { return length(cross(t.b - t.a, t.c - t.a)) / 2; }

}  // namespace photon_maps
