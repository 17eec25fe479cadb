# SPDX-License-Identifier: GPL-3.0-or-later
"""The thread behind a viewport: what it renders when, and that it ends."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest
from photon_maps_native import Camera, NativeError
from photon_maps_native.errors import Status

from engine.settings import RenderSettings
from engine.viewport_rendering import LOOK_PHOTONS, Picture, Request
from engine.viewport_worker import ViewportWorker, close_all, paused
from tests.shapes import camera
from tests.test_determinism import still_life

PATIENCE = 20.0  #: seconds after which a test has failed


@dataclass
class Stage:
    """Stands in for the helper: passes end when they are told to."""

    log: list[str] = field(default_factory=list)
    passes: int = 3  #: until it is done
    pass_seconds: float = 1e-6  #: that the helper says a pass took
    is_held: bool = False  #: passes of fine pictures wait for a cancel
    is_coarse_held: bool = False
    held: set[str] = field(default_factory=set)  #: sessions whose passes wait for a cancel, by name
    trouble: Exception | None = None  #: of the next pass
    snapshot_trouble: Exception | None = None  #: of every snapshot
    open_things: int = 0

    def load(self, scene: object) -> StageScene:
        self.log.append("load")
        return StageScene(self)

    def start(self, scene: object, settings: RenderSettings, camera: Camera, map_bytes: int) -> StageSession:
        return StageSession(self, camera, "look" if settings.photon_count == LOOK_PHOTONS else "pass")

    def worker(self) -> ViewportWorker:
        return ViewportWorker(self.load, self.start)


class StageScene:
    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        stage.open_things += 1

    def close(self) -> None:
        self.stage.open_things -= 1


class StageSession(StageScene):
    def __init__(self, stage: Stage, camera: Camera, name: str) -> None:
        super().__init__(stage)
        self.name = name
        self.cancelled = threading.Event()
        self.set_camera(camera)

    def set_camera(self, camera: Camera) -> None:
        self.camera, self.done = camera, 0

    def step(self) -> bool:
        stage, width = self.stage, self.camera.resolution[0]
        if stage.trouble is not None:
            trouble, stage.trouble = stage.trouble, None
            raise trouble
        is_held = stage.is_held if width == SIZE[0] else stage.is_coarse_held
        stage.log.append(f"{self.name} {width}")
        end = time.monotonic() + PATIENCE
        while (is_held or self.name in stage.held) and not self.cancelled.is_set():
            is_held = stage.is_held if width == SIZE[0] else stage.is_coarse_held
            assert time.monotonic() < end
            time.sleep(0.001)
        if self.cancelled.is_set():
            self.cancelled.clear()
            stage.log.append("cancelled")
            return False
        self.done += 1
        return True

    @property
    def last_pass(self) -> int | None:
        return self.done - 1 if self.done else None

    def snapshot(self) -> object:
        self.stage.log.append("photons")
        if self.stage.snapshot_trouble is not None:
            raise self.stage.snapshot_trouble
        return object()

    def cancel(self) -> None:
        self.cancelled.set()

    @property
    def progress(self) -> float:
        return self.done / self.stage.passes

    def statistics(self) -> SimpleNamespace:
        return SimpleNamespace(
            passes=self.done, seconds_gather=self.stage.pass_seconds, error=np.inf, photons_emitted=0
        )

    def read(self, buffer: int) -> np.ndarray:
        _, _, width, height = self.camera.region
        return np.full((height, width, 4), self.done, np.float32)


SIZE = (80, 64)


def request(**changes: object) -> Request:
    return replace(Request(still_life(), RenderSettings(), camera((0, -5, 3), (0, 0, 0), SIZE)), **changes)


def wait_for(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.001)


@pytest.fixture
def stage():
    yield Stage()
    close_all()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("photon_maps")]


def test_the_first_picture_is_coarse_and_the_last_is_fine_and_done(stage: Stage) -> None:
    worker = stage.worker()
    assert not worker.is_busy
    stage.is_held = True
    worker.show(request())
    wait_for(lambda: worker.picture)
    coarse = worker.picture
    assert coarse.pixels.shape == (8, 10, 4)
    assert coarse.region == (0, 0, *SIZE)
    assert worker.is_busy
    stage.is_held = False
    wait_for(lambda: not worker.is_busy)
    assert worker.picture.pixels.shape == (64, 80, 4)
    assert (worker.picture.pixels == stage.passes).all()
    assert stage.log == ["load", "pass 10", *["pass 80"] * stage.passes]


def test_dear_pictures_become_finer_step_by_step(stage: Stage) -> None:
    stage.pass_seconds = 1000.0
    worker, wanted = stage.worker(), request()
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert stage.log == ["load", "pass 10", "pass 20", "pass 40", *["pass 80"] * 3]
    # Now it is known how dear they are.
    worker.show(replace(wanted, camera=camera((1, -5, 3), (0, 0, 0), SIZE)))
    wait_for(lambda: not worker.is_busy)
    assert stage.log[7:] == ["pass 5", "pass 10", "pass 20", "pass 40", *["pass 80"] * 3]


def test_large_pixels_are_the_finest(stage: Stage) -> None:
    worker, wanted = stage.worker(), request(pixel_size=4)
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert worker.picture.pixels.shape == (16, 20, 4) and worker.picture.region == (0, 0, *SIZE)
    worker.show(replace(wanted, pixel_size=1))
    wait_for(lambda: not worker.is_busy)
    assert worker.picture.pixels.shape == (64, 80, 4)
    assert stage.log.count("load") == 1


def test_photons_are_taken_for_a_first_look_and_of_the_last_pass(stage: Stage) -> None:
    worker, wanted = stage.worker(), request(wants_photons=True)
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert stage.log == ["load", "pass 10", "photons", *["pass 80"] * stage.passes, "photons"]
    assert worker.photons.pass_index == stage.passes - 1
    # From elsewhere they are the same.
    worker.show(replace(wanted, camera=camera((1, -5, 3), (0, 0, 0), SIZE)))
    wait_for(lambda: not worker.is_busy)
    assert stage.log.count("photons") == 2


def test_photons_that_are_wanted_later_cost_no_pass(stage: Stage) -> None:
    worker, wanted = stage.worker(), request()
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert worker.photons is None
    before, picture = list(stage.log), worker.picture
    worker.show(replace(wanted, wants_photons=True))
    wait_for(lambda: not worker.is_busy)
    assert stage.log == [*before, "photons"] and worker.photons is not None
    assert (worker.picture.pixels == picture.pixels).all()
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy and worker.photons is None)
    assert stage.log == [*before, "photons"]


def test_photons_that_cannot_be_taken_leave_the_picture(stage: Stage) -> None:
    stage.snapshot_trouble = NativeError(Status.OUT_OF_MEMORY, "no room")
    worker, wanted = stage.worker(), request(wants_photons=True)
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert stage.log == ["load", "pass 10", "photons", *["pass 80"] * stage.passes]
    assert (worker.picture.pixels == stage.passes).all() and not worker.failure
    assert worker.picture.status.endswith("no photons to show: no room") and worker.photons is None
    # Switched off and on again, they are tried once more.
    stage.snapshot_trouble = None
    worker.show(replace(wanted, wants_photons=False))
    wait_for(lambda: not worker.is_busy)
    worker.show(wanted)
    wait_for(lambda: worker.photons is not None)


def test_nothing_runs_once_it_is_done(stage: Stage) -> None:
    worker = stage.worker()
    worker.show(request())
    wait_for(lambda: not worker.is_busy)
    spent = time.process_time()
    time.sleep(0.2)
    assert time.process_time() - spent < 0.02
    assert len(stage.log) == 2 + stage.passes


def test_the_same_request_again_changes_nothing(stage: Stage) -> None:
    worker, wanted = stage.worker(), request()
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    worker.show(replace(wanted))
    assert not worker.is_busy


def test_another_camera_takes_the_same_scene_and_is_cheap_at_first(stage: Stage) -> None:
    worker, wanted = stage.worker(), request()
    stage.is_held = True
    worker.show(wanted)
    wait_for(lambda: "pass 80" in stage.log)
    worker.show(replace(wanted, camera=camera((1, -5, 3), (0, 0, 0), SIZE)))
    wait_for(lambda: stage.log.count("pass 80") == 2)
    assert stage.log.count("load") == 1
    # Pixels cost so little here that the picture need not be coarse.
    assert stage.log == ["load", "pass 10", "pass 80", "cancelled", "pass 80"]


def test_a_first_picture_is_finished_while_the_camera_goes_on_moving(stage: Stage) -> None:
    worker, wanted = stage.worker(), request()
    stage.is_coarse_held = stage.is_held = True
    worker.show(wanted)
    wait_for(lambda: "pass 10" in stage.log)
    for x in range(5):
        worker.show(replace(wanted, camera=camera((x, -5, 3), (0, 0, 0), SIZE)))
    stage.is_coarse_held = False
    wait_for(lambda: worker.picture)
    assert "cancelled" not in stage.log


@pytest.mark.parametrize(
    ("change", "loads"),
    [({"scene": still_life()}, 2), ({"settings": RenderSettings(seed=1)}, 1)],
    ids=["scene", "settings"],
)
def test_another_scene_is_loaded_and_another_setting_begins_again(stage: Stage, change: dict, loads: int) -> None:
    worker, wanted = stage.worker(), request()
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    worker.show(replace(wanted, **change))
    wait_for(lambda: not worker.is_busy)
    assert stage.log.count("load") == loads
    assert stage.log.count("pass 80") == 2 * stage.passes
    assert stage.open_things == 2  # a scene and a session


AUTOMATIC = RenderSettings(use_auto=True)


def test_an_edit_is_seen_with_few_photons_first(stage: Stage) -> None:
    worker, wanted = stage.worker(), request(settings=AUTOMATIC)
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert not [line for line in stage.log if line.startswith("look")]
    stage.log.clear()
    worker.show(replace(wanted, scene=still_life()))
    wait_for(lambda: not worker.is_busy)
    assert worker.picture.status.startswith("Pass 3")
    assert stage.log == ["load", "look 80", *["pass 80"] * stage.passes]  # so little does a pixel cost here
    assert stage.open_things == 2  # the first look is gone


def test_while_a_view_of_an_edit_moves_it_is_seen_with_few_photons(stage: Stage) -> None:
    worker, wanted = stage.worker(), request(settings=AUTOMATIC)
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    stage.log.clear()
    stage.held = {"pass"}
    edited = replace(wanted, scene=still_life())
    worker.show(edited)
    wait_for(lambda: "pass 80" in stage.log)
    assert worker.picture.status.startswith("First look")
    worker.show(replace(edited, camera=camera((1, -5, 3), (0, 0, 0), SIZE)))
    wait_for(lambda: stage.log.count("pass 80") == 2)
    assert stage.log == ["load", "look 80", "pass 80", "cancelled", "look 80", "pass 80"]
    stage.held = set()
    wait_for(lambda: not worker.is_busy)
    # Now that there are photon maps, they show it from elsewhere, too.
    worker.show(edited)
    wait_for(lambda: not worker.is_busy)
    assert stage.log.count("look 80") == 2
    # Settings by hand hold from the first picture on.
    worker.show(replace(edited, settings=RenderSettings()))
    wait_for(lambda: not worker.is_busy)
    assert stage.log.count("look 80") == 2


@pytest.mark.parametrize("hold", ["is_held", "is_coarse_held"])
def test_closing_in_the_middle_of_a_pass_ends_the_thread_and_frees_all(stage: Stage, hold: str) -> None:
    worker = stage.worker()
    setattr(stage, hold, True)
    worker.show(request())
    wait_for(lambda: ("pass 80" if hold == "is_held" else "pass 10") in stage.log)
    worker.close()
    worker.close()
    worker.wait()
    assert stage.open_things == 0
    assert worker.picture is None
    assert not worker.is_busy
    worker.show(request())
    assert threading.active_count() == 1


def test_a_worker_that_never_had_anything_to_do_can_be_closed(stage: Stage) -> None:
    worker = stage.worker()
    worker.close()
    worker.wait()


def test_a_final_render_has_the_cores_for_itself(stage: Stage) -> None:
    worker = stage.worker()
    stage.is_held = True
    worker.show(request())
    wait_for(lambda: "pass 80" in stage.log)
    with paused():
        wait_for(lambda: stage.log[-1] == "cancelled")
        time.sleep(0.05)
        assert stage.log[-1] == "cancelled"
        stage.is_held = False
        assert worker.is_busy  # there will be more to see
    wait_for(lambda: not worker.is_busy)
    assert worker.picture.pixels.shape == (64, 80, 4)


@pytest.mark.parametrize(
    ("trouble", "said"),
    [(NativeError(Status.INVALID_ARGUMENT, "mesh 0 is broken"), "mesh 0 is broken"), (KeyError("x"), "KeyError: 'x'")],
    ids=["refused", "unforeseen"],
)
def test_what_fails_is_said_and_the_next_scene_is_rendered(
    stage: Stage, monkeypatch: pytest.MonkeyPatch, trouble: Exception, said: str
) -> None:
    raised = []
    monkeypatch.setattr(threading, "excepthook", raised.append)
    worker = stage.worker()
    stage.trouble = trouble
    worker.show(request())
    wait_for(lambda: worker.failure)
    assert worker.failure == said
    wait_for(lambda: not worker.is_busy and stage.open_things == 0)
    worker.show(request())
    wait_for(lambda: worker.picture and not worker.is_busy)
    assert worker.failure == ""
    assert [type(one.exc_value) for one in raised] == ([] if isinstance(trouble, NativeError) else [KeyError])


def test_the_helper_itself_renders_a_view_and_is_left_in_the_middle_of_a_pass() -> None:
    worker = ViewportWorker()
    wanted = request(settings=RenderSettings(passes=2, use_auto=True))
    worker.show(wanted)
    wait_for(lambda: not worker.is_busy)
    assert worker.failure == ""
    picture: Picture = worker.picture
    assert picture.pixels.shape == (64, 80, 4)
    assert picture.pixels[..., :3].mean() > 0.01
    endless = replace(wanted, camera=camera((0, -5, 3), (0, 0, 0), (1024, 1024)), settings=RenderSettings(passes=1000))
    worker.show(endless)
    time.sleep(0.3)
    worker.close()
    began = time.monotonic()
    worker.wait()
    assert time.monotonic() - began < PATIENCE
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("photon_maps")]
