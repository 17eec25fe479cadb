# SPDX-License-Identifier: GPL-3.0-or-later
"""The thread that renders for a viewport: the newest request, coarsely at once, then finer until it is good enough.

Knows nothing of Blender, and calls nothing of it. Whoever asks is never kept waiting: requests are left here, pictures
are picked up when there are new ones.
"""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from photon_maps_native import NativeError

from .last_photons import LastPhotons
from .session import LoadedScene, Session
from .viewport_rendering import Picture, Rendering, Request


class ViewportWorker:
    """Renders in a thread of its own what was last asked for."""

    def __init__(self, load: Callable = LoadedScene, start: Callable = Session) -> None:
        """Start nothing yet: the thread begins with the first request.

        :param load: makes a loaded scene, and ``start`` a session; as engine.session has them.
        """
        self._load, self._start = load, start
        self._condition = threading.Condition()  # guards all below; nobody waits for anything else while holding it
        self._request: Request | None = None
        self._running: Session | None = None  #: a session in the middle of a pass
        self._is_coarse = False  #: that pass: it takes no time worth a cancel
        self._is_idle = True
        self._is_paused = self._is_closed = False
        self._picture: Picture | None = None
        self._photons: LastPhotons | None = None
        self._failure = ""
        self._thread: threading.Thread | None = None
        _workers.add(self)

    def show(self, request: Request) -> None:
        """Render this from now on; what is rendered for another view or scene stops."""
        with self._condition:
            before = self._request
            is_same = request.shows_view_of(before) and request.wants_photons == before.wants_photons
            if self._is_closed or is_same:
                return
            self._request, self._failure, self._is_idle = request, "", False
            # A first picture is let finish: cancelled by each of many small moves, there would never be one.
            if self._running is not None and not self._is_coarse:
                self._running.cancel()
            self._wake()

    def _wake(self) -> None:
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._run, name="photon_maps viewport", daemon=True)
            self._thread.start()
        self._condition.notify_all()

    @property
    def picture(self) -> Picture | None:
        """The newest picture."""
        return self._picture

    @property
    def photons(self) -> LastPhotons | None:
        """The photons of a pass, where they are wanted."""
        return self._photons

    @property
    def failure(self) -> str:
        """Why there is no picture of what was asked for, in a sentence; empty while there may be."""
        return self._failure

    @property
    def is_busy(self) -> bool:
        """Whether a newer picture may come without another request; after a pause, too."""
        return not (self._is_idle or self._is_closed)

    def pause(self) -> None:
        """Stop until resume(), leaving all cores to somebody else."""
        with self._condition:
            self._is_paused = True
            self._cancel()

    def resume(self) -> None:
        """Go on."""
        with self._condition:
            self._is_paused = False
            self._condition.notify_all()

    def close(self) -> None:
        """End the thread as soon as it can; without waiting for it, and as often as one likes."""
        with self._condition:
            self._is_closed = True
            self._request = self._picture = self._photons = None
            self._cancel()

    def _cancel(self) -> None:
        if self._running is not None:
            self._running.cancel()
        self._condition.notify_all()

    def wait(self) -> None:
        """Wait until the thread has ended, after close(); a pass ends within a tenth of a second."""
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    # --- In the thread ---

    def _run(self) -> None:
        rendering = Rendering(self._load, self._start)
        try:
            while (request := self._next(rendering)) is not None:
                try:
                    rendering.follow(request)
                    self._step(rendering)
                except NativeError as error:
                    rendering.give_up()
                    self._fail(str(error))
        except Exception as error:
            with self._condition:
                self._thread = None  # the next request gets another
            self._fail(f"{type(error).__name__}: {error}")
            raise
        finally:
            rendering.close()

    def _next(self, rendering: Rendering) -> Request | None:
        """Return what is to be rendered, once there is something; None at the end."""
        with self._condition:
            while not self._is_closed:
                self._is_idle = self._request is rendering.request and rendering.is_done
                if self._request is not None and not (self._is_idle or self._is_paused):
                    break
                self._condition.wait()
            return self._request

    def _step(self, rendering: Rendering) -> None:
        with self._condition:
            if self._is_closed or self._is_paused:
                return
            self._running, self._is_coarse = rendering.session, rendering.is_coarse_due
        try:
            is_whole = rendering.step()
        finally:
            with self._condition:
                self._running = None
        if is_whole:
            picture = rendering.picture_to_show()
            with self._condition:
                if self._is_closed:
                    return
                self._picture, self._photons = picture or self._picture, rendering.photons

    def _fail(self, sentence: str) -> None:
        with self._condition:
            self._failure, self._is_idle = sentence, True


#: All workers there are, so that none outlives the engine.
_workers: weakref.WeakSet[ViewportWorker] = weakref.WeakSet()


def close_all() -> None:
    """End all threads, and wait for them."""
    workers = list(_workers)
    for worker in workers:
        worker.close()
    for worker in workers:
        worker.wait()


@contextmanager
def paused() -> Iterator[None]:
    """Leave the cores to a final render."""
    workers = list(_workers)
    for worker in workers:
        worker.pause()
    try:
        yield
    finally:
        for worker in workers:
            worker.resume()
