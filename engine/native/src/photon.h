// SPDX-License-Identifier: GPL-3.0-or-later
// What one photon leaves behind at a diffuse hit, in 32 bytes, alone or among eight.
#pragma once

#include <array>
#include <cstdint>

#include "simd.h"
#include "vec.h"

namespace photon_maps {

/// Returns the nearest whole number; std::lround is a call.
inline int round_to_int(float v) { return static_cast<int>(v + std::copysign(0.5f, v)); }

/// Packs a unit vector into three signed bytes (error below 0.008 per component) and a byte of payload on top.
inline uint32_t pack_normal(Vec3 n, uint32_t payload) {
    const auto byte = [](float v) { return static_cast<uint32_t>(round_to_int(v * 127) & 0xff); };
    return byte(n.x) | byte(n.y) << 8 | byte(n.z) << 16 | payload << 24;
}

inline Vec3 unpack_normal(uint32_t packed) {
    const auto component = [packed](int shift) {
        return static_cast<float>(static_cast<int8_t>(packed >> shift)) / 127;
    };
    return {component(0), component(8), component(16)};
}

/// Packs a unit vector into two 16-bit octahedral coordinates (Cigolle et al. 2014, JCGT 3(2)).
inline uint32_t pack_direction(Vec3 d) {
    const float scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    float u = d.x * scale, v = d.y * scale;
    if (d.z < 0) {
        const float folded_u = (1 - std::abs(v)) * std::copysign(1.0f, u);
        v = (1 - std::abs(u)) * std::copysign(1.0f, v);
        u = folded_u;
    }
    const auto quantise = [](float t) { return static_cast<uint32_t>(round_to_int((t + 1) * 32767)); };
    return quantise(u) | quantise(v) << 16;
}

inline Vec3 unpack_direction(uint32_t packed) {
    const float u = static_cast<float>(packed & 0xffff) / 32767 - 1;
    const float v = static_cast<float>(packed >> 16) / 32767 - 1;
    const float z = 1 - std::abs(u) - std::abs(v);
    const float fold = std::max(-z, 0.0f);
    return normalize({u - std::copysign(fold, u), v - std::copysign(fold, v), z});
}

/// A photon where it hit a diffuse surface.
struct alignas(32) Photon {
    Vec3 position;
    Vec3 flux;           ///< W, as it arrived: not yet multiplied by the albedo
    uint32_t normal;     ///< pack_normal: geometric normal on the side that was hit; payload: bounces, 255 at most
    uint32_t direction;  ///< pack_direction: direction of travel, towards the surface

    uint32_t bounce() const { return normal >> 24; }
};
static_assert(sizeof(Photon) == 32);

/// Eight photons as a structure of arrays, in as many bytes as one after the other. In the places of missing ones are
/// photons at infinity that carry nothing.
struct alignas(32) PhotonBlock {
    std::array<float, lanes> x, y, z;
    std::array<float, lanes> red, green, blue;      ///< flux in W
    std::array<uint32_t, lanes> normal, direction;  ///< as in Photon

    void set(size_t lane, const Photon &photon) {
        x[lane] = photon.position.x;
        y[lane] = photon.position.y;
        z[lane] = photon.position.z;
        red[lane] = photon.flux.x;
        green[lane] = photon.flux.y;
        blue[lane] = photon.flux.z;
        normal[lane] = photon.normal;
        direction[lane] = photon.direction;
    }
    Vec3 position(size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    Vec3 flux(size_t lane) const { return {red[lane], green[lane], blue[lane]}; }
};
static_assert(sizeof(PhotonBlock) == lanes * sizeof(Photon));

/// What a photon came from, for those who look at photons one by one. An estimate needs none of it, so that it is not
/// kept with the photons of a render but traced again.
struct PhotonOrigin {
    uint32_t number;    ///< of the photon among those emitted in its pass
    uint32_t source;    ///< the light, as pm_traced_photon has it
    uint32_t instance;  ///< that it hit
};

/// A photon's way from one place to the next.
struct PhotonSegment {
    Vec3 start, end;
    Vec3 flux;  ///< W
    PhotonOrigin origin;
    uint32_t bounce;  ///< bounces before `start`
};

}  // namespace photon_maps
