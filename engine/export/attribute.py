# SPDX-License-Identifier: GPL-3.0-or-later
"""What meshes bring for their shaders: UV maps, colours, generated coordinates and attributes of other names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import bpy
import numpy as np
from photon_maps_native.scene_data import Attribute, Domain, Mesh

from ..messages import Messages
from .kept import split_known
from .material import MaterialTable
from .mesh import read, read_corners
from .resources import asked_attributes


@dataclass(frozen=True)
class _Layout:
    """How the values of a type of attributes lie in Blender's memory."""

    member: str
    channels: int
    dtype: type


#: The types that are read. Blender decodes byte colours to linear ones itself.
LAYOUTS = {
    "FLOAT": _Layout("value", 1, np.float32),
    "INT": _Layout("value", 1, np.int32),
    "INT8": _Layout("value", 1, np.int32),
    "BOOLEAN": _Layout("value", 1, np.bool_),
    "FLOAT2": _Layout("vector", 2, np.float32),
    "FLOAT_VECTOR": _Layout("vector", 3, np.float32),
    "FLOAT_COLOR": _Layout("color", 4, np.float32),
    "BYTE_COLOR": _Layout("color", 4, np.float32),
}
DOMAINS = {"POINT": Domain.VERTEX, "CORNER": Domain.CORNER, "FACE": Domain.FACE}

#: What is asked for, for the messages: with a name, and without.
KINDS = {
    "uv": ('the UV map "{}"', "a UV map"),
    "color": ('the colour attribute "{}"', "a colour attribute"),
    "attribute": ('the attribute "{}"', "an attribute without a name"),
}


@dataclass
class MeshAttributes:
    """What the materials of a scene ask of its meshes, each attribute read when it is first asked for."""

    materials: MaterialTable
    messages: Messages
    _asked: dict[int, set[int]] = field(default_factory=dict)  #: numbers of attributes, by material
    _read: dict[int, set[int]] = field(default_factory=dict)  #: by mesh
    _seen: set[tuple[int, tuple[int, ...]]] = field(default_factory=set)  #: meshes with materials

    def complete(
        self,
        index: int,
        mesh: Mesh,
        materials: tuple[int, ...],
        source: bpy.types.Mesh,
        owner: str,
        known: dict[tuple[str, str], Attribute],
    ) -> None:
        """Add to a mesh what materials ask for and it does not have yet.

        :param index: number of the mesh.
        :param materials: numbers of the materials that its triangles may have.
        :param source: Blender's mesh that it was read from.
        :param owner: name of an object with that mesh.
        :param known: attributes of the mesh that were read before, by kind and name; what is read is added.
        """
        if (index, materials) in self._seen:
            return
        self._seen.add((index, materials))
        done = self._read.setdefault(index, set())
        missing = set().union(*(self._of(material) for material in materials)) - done
        if missing:
            done |= missing
            names = {number: name for name, number in self.materials.resources.attributes.items() if number in missing}
            found, names = split_known(names, known)
            read = read_attributes(source, names, owner, self.messages) if names else []
            known.update({names[attribute.id]: attribute for attribute in read})
            mesh.attributes += found + read

    def _of(self, material: int) -> set[int]:
        if material not in self._asked:
            self._asked[material] = asked_attributes(self.materials.materials[material])
        return self._asked[material]


def read_attributes(
    mesh: bpy.types.Mesh, asked: Mapping[int, tuple[str, str]], owner: str, messages: Messages
) -> list[Attribute]:
    """Copy attributes of an evaluated mesh, for the triangles that read_mesh() keeps.

    :param asked: kind and name by the number that shaders ask for, as Resources has them.
    :param owner: name of the object; what its mesh does not have is named, and shaders find zeros.
    """
    corners, polygons = read_corners(mesh)
    attributes = []
    for number, (kind, name) in asked.items():
        if kind == "generated":
            attributes.append(Attribute(number, Domain.VERTEX, generated_coordinates(mesh)))
            continue
        attribute = _find(mesh, kind, name)
        if attribute is None:
            what = KINDS[kind][0].format(name) if name else KINDS[kind][1]
            messages.add(owner, f"lacks {what} that its material asks for; it is 0 there.", "Add it to the mesh.")
            continue
        values = _values(attribute, owner, messages)
        if values is None:
            continue
        domain = DOMAINS[attribute.domain]
        if domain != Domain.VERTEX:
            values = np.take(values, corners if domain == Domain.CORNER else polygons, axis=0)
        attributes.append(Attribute(number, domain, np.ascontiguousarray(values)))
    return attributes


def generated_coordinates(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return (V, 3) float32: where each vertex lies in the texture space, 0 to 1, before modifiers deformed it."""
    undeformed = read(mesh.vertices, "undeformed_co", (len(mesh.vertices), 3), np.float32)
    location = np.array(mesh.texspace_location, np.float32)
    size = np.array(mesh.texspace_size, np.float32)
    scale = np.divide(0.5, size, out=np.zeros(3, np.float32), where=size != 0.0)
    return np.nan_to_num((undeformed - location) * scale + np.float32(0.5), posinf=0.0, neginf=0.0)


def _find(mesh: bpy.types.Mesh, kind: str, name: str) -> bpy.types.Attribute | None:
    """Return an attribute by its name, or the one that is active for rendering where there is no name."""
    if kind == "uv" and not name:
        name = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    elif kind == "color" and not name:
        index = mesh.color_attributes.render_color_index
        name = mesh.color_attributes[index].name if 0 <= index < len(mesh.color_attributes) else ""
    return mesh.attributes.get(name) if name else None


def _values(attribute: bpy.types.Attribute, owner: str, messages: Messages) -> np.ndarray | None:
    """Return (N, C) float32, one row an element of the attribute's domain; None where that is not supported."""
    layout = LAYOUTS.get(attribute.data_type)
    if layout is None or attribute.domain not in DOMAINS:
        what = f"{attribute.data_type} on the domain {attribute.domain}"
        text = f'has the attribute "{attribute.name}" ({what}), which is not supported; it is 0.'
        messages.add(owner, text, "Convert it to numbers, vectors or colours on points, corners or faces.")
        return None
    values = read(attribute.data, layout.member, (len(attribute.data), layout.channels), layout.dtype)
    values = values.astype(np.float32, copy=False)
    if not np.isfinite(values).all():
        text = f'has the attribute "{attribute.name}" with values that are no finite numbers; they are read as 0.'
        messages.add(owner, text, "Correct what computes it.")
        values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    return values
