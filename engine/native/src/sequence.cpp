// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequence.h"

namespace photon_maps {

namespace {

/// Reverses the order of 32 bits.
constexpr uint32_t reverse_bits(uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
    return x;
}

/// Permutes numbers so that each bit depends on lower bits only (Laine and Karras 2011, constants of Vegdahl 2021):
/// on reversed bits, an Owen scramble.
constexpr uint32_t permute_low_to_high(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// A primitive polynomial and initial numbers of one dimension (Joe and Kuo 2008, new-joe-kuo-6).
struct Polynomial {
    int degree;
    uint32_t coefficients;
    std::array<uint32_t, 3> initial;
};

/// XOR of bit-reversed direction numbers for each value of each byte of the index.
using DimensionTable = std::array<std::array<uint32_t, 256>, 4>;

constexpr std::array<uint32_t, 32> direction_numbers(const Polynomial &p) {
    std::array<uint32_t, 32> v{};
    for (int i = 0; i < 32; ++i) {
        const auto at = [&](int k) -> uint32_t & { return v[static_cast<std::size_t>(k)]; };
        if (p.degree == 0) {
            at(i) = 1u << (31 - i);
        } else if (i < p.degree) {
            at(i) = p.initial[static_cast<std::size_t>(i)] << (31 - i);
        } else {
            at(i) = at(i - p.degree) ^ (at(i - p.degree) >> p.degree);
            for (int k = 1; k < p.degree; ++k)
                if ((p.coefficients >> (p.degree - 1 - k)) & 1) at(i) ^= at(i - k);
        }
    }
    return v;
}

constexpr DimensionTable dimension_table(const Polynomial &polynomial) {
    const auto v = direction_numbers(polynomial);
    DimensionTable table{};
    for (std::size_t byte = 0; byte < 4; ++byte)
        for (std::size_t value = 0; value < 256; ++value)
            for (std::size_t bit = 0; bit < 8; ++bit)
                if ((value >> bit) & 1) table[byte][value] ^= reverse_bits(v[8 * byte + bit]);
    return table;
}

constexpr std::array<DimensionTable, 4> sobol_tables = {dimension_table({0, 0, {}}), dimension_table({1, 0, {1}}),
                                                        dimension_table({2, 1, {1, 3}}),
                                                        dimension_table({3, 1, {1, 3, 1}})};

}  // namespace

std::array<float, 4> sobol4(uint64_t index, uint32_t seed) {
    // Each 2^32 points a new sequence.
    const auto low = static_cast<uint32_t>(index);
    const auto high = static_cast<uint32_t>(index >> 32);
    if (high != 0) seed = hash(seed, high);

    // Shuffle the order of the points, so that sequences of different seeds are independent.
    const uint32_t shuffled = reverse_bits(permute_low_to_high(reverse_bits(low), seed));

    std::array<float, 4> point;
    for (uint32_t d = 0; d < 4; ++d) {
        const DimensionTable &table = sobol_tables[d];
        const uint32_t reversed = table[0][shuffled & 0xff] ^ table[1][(shuffled >> 8) & 0xff] ^
                                  table[2][(shuffled >> 16) & 0xff] ^ table[3][shuffled >> 24];
        const uint32_t scrambled = reverse_bits(permute_low_to_high(reversed, hash(seed, d + 1)));
        point[d] = static_cast<float>(scrambled >> 8) * 0x1p-24f;
    }
    return point;
}

}  // namespace photon_maps
