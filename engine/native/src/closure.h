// SPDX-License-Identifier: GPL-3.0-or-later
// The closures of a surface point: how it scatters light. Lengths of directions are 1, all point away from the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "fixed_vector.h"
#include "vec.h"

namespace photon_maps {

/// Ways in which a closure scatters; sets of them are bits. Diffuse ones are carried by the photon maps, glossy ones by
/// the path, but that rough ones may ask for caustics, too: camera_path.h has the table.
enum Lobe : uint32_t {
    diffuse_reflection = 1,
    diffuse_transmission = 2,
    glossy_reflection = 4,
    glossy_transmission = 8,
    rough_reflection = 16,  ///< glossy, of a roughness of least_rough or more
};
using Lobes = uint32_t;
constexpr Lobes diffuse_lobes = diffuse_reflection | diffuse_transmission;
constexpr Lobes glossy_lobes = glossy_reflection | glossy_transmission | rough_reflection;
constexpr Lobes reflection_lobes = diffuse_reflection | glossy_reflection | rough_reflection;
constexpr Lobes all_lobes = diffuse_lobes | glossy_lobes;
inline constexpr std::array each_lobe{diffuse_reflection, diffuse_transmission, glossy_reflection, glossy_transmission,
                                      rough_reflection};

/// Roughness from which a lobe is so wide that of the photons around a point enough are within it.
constexpr float least_rough = 0.25f;

/// What is carried along the path: radiance from the camera, or flux from the lights. Refraction from a medium of index
/// n1 into one of n2, along the path, scales radiance by (n1 / n2)^2 and leaves flux as it is (Veach 1997,
/// section 5.2).
enum class Transport { radiance, flux };

enum class ClosureType : uint8_t { diffuse, translucent, sheen, reflection, refraction, glass };

/// How a smooth boundary reflects: fresnel.h has the formulas.
enum class Fresnel : uint8_t { none, dielectric, f82, conductor };

/// One closure with the colour and weight it has at a point: surface.h makes them.
struct Closure {
    ClosureType type;
    Vec3 weight;          ///< multiplies all that it scatters
    Vec3 normal;          ///< unit, on the side that is seen
    float roughness = 0;  ///< as the user gives it, 0 to 1
    Fresnel fresnel = Fresnel::none;
    float eta = 1;       ///< index of refraction on the far side over that on the side that is seen
    Vec3 f0{};           ///< reflectance head on; conductor: index; diffuse: factor of what is scattered several times
    Vec3 tint{};         ///< of what is transmitted; F82: the term's factor; conductor: extinction
    Vec3 reflected{};    ///< about which share of the light from `outgoing` is reflected
    Vec3 transmitted{};  ///< likewise
};

/// Largest ratio of the cosines to two normals that a photon may be weighted by.
constexpr float max_shading_ratio = 8;

/// Ratio of a direction's cosines to two normals. Photons land and leave by the geometric cosine; what the eye sees is
/// shaded by the other (Veach 1997, section 5.3). The ratio itself is bounded, lest one grazing photon outshine all
/// others: where the normals nearly agree it stays 1 at any angle.
constexpr float shading_ratio(float wanted_cosine, float given_cosine) {
    return std::max(wanted_cosine, 0.0f) < max_shading_ratio * given_cosine
               ? std::max(wanted_cosine, 0.0f) / given_cosine
               : (wanted_cosine > 0 ? max_shading_ratio : 0.0f);
}

constexpr size_t max_closures = 12;

/// All that a surface point does to light that comes along one ray.
struct Shading {
    Vec3 outgoing;               ///< towards where the ray came from
    Vec3 normal;                 ///< geometric, on that side
    Vec3 smooth_normal;          ///< interpolated, without bumps, on that side; 0 where closures have no other
    bool is_backfacing = false;  ///< that side is the back
    Vec3 emission;               ///< radiance towards `outgoing`
    Vec3 transparency;           ///< share of light that passes straight through, unscattered
    float holdout = 0;           ///< share of the point that is a hole in the picture
    FixedVector<Closure, max_closures> closures;  ///< further ones are dropped

    std::span<const Closure> scattering() const { return closures.values(); }
};

/// A direction drawn by the closures.
struct ScatterSample {
    Vec3 direction;
    Vec3 weight;  ///< scattered share |cos| / density
    float pdf;    ///< by solid angle, of all lobes asked for; 0 where the direction is singular
    Lobe lobe;    ///< that it was drawn from
    bool is_singular;
    Vec3 normal;  ///< of the closure that it was drawn from
};

/// Whether a closure scatters evenly.
bool is_lambertian(const Closure &closure);

/// Returns the lobes that a closure has.
Lobes lobes_of(const Closure &closure);

/// Returns the lobes that the closures have.
Lobes lobes_of(const Shading &shading);

/// Returns f |cos| for light between `outgoing` and `incoming`; singular closures give nothing.
Vec3 evaluate(const Shading &shading, Lobes lobes, Vec3 incoming, Transport transport);

/// Returns the density by solid angle with which sample() draws a direction.
float pdf(const Shading &shading, Lobes lobes, Vec3 incoming);

/// Draws a direction from the lobes asked for.
/// @param u in [0, 1)
/// @return nothing where the closures lead into the surface or there are none
std::optional<ScatterSample> sample(const Shading &shading, Lobes lobes, const std::array<float, 3> &u,
                                    Transport transport);

/// Returns about which share of the light from `outgoing` the lobes scatter, 0 to 1: exact for Lambertian closures.
Vec3 albedo(const Shading &shading, Lobes lobes);

}  // namespace photon_maps
