// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a rectangle, uniform by the solid angle under which they are seen (Ureña, Fajardo, King 2013,
// An Area-Preserving Parametrization for Spherical Rectangles).
#pragma once

#include "vec.h"

namespace photon_maps {

class SphericalRectangle {
  public:
    /// @param x, y unit vectors along the sides, at right angles
    /// @param width, height full sides
    SphericalRectangle(Vec3 eye, Vec3 center, Vec3 x, Vec3 y, float width, float height)
        : eye_(eye), x_(x), y_(y), z_(cross(x, y)) {
        // Local coordinates of the corners, the rectangle at z0 < 0.
        const Vec3 d = center - eye;
        x0_ = dot(d, x) - width / 2;
        x1_ = x0_ + width;
        y0_ = dot(d, y) - height / 2;
        y1_ = y0_ + height;
        z0_ = dot(d, z_);
        if (z0_ > 0) {
            z_ = -z_;
            z0_ = -z0_;
        }

        // The planes through the eye and each side: of their normals the z, which alone tells the angles between two of
        // them, for each is at right angles to x or to y. The solid angle is the excess of the angles.
        const auto normal_z = [&](float side) { return side / std::sqrt(z0_ * z0_ + side * side); };
        const float n0 = -normal_z(y0_), n1 = normal_z(x1_), n2 = normal_z(y1_), n3 = -normal_z(x0_);
        const auto angle = [](float a, float b) { return std::acos(std::clamp(-a * b, -1.0f, 1.0f)); };
        b0_ = n0;
        b1_ = n2;
        k_ = 2 * pi - angle(n2, n3) - angle(n3, n0);
        solid_angle_ = angle(n0, n1) + angle(n1, n2) - k_;
    }

    float solid_angle() const { return solid_angle_; }

    Vec3 sample(float u, float v) const {
        // Cosine of the azimuth, from the partial solid angle.
        const float au = u * solid_angle_ + k_;
        const float fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
        const float cu = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0_ * b0_), fu), -1.0f, 1.0f);
        const float su = std::sqrt(std::max(1 - cu * cu, 1e-12f));
        const float xu = std::clamp(-cu * z0_ / su, x0_, x1_);
        // Height, uniform in the sine of the elevation.
        const float d = std::sqrt(xu * xu + z0_ * z0_);
        const float h0 = y0_ / std::sqrt(d * d + y0_ * y0_), h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
        const float hv = h0 + v * (h1 - h0);
        const float yv = hv * hv < 1 - 1e-6f ? hv * d / std::sqrt(1 - hv * hv) : y1_;
        return eye_ + x_ * xu + y_ * std::clamp(yv, y0_, y1_) + z_ * z0_;
    }

  private:
    Vec3 eye_, x_, y_, z_;
    float x0_, x1_, y0_, y1_, z0_;
    float b0_, b1_, k_, solid_angle_;
};

}  // namespace photon_maps
