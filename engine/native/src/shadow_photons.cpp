// SPDX-License-Identifier: GPL-3.0-or-later
#include "shadow_photons.h"

#include <array>

namespace photon_maps {

namespace {

using Cube = std::array<int64_t, 3>;

Cube cube_at(Vec3 position, float size) {
    const auto axis = [size](float v) { return static_cast<int64_t>(std::floor(v / size)); };
    return {axis(position.x), axis(position.y), axis(position.z)};
}

/// 17 bits an axis and 13 for the light: what shares a number adds up, and at worst a ray is asked that need not be.
uint64_t number_of(const Cube &cube, size_t source) {
    const auto bits = [](int64_t v) { return static_cast<uint64_t>(v) & 0x1ffff; };
    return bits(cube[0]) | bits(cube[1]) << 17 | bits(cube[2]) << 34 | static_cast<uint64_t>(source) << 51;
}

}  // namespace

ShadowPhotons::ShadowPhotons(std::span<const ShadowPhoton> photons, float cube_size) : cube_size_(cube_size) {
    // Count photons by their own cube.
    struct Place {
        Cube cube;
        uint32_t source;
        Counts counts;
    };
    std::unordered_map<uint64_t, Place> own;
    for (const ShadowPhoton &photon : photons) {
        const Cube cube = cube_at(photon.position, cube_size_);
        Place &place = own.try_emplace(number_of(cube, photon.source), Place{cube, photon.source, {}}).first->second;
        ++(photon.is_lit ? place.counts.lit : place.counts.dark);
    }

    // Add each cube's to those around it.
    for (const auto &[number, place] : own) {
        for (int i = 0; i < 27; ++i) {
            const Cube near{place.cube[0] + i % 3 - 1, place.cube[1] + i / 3 % 3 - 1, place.cube[2] + i / 9 - 1};
            Counts &counts = cubes_[number_of(near, place.source)];
            counts.lit += place.counts.lit;
            counts.dark += place.counts.dark;
        }
    }
}

Visibility ShadowPhotons::visibility(Vec3 position, size_t source) const {
    constexpr uint32_t enough = 16;
    const auto entry = cubes_.find(number_of(cube_at(position, cube_size_), source));
    if (entry == cubes_.end()) return Visibility::unknown;
    const Counts &counts = entry->second;
    if (counts.dark == 0 && counts.lit >= enough) return Visibility::lit;
    if (counts.lit == 0 && counts.dark >= enough) return Visibility::dark;
    return Visibility::unknown;
}

size_t ShadowPhotons::memory_bytes() const { return cubes_.size() * 2 * sizeof(*cubes_.begin()); }

}  // namespace photon_maps
