// SPDX-License-Identifier: GPL-3.0-or-later
// From the structs of the C interface, already validated, to the helper's own types.
#pragma once

#include "light.h"
#include "render.h"
#include "scene.h"

namespace photon_maps {

inline Vec3 vec3(const float *v) { return {v[0], v[1], v[2]}; }

/// Number of floats that an attribute of a mesh has.
size_t value_count(const pm_mesh &mesh, const pm_attribute &attribute);
/// Bytes of one pixel.
size_t pixel_size(const pm_image &image);

Mesh to_mesh(const pm_mesh &source);
std::vector<Instance> to_instances(const pm_instances &source);
Material to_material(const pm_material &source);
Image to_image(const pm_image &source);
Texture to_texture(const pm_texture &source);
Table to_table(const pm_table &source);
Lamp to_lamp(const pm_light &source);
Camera to_camera(const pm_camera &source);
View to_view(const pm_camera &source);
RenderSettings to_settings(const pm_settings &source);
pm_photon to_pm_photon(const Photon &photon);

}  // namespace photon_maps
