// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of what comes through the C interface: every array, before anything else touches it.
#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <string>

#include "photon_maps.h"

namespace photon_maps {

/// An argument that fails its checks; the message says which and why.
struct InvalidArgument : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Throws InvalidArgument with the message unless the condition holds.
inline void require(bool condition, const std::string &message) {
    if (!condition) throw InvalidArgument(message);
}

/// Coordinates beyond this (scene units) are refused: their squares of squares leave single precision.
constexpr float max_coordinate = 1e9f;

/// Throws InvalidArgument if there are more than 2^32 - 2 of something: so are counts that were negative.
void validate_count(uint64_t count, const std::string &name);
void validate(const pm_mesh &mesh);
/// @param mesh_slots number of material slots that each mesh uses
void validate(const pm_instances &instances, std::span<const uint32_t> mesh_slots, size_t material_count);
void validate(const pm_image &image);
void validate(const pm_texture &texture, size_t image_count);
void validate(const pm_table &table);
void validate(const pm_material &material, size_t index, size_t texture_count, size_t table_count);
void validate(const pm_light &light, size_t index);
void validate(const pm_camera &camera);
void validate(const pm_settings &settings);
void validate_radiance(std::span<const float> radiance, const std::string &name);

/// Throws InvalidArgument unless the sizes of a struct agree.
void require_struct_size(size_t given, size_t expected, const char *name);

}  // namespace photon_maps
