"""A live session for scripts and notebooks: it runs beside them, and both may change the layout.

>>> import fixture_design as fd                                        # doctest: +SKIP
>>> session = fd.interactive("urdf/bracket/bracket.layout.yaml")       # prints where to look
>>> session.slide(0.002, 0.0)                                          # as with the sliders, in metres
>>> fd.verify(session.stop())                                          # the layout as it is then
"""

from __future__ import annotations

import atexit
import threading
from pathlib import Path
from traceback import clear_frames
from typing import TypeVar

from fixture_design.design.drawing_up import empty_layout
from fixture_design.design.plans import plans
from fixture_design.design.task import Task
from fixture_design.errors import FileFormatError, UnsupportedError
from fixture_design.io import TASK_ENDINGS, read_task_or_layout, task_of_part
from fixture_design.layout import Layout, named_files
from fixture_design.verification.surface import PartSurface
from fixture_design.viewing.session.files import target_of
from fixture_design.viewing.session.live import Live
from fixture_design.viewing.session.steering import Steering

S = TypeVar("S", bound=Steering)


class Interactive(Steering):
    """A session with a browser beside the program (`interactive`).

    Attributes:
        address: where to look; None without a browser.
        failure: what ended the session against its will.
    """

    address: str | None = None
    failure: Exception | None = None
    _thread: threading.Thread | None = None

    def start(self, port: int | None) -> None:
        """Opens it to a browser.

        Raises:
            InputError: the port is taken.
        """
        self._stopping, ready = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._live, args=(port, ready), name="interactive", daemon=True)
        self._thread.start()
        ready.wait()
        if self.failure is not None:
            raise self.failure

    def stop(self) -> Layout:
        """Ends the session; what nobody saved is in a recovery file then, which is told. The layout as it is."""
        if self._thread is not None and self._thread is not threading.current_thread():
            self._stopping.set()
            self._thread.join()
            self._thread = None
        _tell_recovered(self.leave())
        if self.failure is not None:
            raise self.failure
        return self.layout

    def _live(self, port: int | None, ready: threading.Event) -> None:
        """In a thread of its own, which Drake's Meshcat does not leave."""
        live = None
        try:
            live = Live(self, port)
            self.address = live.address
            ready.set()
            live.run(self._stopping.is_set)
        except Exception as error:  # noqa: BLE001 - told by `start` or `stop`, in the thread that called them
            _forget_frames(error)  # else the Meshcat in them would end in that thread, and the program with it
            self.failure = error
        finally:
            if live is not None:
                live.close()
            ready.set()
            _tell_recovered(self.leave())

    def _repr_html_(self) -> str:
        where = "no browser" if self.address is None else f'<a href="{self.address}">{self.address}</a>'
        return f"<p>interactive session: {where}</p>"


def interactive(
    thing: Layout | str | Path,
    *,
    port: int | None = None,
    scale: float = 1.0,
    out: str | Path | None = None,
    browser: bool = True,
) -> Interactive:
    """A session about a layout, a layout file or a part, which does not block; its address is printed.

    Args:
        port: on this machine, which alone can reach it; by default the first free one from 7000 on.
        scale: of a part file's vertices.
        out: the file that `save` writes; by default a new one beside the input.
        browser: without it, only its operations are there.

    Raises:
        InputError: the file or the layout cannot be used, or the port is taken.
    """
    steering = begun(Interactive, thing, scale, None if out is None else Path(out))
    if browser:
        steering.start(port)
        print(f"interactive session: {steering.address}")
    atexit.register(steering.stop)
    return steering


def begun(kind: type[S], thing: Layout | str | Path, scale: float = 1.0, out: Path | None = None) -> S:
    """The beginning of a session."""
    layout, source = _layout_of(thing, scale)
    if layout.part is None:
        raise UnsupportedError("a layout without a part has no surface to slide over", source=layout.source)
    return kind(layout, target_of(source, out, named_files(layout)))


def _layout_of(thing: Layout | str | Path, scale: float) -> tuple[Layout, Path | None]:
    if isinstance(thing, Layout):
        return thing, thing.source
    path = Path(thing)
    if path.suffix.lower() not in TASK_ENDINGS:
        return _bare(task_of_part(path, scale)), path
    if scale != 1:
        raise FileFormatError("`scale` is for part files", source=path, expected="`scale` in the layout's `part`")
    given = read_task_or_layout(path)
    if isinstance(given, Layout):
        return given, path
    raise UnsupportedError("a session is about a layout or a part, not a task", source=path)


def _bare(task: Task) -> Layout:
    """The layout of a task to begin with, nothing but the part, with what is required."""
    plan = next(plans(task, PartSurface(task.part, task.surface_gap)))
    return empty_layout(task, plan.require, plan.friction)


def _forget_frames(error: BaseException | None) -> None:
    """Of an exception and those that it came of."""
    while error is not None:
        clear_frames(error.__traceback__)
        error = error.__cause__ or error.__context__


def _tell_recovered(path: Path | None) -> None:
    if path is not None:
        print(f"unsaved changes are in {path}")
