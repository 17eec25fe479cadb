// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of images, textures, tables and shaders.
#include "photon_maps_shader.h"
#include "validate.h"

namespace photon_maps {

void validate(const pm_image &image) { require_struct_size(image.struct_size, sizeof(pm_image), "pm_image"); }

void validate(const pm_texture &texture, size_t) {
    require_struct_size(texture.struct_size, sizeof(pm_texture), "pm_texture");
}

void validate(const pm_table &table) { require_struct_size(table.struct_size, sizeof(pm_table), "pm_table"); }

void validate(const pm_material &material, size_t, size_t, size_t) {
    require_struct_size(material.struct_size, sizeof(pm_material), "pm_material");
}

}  // namespace photon_maps
