// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.h"

namespace photon_maps {

namespace {

template <class Value>
size_t bytes_of(const std::vector<Value> &values) {
    return values.size() * sizeof(Value);
}

size_t bytes_beside(const Mesh &mesh) {
    size_t bytes = bytes_of(mesh.vertices) + bytes_of(mesh.triangles) + bytes_of(mesh.slots) +
                   bytes_of(mesh.corner_normals) + bytes_of(mesh.attributes);
    for (const Attribute &attribute : mesh.attributes) bytes += bytes_of(attribute.values);
    return bytes;
}

size_t bytes_beside(const Program &program) {
    return bytes_of(program.constants) + bytes_of(program.instructions) + bytes_of(program.arguments);
}

size_t bytes_beside(const Material &material) {
    return bytes_beside(material.program) + bytes_beside(material.transparency);
}

size_t bytes_beside(const Image &image) { return bytes_of(image.pixels); }

size_t bytes_beside(const Texture &texture) { return bytes_of(texture.images) + bytes_of(texture.tiles); }

size_t bytes_beside(const Table &table) { return bytes_of(table.entries); }

/// Bytes of the values and of the arrays that they hold beside themselves.
template <class Value>
size_t bytes_with_arrays(const std::vector<Value> &values) {
    size_t bytes = bytes_of(values);
    for (const Value &value : values) bytes += bytes_beside(value);
    return bytes;
}

}  // namespace

size_t Scene::memory_bytes() const {
    return bytes_with_arrays(meshes) + bytes_of(instances) + bytes_of(slot_materials) + bytes_with_arrays(materials) +
           bytes_with_arrays(images) + bytes_with_arrays(textures) + bytes_with_arrays(tables) +
           bytes_of(feature_edges_);
}

}  // namespace photon_maps
