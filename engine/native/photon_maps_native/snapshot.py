# SPDX-License-Identifier: GPL-3.0-or-later
"""The photons of one pass, one by one, and what a map made of them says of a place."""

from __future__ import annotations

from ctypes import byref, c_uint64

import numpy as np

from . import structs
from .convert import floats, shaped, uints
from .library import Handle, NativeRender, call, photon_arrays
from .photons import MapProbe, PhotonKind, PhotonSegments, Probe, Received, TracedPhotons

MOST_USUAL_SEGMENTS = 8  #: of one photon's way


class NativeSnapshot(Handle):
    """The photons of one pass and what they came from; it keeps the scene in the helper. Any thread may ask it."""

    release = "pm_snapshot_release"

    def __init__(self, render: NativeRender, index: int) -> None:
        """Trace the photons of a pass again, with what they came from; at least one pass must have been rendered.

        :raises NativeError: if none has been; with Status.CANCELLED if the render was cancelled meanwhile.
        """
        super().__init__()
        call("pm_snapshot_create", render.handle, index, byref(self._handle))

    def count(self, kind: PhotonKind) -> int:
        """Return how many photons of a kind there are."""
        count = c_uint64()
        call("pm_snapshot_count", self.handle, kind, byref(count))
        return count.value

    def photons(self, kind: PhotonKind, limit: int | None = None) -> TracedPhotons:
        """Return the first photons of a kind in the order of emission: a fair sample of all."""
        count = self.count(kind) if limit is None else min(limit, self.count(kind))
        native = (structs.PmTracedPhoton * count)()
        call("pm_snapshot_photons", self.handle, kind, 0, count, native)
        rows = np.ctypeslib.as_array(native)
        return TracedPhotons(photon_arrays(rows["photon"]), rows["source"], rows["instance"], rows["number"])

    def segments(self, is_caustic: bool, numbers: np.ndarray) -> PhotonSegments:
        """Return the ways of photons of the caustic or the global map, by their numbers."""
        numbers = shaped(numbers, np.uint32, (None,), "numbers")
        count = c_uint64(MOST_USUAL_SEGMENTS * len(numbers))
        while True:  # again if there are more
            room = count.value
            native = (structs.PmPhotonSegment * room)()
            arguments = (uints(numbers), len(numbers), native, room, byref(count))
            call("pm_snapshot_segments", self.handle, is_caustic, *arguments)
            if count.value <= room:
                break
        rows = np.ctypeslib.as_array(native)[: count.value]
        return PhotonSegments(*(rows[name] for name in ("start", "end", "flux", "bounce", "source", "number")))

    def received(self) -> list[Received]:
        """Return what instances received of each light."""
        count, native = c_uint64(), (structs.PmReceived * 0)()
        for _ in range(2):  # how many there are; then themselves
            native = (structs.PmReceived * count.value)()
            call("pm_snapshot_received", self.handle, native, count.value, byref(count))
        return [
            Received(row.instance, row.source, bool(row.is_caustic), row.arrived, row.stored, tuple(row.flux))
            for row in native
        ]

    def probe(self, origin: np.ndarray, direction: np.ndarray) -> Probe | None:
        """Estimate the irradiance at the first surface along a ray, by the pass's radius: with ADAPTIVE the largest.

        :param origin: (3,) in the world.
        :param direction: (3,) a unit vector.
        :return: None where the ray meets nothing.
        """
        origin = shaped(origin, np.float32, (3,), "origin")
        direction = shaped(direction, np.float32, (3,), "direction")
        native = structs.PmProbe()
        call("pm_snapshot_probe", self.handle, floats(origin), floats(direction), byref(native))
        if not native.is_hit:
            return None
        place = (tuple(native.position), tuple(native.normal), native.instance, bool(native.keeps_photons))
        return Probe(*place, map_probe(native.global_map), map_probe(native.caustic_map))


def map_probe(native: structs.PmMapProbe) -> MapProbe:
    """Return the numbers of a pm_map_probe."""
    return MapProbe(native.radius, native.photons, tuple(native.irradiance), tuple(native.standard_error))
