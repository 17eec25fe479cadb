// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy numbers by the global index of a photon or of a pixel's sample: nothing is remembered between calls,
// so any thread may ask for any number.
// Owen-scrambled, shuffled Sobol points in four dimensions, padded to more by fresh shuffles
// (Burley 2020, Practical Hash-based Owen Scrambling, JCGT 9(4); directions of Joe and Kuo 2008).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace photon_maps {

/// Mixes the bits of a number, or of each of several (Wellons' lowbias32).
template <class Word>
constexpr Word hash(Word x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

template <class Word>
constexpr Word hash(Word a, Word b) {
    return hash(a ^ (hash(b) + 0x9e3779b9u + (a << 6) + (a >> 2)));
}

/// Four numbers in [0, 1): point `index` of the sequence that `seed` selects.
std::array<float, 4> sobol4(uint64_t index, uint32_t seed);

/// The numbers of one photon or one camera path, four at a time, in a fixed order.
class Sequence {
  public:
    Sequence(uint64_t index, uint32_t seed) : index_(index), seed_(seed) {}

    /// Points of four numbers in [0, 1) each, which together are as even as one sequence is.
    struct Points {
        uint64_t first;
        uint32_t seed;

        std::array<float, 4> operator[](uint32_t i) const { return sobol4(first + i, seed); }
    };
    /// The next so many points.
    Points points(uint32_t count) { return {index_ * count, hash(seed_, group_++)}; }
    /// The next four numbers in [0, 1).
    std::array<float, 4> next() { return sobol4(index_, hash(seed_, group_++)); }
    /// A sequence of its own for what goes another way from here: neither hangs on how many numbers the other takes.
    Sequence branch() { return {index_, hash(seed_, group_++)}; }

  private:
    uint64_t index_;
    uint32_t seed_;
    uint32_t group_ = 0;
};

}  // namespace photon_maps
