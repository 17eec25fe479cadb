// SPDX-License-Identifier: GPL-3.0-or-later
// Eight numbers at a time, by the vector extensions that GCC and Clang share: the same bits on every processor.
// Everything is inlined, so that it takes on the instruction set of the function it is used in.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "processor.h"

namespace photon_maps {

constexpr size_t lanes = 8;
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));  ///< of a comparison: -1 where it holds, else 0

[[gnu::always_inline]] inline Float8 load(const std::array<float, lanes> &source) {
    Float8 v;
    std::memcpy(&v, source.data(), sizeof v);
    return v;
}

[[gnu::always_inline]] inline Int8 load(const std::array<uint32_t, lanes> &source) {
    Int8 v;
    std::memcpy(&v, source.data(), sizeof v);
    return v;
}

[[gnu::always_inline]] inline Float8 broadcast(float s) { return Float8{s, s, s, s, s, s, s, s}; }
[[gnu::always_inline]] inline Float8 to_float(Int8 v) { return __builtin_convertvector(v, Float8); }
[[gnu::always_inline]] inline Float8 min(Float8 a, Float8 b) { return a < b ? a : b; }
[[gnu::always_inline]] inline Float8 max(Float8 a, Float8 b) { return a > b ? a : b; }
[[gnu::always_inline]] inline Float8 abs(Float8 v) { return max(v, -v); }

/// Returns v where the mask holds and 0 elsewhere.
[[gnu::always_inline]] inline Float8 select(Int8 mask, Float8 v) {
    return reinterpret_cast<Float8>(reinterpret_cast<Int8>(v) & mask);
}

[[gnu::always_inline]] inline Float8 sqrt(Float8 v) {
    Float8 root;
    for (size_t i = 0; i < lanes; ++i) root[i] = std::sqrt(v[i]);
    return root;
}

/// Returns a mask as one byte a lane, lane 0 in the lowest: its set lanes can be counted and walked.
[[gnu::always_inline]] inline uint64_t bytes(Int8 mask) {
    // A byte of each lane at its place in its half, then the halves put together; a conversion to bytes would go by way
    // of every lane alone.
    constexpr auto first = static_cast<int32_t>(0xff000000);
    Int8 placed = mask & Int8{0xff, 0xff00, 0xff0000, first, 0xff, 0xff00, 0xff0000, first};
    placed |= __builtin_shufflevector(placed, placed, 1, 0, 3, 2, 5, 4, 7, 6);
    placed |= __builtin_shufflevector(placed, placed, 2, 3, 0, 1, 6, 7, 4, 5);
    return uint64_t{static_cast<uint32_t>(placed[0])} | uint64_t{static_cast<uint32_t>(placed[4])} << 32;
}

/// Returns whether a mask is set in any lane.
[[gnu::always_inline]] inline bool any(Int8 mask) {
    using Long4 = int64_t __attribute__((vector_size(32)));
    const auto pairs = reinterpret_cast<Long4>(mask);
    return ((pairs[0] | pairs[2]) | (pairs[1] | pairs[3])) != 0;
}

/// Takes the first set lane out of such bytes, of which one must be set.
[[gnu::always_inline]] inline uint32_t take_first(uint64_t &bytes) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(bytes)) / 8;
    bytes &= ~(uint64_t{0xff} << 8 * lane);
    return lane;
}

/// Returns the sum of the lanes, in a fixed order.
[[gnu::always_inline]] inline float total(Float8 v) {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

#if defined(__x86_64__)
template <typename Work>
[[gnu::flatten, gnu::target("avx2")]] auto with_avx2(const Work &work) {
    return work();
}

/// Without AVX-512BW, for GCC would keep numbers in its 64-bit masks, which is slower.
template <typename Work>
[[gnu::flatten, gnu::target("avx2,avx512f,avx512vl")]] auto with_avx512(const Work &work) {
    return work();
}
#endif

template <typename Work>
[[gnu::flatten]] auto with_any_processor(const Work &work) {
    return work();
}

/// Returns work(), compiled for AVX2 and for AVX-512 as well where processors differ, and chosen when it runs.
/// @param work what it calls must be inlined
template <typename Work>
auto vectorized(const Work &work) {
#if defined(__x86_64__)
    if (has_avx512) return with_avx512(work);
    if (has_avx2) return with_avx2(work);
#endif
    return with_any_processor(work);
}

}  // namespace photon_maps
