# SPDX-License-Identifier: GPL-3.0-or-later
"""What shaders name by numbers: tables, textures, images, and the attributes that meshes must bring."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from photon_maps_native import Image, Material, Table, Texture
from photon_maps_native.scene_data import Alpha, Light
from photon_maps_native.shader import NormalSpace, Op

from .kept import Kept

#: In NORMAL_MAP's option the attribute's number begins at this bit.
NORMAL_MAP_ATTRIBUTE_SHIFT = 8


class Resources:
    """The tables, textures and images of a scene, each kept once, and the numbers of its attributes.

    An attribute is a kind and a name: ("uv", name), ("uv", "") the map that is active for rendering,
    ("generated", ""), ("color", name), ("color", "") the colour that is active for rendering, ("attribute", name).
    """

    def __init__(self, kept: Kept | None = None) -> None:
        """Hold nothing yet.

        :param kept: images that need not be read again.
        """
        self.kept = kept or Kept()
        self.tables: list[Table] = []
        self.textures: list[Texture] = []
        self.images: list[Image] = []
        self.alphas: list[Alpha] = []  #: what the alpha of each image means
        self.attributes: dict[tuple[str, str], int] = {}
        self.suns: dict[Hashable, Light] = {}  #: of skies, by what they are made of
        self._numbers: dict[Hashable, int] = {}

    def table(self, table: Table) -> int:
        """Return the number of a table; equal ones are shared."""
        key = ("table", table.entries.tobytes(), table.is_stepped)
        return self._number(key, self.tables, lambda: table)

    def texture(self, texture: Texture) -> int:
        """Return the number of a texture; equal ones are shared."""
        return self._number(("texture", texture), self.textures, lambda: texture)

    def image(self, key: Hashable, read: Callable[[], tuple[Image, Alpha]]) -> int:
        """Return the number of an image, read the first time its key is met."""
        if ("image", key) not in self._numbers:
            image, alpha = read()
            self._numbers["image", key] = len(self.images)
            self.images.append(image)
            self.alphas.append(alpha)
        return self._numbers["image", key]

    def attribute(self, kind: str, name: str = "") -> int:
        """Return the number of an attribute."""
        return self.attributes.setdefault((kind, name), len(self.attributes))

    def _number(self, key: Hashable, entries: list, read: Callable[[], object]) -> int:
        if key not in self._numbers:
            entry = read()  # may add entries of its own
            self._numbers[key] = len(entries)
            entries.append(entry)
        return self._numbers[key]


def asked_attributes(material: Material) -> set[int]:
    """Return the numbers of the attributes that a material reads."""
    asked = set()
    for op, option, *_ in material.instructions.tolist():
        if op == Op.ATTRIBUTE:
            asked.add(option)
        elif op == Op.NORMAL_MAP and option % (1 << NORMAL_MAP_ATTRIBUTE_SHIFT) == NormalSpace.TANGENT:
            asked.add(option >> NORMAL_MAP_ATTRIBUTE_SHIFT)
    return asked
