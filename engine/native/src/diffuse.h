// SPDX-License-Identifier: GPL-3.0-or-later
// Closures that scatter everywhere: Lambert's and Oren and Nayar's diffuse reflection, translucency, sheen.
#pragma once

#include "fresnel.h"
#include "scattering.h"

namespace photon_maps {

/// Oren and Nayar's closure in Fujii's form, with the light of further scatterings as in OpenPBR.
struct OrenNayar {
    float constant, slope;  ///< of what is scattered once

    explicit OrenNayar(float roughness)
        : constant(1 / (pi + std::clamp(roughness, 0.0f, 1.0f) * (pi / 2 - 2.0f / 3))),
          slope(std::clamp(roughness, 0.0f, 1.0f) * constant) {}
    /// Share of light from a direction that is scattered once.
    float directional_albedo(float cosine) const;
    /// Its average, weighted by the cosine.
    float average_albedo() const { return constant * pi + slope * (2 * pi - 5.6f) / 3; }
    /// Factor of what is scattered several times by a surface of one colour; the rest of it depends on the direction.
    Vec3 multiple_scattering(Vec3 color, float cosine) const;
};

/// Least roughness that is told from 0.
constexpr float least_diffuse_roughness = 1e-5f;

/// Least roughness of sheen.
constexpr float least_sheen_roughness = 1e-2f;

/// Sheen of a layer of fibres (Zeltner, Burley and Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly
/// Transformed Cosines"): share of the light from a direction that it reflects.
float sheen_albedo(float roughness, float cosine);

/// Share of light from a direction that bumps let through to diffuse reflection. The normals that Bump and Normal Map
/// give are those of microfacets as rough as they are turned (Conty Estevez, Lecocq and Stein 2019, "A
/// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem").
float bump_shadowing(Vec3 smooth_normal, Vec3 normal, Vec3 incoming);

Scattering scatter_diffuse(const Closure &closure, Vec3 outgoing, Vec3 incoming);
ClosureSample sample_diffuse(const Closure &closure, Vec3 outgoing, const std::array<float, 3> &u);

}  // namespace photon_maps
