# SPDX-License-Identifier: GPL-3.0-or-later
"""What earlier readings of a depsgraph found and still holds: a viewport reads again only what has changed.

Blender's addresses are used anew when what lay there is gone. So a mesh is known by its address and by the data-blocks
that it was made of: none of them may have changed since.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import bpy
from photon_maps_native import Image, Mesh
from photon_maps_native.scene_data import Alpha, Attribute

from ..changes import Changes
from ..messages import Messages


@dataclass
class KeptMesh:
    """A mesh as it was read, without the attributes that its materials asked for."""

    mesh: Mesh | None  #: None: it has nothing to render
    owners: frozenset[int] = frozenset()  #: session_uid of the data-blocks that it was made of
    said: Messages = field(default_factory=Messages)  #: while it was read
    attributes: dict[tuple[str, str], Attribute] = field(default_factory=dict)  #: by kind and name


class Kept:
    """Meshes and images of earlier readings; empty, all is read."""

    def __init__(self) -> None:
        self._meshes: dict[int, KeptMesh] = {}
        self._images: dict[Hashable, tuple[Image, Alpha]] = {}
        self._met: set[Hashable] = set()  #: addresses and keys, in this reading
        self._changes = Changes()

    def begin(self, changes: Changes) -> None:
        """Begin a reading: forget what has changed, all of it where that is not known, and what was not met last."""
        if changes.is_all:
            self._met = set()
        self._meshes = {
            address: kept
            for address, kept in self._meshes.items()
            if address in self._met and not kept.owners & changes.shapes
        }
        self._images = {
            key: image for key, image in self._images.items() if key in self._met and key[0] not in changes.images
        }
        self._met, self._changes = set(), changes

    def mesh(
        self, instance: bpy.types.DepsgraphObjectInstance, messages: Messages, read: Callable[[Messages], Mesh | None]
    ) -> KeptMesh:
        """Return the evaluated mesh of an instance's object, read unless it is known.

        A mesh that is being edited is read each time.
        """
        object = instance.object
        if object.data.is_editmode:
            return KeptMesh(read(messages))
        address, owners = object.data.as_pointer(), frozenset(_owners(instance))
        kept = self._meshes.get(address)
        if kept is None or not kept.owners & owners or owners & self._changes.shapes:
            kept = KeptMesh(None, owners)
            kept.mesh = read(kept.said)
            self._meshes[address] = kept
        self._met.add(address)
        for message in kept.said:
            messages.add(message.object, message.text, message.advice, message.node)
        return kept

    def image(
        self, image: bpy.types.Image, key: tuple[Hashable, ...], read: Callable[[], tuple[Image, Alpha]]
    ) -> tuple[Image, Alpha]:
        """Return an image, read unless it is known; one with changes that are not saved is read each time.

        :param key: whatever tells it from others, first its session_uid.
        """
        if image.is_dirty:
            return read()
        key = (*key, image.source, image.filepath, image.alpha_mode, image.colorspace_settings.name, *image.size)
        if key not in self._images:
            self._images[key] = read()
        self._met.add(key)
        return self._images[key]


def split_known(
    asked: Mapping[int, tuple[str, str]], known: Mapping[tuple[str, str], Attribute]
) -> tuple[list[Attribute], dict[int, tuple[str, str]]]:
    """Return the attributes that are known, by the numbers they now have, and those that must be read."""
    found = [replace(known[name], id=number) for number, name in asked.items() if name in known]
    return found, {number: name for number, name in asked.items() if name not in known}


def _owners(instance: bpy.types.DepsgraphObjectInstance) -> Iterator[int]:
    objects = [instance.object, instance.parent] if instance.is_instance else [instance.object]
    for object in objects:
        yield object.original.session_uid
        if object.original.data is not None:
            yield object.original.data.session_uid
