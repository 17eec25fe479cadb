// SPDX-License-Identifier: GPL-3.0-or-later
// What the closures of Blender's shader nodes add to a point: each as its node means it, by Shading's ray.
#pragma once

#include "closure.h"

namespace photon_maps {

/// `weight` is that of the tree above times the closure's colour, unless a colour is given beside it. Normals are unit
/// vectors; they are turned to the side that is seen. Roughness is clamped to 0 ... 1.
void add_diffuse(Shading &shading, Vec3 weight, float roughness, Vec3 normal);
void add_translucent(Shading &shading, Vec3 weight, Vec3 normal);
void add_sheen(Shading &shading, Vec3 weight, float roughness, Vec3 normal);

/// @param multiple_scattering adds the energy that is scattered several times among the microfacets
void add_glossy(Shading &shading, Vec3 weight, float roughness, Vec3 normal, bool multiple_scattering);
/// A metal by its colour head on and at 82 degrees (Kutz et al. 2021, "Novel aspects of the Adobe Standard Material").
void add_metallic(Shading &shading, Vec3 weight, Vec3 base, Vec3 edge_tint, float roughness, Vec3 normal,
                  bool multiple_scattering);
/// A metal by its complex index of refraction.
void add_conductor(Shading &shading, Vec3 weight, Vec3 ior, Vec3 extinction, float roughness, Vec3 normal,
                   bool multiple_scattering);
void add_glass(Shading &shading, Vec3 weight, Vec3 color, float roughness, float ior, Vec3 normal,
               bool multiple_scattering);
void add_refraction(Shading &shading, Vec3 weight, float roughness, float ior, Vec3 normal);

/// The Principled BSDF's inputs.
struct Principled {
    Vec3 base_color;
    float metallic, roughness, ior, alpha;
    Vec3 normal;
    float diffuse_roughness, specular_level;
    Vec3 specular_tint;
    float transmission, coat, coat_roughness, coat_ior;
    Vec3 coat_tint, coat_normal;
    float sheen, sheen_roughness;
    Vec3 sheen_tint;
    Vec3 emission;  ///< radiance
};
void add_principled(Shading &shading, Vec3 weight, const Principled &principled, bool multiple_scattering);

}  // namespace photon_maps
