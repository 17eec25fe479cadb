// SPDX-License-Identifier: GPL-3.0-or-later
// The shape of every operation of a shader, for all that reads programs; and the registers they work on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "photon_maps.h"
#include "photon_maps_shader.h"
#include "vec.h"

namespace photon_maps {

/// Registers of a program, constants included.
constexpr size_t max_registers = 4096;

/// What an operation takes and writes.
struct OpShape {
    uint32_t argument_count;
    uint32_t output_count;
    uint32_t option_count;  ///< options are below it; 0: no limit, or one that depends on the scene
    bool can_shift;         ///< may be evaluated a step along the surface
};

/// Returns the shape of an operation, which for some depends on the option; nothing if there is no such operation.
std::optional<OpShape> shape_of(uint32_t op, uint32_t option);

constexpr bool is_closure(uint32_t op) { return op >= PM_OP_DIFFUSE; }

/// The registers of one run, on the stack; they hold nothing until written.
class Registers {
  public:
    Registers() {}  // NOLINT: 48 KB are not worth clearing for every point
    Vec3 operator[](size_t index) const { return {values_[3 * index], values_[3 * index + 1], values_[3 * index + 2]}; }
    void set(size_t index, Vec3 value) {
        values_[3 * index] = value.x;
        values_[3 * index + 1] = value.y;
        values_[3 * index + 2] = value.z;
    }

  private:
    float values_[3 * (max_registers + 1)];  // evaluate() writes one further
};

/// The arguments of one instruction.
struct Operands {
    const Registers &registers;
    std::span<const uint32_t> indices;

    Vec3 operator[](size_t i) const { return registers[indices[i]]; }
    float number(size_t i) const { return registers[indices[i]].x; }
};

}  // namespace photon_maps
