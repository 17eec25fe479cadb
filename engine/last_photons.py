# SPDX-License-Identifier: GPL-3.0-or-later
"""The photons of each view layer's last render, for those who look at them one by one.

They are kept beside Blender's data, as last_render.py has it, and only while somebody wants them: they keep the scene
that they were traced in.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from photon_maps_native import NativeSnapshot, Received, SceneData


@dataclass(frozen=True, eq=False)
class LastPhotons:
    """The photons of a pass."""

    snapshot: NativeSnapshot
    pass_index: int
    object_names: tuple[str, ...]  #: one an instance
    light_names: tuple[str, ...]  #: of the lamps

    @cached_property
    def counts(self) -> dict[int, int]:
        """How many there are of each kind (photon_maps_native.PhotonKind)."""
        from photon_maps_native import PhotonKind

        return {kind: self.snapshot.count(kind) for kind in PhotonKind}

    @cached_property
    def stored(self) -> int:
        """How many the pass stored: as the summary of the render has it."""
        from photon_maps_native import PhotonKind

        return sum(count for kind, count in self.counts.items() if kind != PhotonKind.SHADOW)

    @cached_property
    def received(self) -> list[Received]:
        """What instances received of each light."""
        return self.snapshot.received()

    def source_name(self, source: int) -> str:
        """Return what a light is called: a lamp, an object that shines, or the world."""
        from photon_maps_native import SOURCE_INSTANCE, SOURCE_WORLD

        if source == SOURCE_WORLD:
            return "World"
        if source >= SOURCE_INSTANCE:
            return self.object_names[source - SOURCE_INSTANCE]
        return self.light_names[source]


def photons_of(snapshot: NativeSnapshot, pass_index: int, scene: SceneData) -> LastPhotons:
    """Return a snapshot with the names of what is in its scene."""
    return LastPhotons(snapshot, pass_index, scene.instances.names, tuple(light.name for light in scene.lights))


_photons: dict[tuple[int, str], LastPhotons] = {}
_changes = 0


def remember(scene_uid: int, view_layer: str, photons: LastPhotons) -> None:
    """Keep the photons of a render, in place of those before."""
    global _changes
    _changes += 1
    _photons[scene_uid, view_layer] = photons


def recall(scene_uid: int, view_layer: str) -> LastPhotons | None:
    """Return the photons of the view layer's last render, if they were kept."""
    return _photons.get((scene_uid, view_layer))


def changes() -> int:
    """Return how often photons were kept: a final render does so in a thread that can tell nobody."""
    return _changes


def forget_others(scene_uids: Set[int]) -> None:
    """Drop the photons of all but these scenes; their memory is free once nobody draws them any more."""
    for key in [key for key in _photons if key[0] not in scene_uids]:
        del _photons[key]


def forget(scene_uid: int | None = None) -> None:
    """Drop the photons of a scene, or of all; their memory is free once nobody draws them any more."""
    forget_others(set() if scene_uid is None else {key[0] for key in _photons} - {scene_uid})
