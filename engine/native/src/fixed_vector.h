// SPDX-License-Identifier: GPL-3.0-or-later
// A list with room for a fixed number of values, without a heap.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace photon_maps {

/// Unlike an array's, its values are constructed when they are added: making or copying an empty one costs nothing.
template <class T, size_t capacity>
    requires std::is_trivially_copyable_v<T>
class FixedVector {
  public:
    FixedVector() = default;
    FixedVector(const FixedVector &other) { *this = other; }
    FixedVector &operator=(const FixedVector &other) {
        size_ = other.size_;
        std::copy_n(other.storage_.begin(), size_ * sizeof(T), storage_.begin());
        return *this;
    }

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == capacity; }
    /// The list must not be full.
    T &emplace_back() { return *std::construct_at(data() + size_++); }
    /// The list must not be empty.
    void pop_back() { --size_; }
    void clear() { size_ = 0; }
    T &operator[](size_t i) { return data()[i]; }
    std::span<T> values() { return {data(), size_}; }
    std::span<const T> values() const { return {std::launder(reinterpret_cast<const T *>(storage_.data())), size_}; }

  private:
    T *data() { return std::launder(reinterpret_cast<T *>(storage_.data())); }

    alignas(T) std::array<std::byte, capacity * sizeof(T)> storage_;
    size_t size_ = 0;
};

}  // namespace photon_maps
