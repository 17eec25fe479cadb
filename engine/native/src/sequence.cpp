// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequence.h"

#include <bit>

namespace photon_maps {

namespace {

/// A number for each of the four dimensions, by the vector extensions that GCC and Clang share.
using Word4 = uint32_t __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));

/// Reverses the order of 32 bits, of a number or of each of four.
template <class Word>
constexpr Word reverse_bits(Word x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
    return x;
}

/// Permutes numbers so that each bit depends on lower bits only (Laine and Karras 2011, constants of Vegdahl 2021):
/// on reversed bits, an Owen scramble.
template <class Word>
constexpr Word permute_low_to_high(Word x, Word seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
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

constexpr std::array<Polynomial, 4> polynomials = {{{0, 0, {}}, {1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}}};

/// XOR of bit-reversed direction numbers, for each value of each byte of the index those of all dimensions.
struct SobolTable {
    alignas(Word4) std::array<std::array<std::array<uint32_t, 4>, 256>, 4> entries{};

    constexpr SobolTable() {
        for (std::size_t d = 0; d < 4; ++d) {
            const auto v = direction_numbers(polynomials[d]);
            for (std::size_t byte = 0; byte < 4; ++byte)
                for (std::size_t value = 0; value < 256; ++value)
                    for (std::size_t bit = 0; bit < 8; ++bit)
                        if ((value >> bit) & 1) entries[byte][value][d] ^= reverse_bits(v[8 * byte + bit]);
        }
    }
    Word4 operator()(std::size_t byte, uint32_t index) const {
        return std::bit_cast<Word4>(entries[byte][(index >> (8 * byte)) & 0xff]);
    }
};

constexpr SobolTable sobol_table;

}  // namespace

std::array<float, 4> sobol4(uint64_t index, uint32_t seed) {
    // Each 2^32 points a new sequence.
    const auto low = static_cast<uint32_t>(index);
    const auto high = static_cast<uint32_t>(index >> 32);
    if (high != 0) seed = hash(seed, high);

    // Shuffle the order of the points, so that sequences of different seeds are independent.
    const uint32_t shuffled = reverse_bits(permute_low_to_high(reverse_bits(low), seed));

    // The point, and each dimension scrambled by a seed of its own.
    const Word4 reversed =
        sobol_table(0, shuffled) ^ sobol_table(1, shuffled) ^ sobol_table(2, shuffled) ^ sobol_table(3, shuffled);
    const Word4 scrambled = reverse_bits(permute_low_to_high(reversed, hash(Word4{} + seed, Word4{1, 2, 3, 4})));
    const auto whole = std::bit_cast<Int4>(scrambled >> 8);  // signed: such conversions are a single instruction
    return std::bit_cast<std::array<float, 4>>(__builtin_convertvector(whole, Float4) * 0x1p-24f);
}

}  // namespace photon_maps
