// SPDX-License-Identifier: GPL-3.0-or-later
// What the closures of Blender's shader nodes add to a point: each as its node means it, by Shading's ray.
#pragma once

#include "closure.h"

namespace photon_maps {

/// `weight` is that of the tree above times the closure's colour, unless a colour is given beside it; what is not a
/// number or negative counts as 0, what is greater than 1 as 1. Normals are unit vectors; they are turned to the side
/// that is seen. Roughness is clamped to 0 ... 1. Each returns what it reflects of the light from `outgoing`, about.
///
/// Rough diffuse and glossy closures scatter some light several times, each time by their colour. Where the tree above
/// is not white, `color` tells theirs; else it is `weight`.
Vec3 add_diffuse(Shading &shading, Vec3 weight, float roughness, Vec3 normal, std::optional<Vec3> color = {});
Vec3 add_translucent(Shading &shading, Vec3 weight, Vec3 normal);
Vec3 add_sheen(Shading &shading, Vec3 weight, float roughness, Vec3 normal);

/// @param multiple_scattering adds the energy that is scattered several times among the microfacets
Vec3 add_glossy(Shading &shading, Vec3 weight, float roughness, Vec3 normal, bool multiple_scattering,
                std::optional<Vec3> color = {});
/// A metal by its colour head on and at 82 degrees (Kutz et al. 2021, "Novel aspects of the Adobe Standard Material").
Vec3 add_metallic(Shading &shading, Vec3 weight, Vec3 base, Vec3 edge_tint, float roughness, Vec3 normal,
                  bool multiple_scattering);
/// A metal by its complex index of refraction.
Vec3 add_conductor(Shading &shading, Vec3 weight, Vec3 ior, Vec3 extinction, float roughness, Vec3 normal,
                   bool multiple_scattering);
Vec3 add_glass(Shading &shading, Vec3 weight, Vec3 color, float roughness, float ior, Vec3 normal,
               bool multiple_scattering);
Vec3 add_refraction(Shading &shading, Vec3 weight, float roughness, float ior, Vec3 normal);

/// A dielectric's reflection alone.
/// @param f0 reflectance head on, which takes the place of that of `ior`
Vec3 add_specular(Shading &shading, Vec3 weight, Vec3 f0, float roughness, float ior, Vec3 normal,
                  bool multiple_scattering);
/// Glass whose reflection and refraction have their own colours.
/// @param f0 reflectance head on, which takes the place of that of `ior`
Vec3 add_tinted_glass(Shading &shading, Vec3 weight, Vec3 f0, Vec3 transmission_tint, Vec3 average_color,
                      float roughness, float ior, Vec3 normal, bool multiple_scattering);

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

/// Layers as Blender 4 and later have them (Cycles' svm_node_closure_bsdf): each layer leaves to those below what it
/// does not reflect.
void add_principled(Shading &shading, Vec3 weight, const Principled &principled, bool multiple_scattering);

}  // namespace photon_maps
