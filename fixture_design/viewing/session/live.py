"""The loop of a live session: what the browser asks for is done, judged and drawn again."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.errors import InputError
from fixture_design.layout import Verdict
from fixture_design.viewing.drake_meshcat import SAID, draw, started
from fixture_design.viewing.palette import BLACK, MOTION
from fixture_design.viewing.scene import Arrow, Camera, Label, Scene, Solid, Sphere, Story, Thing, scene_of, solid_of
from fixture_design.viewing.scene.space import lifted
from fixture_design.viewing.scene.stories import foremost
from fixture_design.viewing.session.lines import Line, element_line, verdict_lines, wrapped
from fixture_design.viewing.session.page import Server, session_page
from fixture_design.viewing.session.panel import Panel, Reading
from fixture_design.viewing.session.sliding import axes
from fixture_design.viewing.session.steering import Steering
from fixture_design.viewing.session.tips import round_size

if TYPE_CHECKING:
    from pydrake.geometry import Meshcat

#: How often the browser is asked for what it wants [s].
_POLL = 0.003
#: In half diagonals: reach and step of the sliders, the mark and the arrows at the chosen element [-].
_REACH, _STEP, _MARK, _ARROW = 2.0, 0.005, 0.045, 0.22
#: Drake's own ports begin here; those below 1024 are for the system.
_LOWEST_PORT, _HIGHEST_PORT = 1024, 65535

QUIT = "quit"


class Live:
    """A session in a browser. It is made, run and ended in one thread, as Drake's Meshcat wants it.

    Attributes:
        address: where to look.
        drawn: how often everything was sent.
    """

    def __init__(self, steering: Steering, port: int | None = None) -> None:
        self.steering, self.drawn = steering, 0
        self._flat = steering.layout.space == "planar"
        self._solid: Solid | None = solid_of(steering.layout, steering.work.geometry)
        self._scene: Scene | None = None
        self._begun = threading.Event()
        self._server = _served(self._page, port)
        self.address = self._server.address
        self._meshcat: Meshcat = _opened(self._server)
        self._socket: int = self._meshcat.port()  # asked in this thread, the only one that Drake lets ask
        size = steering.work.scale().length
        actions = [*steering.actions, QUIT]
        self._panel = Panel(self._meshcat, actions, _REACH * size, round_size(_STEP * size), self._flat)
        self._things: tuple[Thing, ...] | None = None
        self._camera: Camera | None = None
        self._seen: int | None = None
        self._reading: Reading | None = None
        self._shown: tuple[str | None, int, bool] | None = None
        self._redraw()
        self._begun.set()

    def run(self, stopped: Callable[[], bool]) -> None:
        """Until it is stopped, or somebody quits in the browser."""
        while not stopped():
            if not self.step():
                return
            time.sleep(_POLL)

    def close(self) -> None:
        """Ends it, in the thread that made it."""
        self._server.close()
        del self._panel, self._meshcat

    def _page(self) -> str:
        """In the server's thread; whoever comes before the first drawing waits."""
        self._begun.wait()
        assert self._scene is not None
        return session_page(self._scene, self._socket)

    def step(self) -> bool:
        """Does what was asked for since the last step; False once that was to quit."""
        steering = self.steering
        with steering.lock:
            steering.poll()
            for action in self._panel.clicked():
                if action == QUIT:
                    return False
                steering.actions[action]()
            asked = self._panel.asked()
            if asked is not None:
                steering.tell(asked.story)
            self._follow(self._panel.read())
            if steering.version != self._seen:
                self._redraw()
        return True

    def _follow(self, reading: Reading | None) -> None:
        """Does what the sliders say, if they say something new."""
        before, self._reading = self._reading, reading
        if reading is None or before is None or reading == before:
            return
        if reading.number != before.number:
            self.steering.choose(reading.number)
        elif self._shown == self._state():  # else the sliders were moved for an element that is gone
            self.steering.slide(reading.u, reading.v)

    def _state(self) -> tuple[str | None, int, bool]:
        """What the sliders are about: they begin again where it changes."""
        session = self.steering.session
        return session.chosen, len(session.layout.elements), session.slide is not None

    def _redraw(self) -> None:
        steering = self.steering
        self._seen = steering.version
        told = steering.told if _known(steering.told, steering.verdict) else _foremost(steering.verdict)
        tell = set() if told is None else {told}
        scene = scene_of(steering.layout, steering.verdict, self._solid, tell, self._camera)
        story = next((each for each in scene.stories if (each.group, each.claim) == told), None)
        self._things = draw(self._meshcat, self._with_mark(scene, story), story or _nothing(scene), self._things)
        self._scene, self._camera = scene, self._camera or scene.camera
        self._show_sliders()
        self._panel.write(self._lines(told))
        self.drawn += 1

    def _show_sliders(self) -> None:
        now, before = self._state(), self._shown
        self._shown = now
        sliding = before is not None and now[:2] == before[:2] and now[2]
        refused = before == now
        if sliding or refused:
            return
        names = [element.name for element in self.steering.layout.elements]
        chosen, count = now[0], len(names)
        self._reading = self._panel.show(names.index(chosen) + 1 if chosen in names else 1, count, self._reading)

    def _lines(self, told: tuple[str, str] | None) -> list[Line]:
        steering = self.steering
        unsaved = "not saved yet: " if steering.session.unsaved else "file: "
        return [
            element_line(steering.session.element),
            *wrapped(steering.message),
            *verdict_lines(steering.verdict, told),
            *wrapped(unsaved + str(steering.target.name)),
        ]

    def _with_mark(self, scene: Scene, story: Story | None) -> Scene:
        """With a ball around the chosen element, arrows along which it is slid, and what is said, else what is told."""
        words = "" if story is None else f"{story.group}: {story.claim.replace('_', ' ')}: {story.words}"
        said = Label(SAID, self.steering.message or words, scene.center)
        element = self.steering.session.element
        if element is None:
            return replace(scene, labels=(*scene.labels, said))
        at, size = lifted(element.at), scene.size
        things: list[Thing] = [Thing("chosen/ball", Sphere(at, _MARK * size), MOTION, 0.5)]
        labels: list[Label] = []
        ways = () if self._flat else axes(self.steering.work.ground, element.at)
        for name, way in zip("uv", ways, strict=False):
            end = at + _ARROW * size * np.asarray(way)
            things.append(Thing(f"chosen/{name}", Arrow(at, end, _MARK * size / 5), BLACK))
            labels.append(Label("chosen", name, end + _MARK * size * np.asarray(way)))
        return replace(scene, things=(*scene.things, *things), labels=(*scene.labels, *labels, said))


def _served(page: Callable[[], str], port: int | None) -> Server:
    if port is not None and not _LOWEST_PORT <= port <= _HIGHEST_PORT:
        expected = f"{_LOWEST_PORT} to {_HIGHEST_PORT}"
        raise InputError("no port for a session", found=str(port), expected=expected)
    try:
        return Server(page, port)
    except OSError as cause:
        where = "any port" if port is None else f"port {port}"
        raise InputError(f"the session cannot listen on {where}: {cause}", expected="a port that is free") from cause


def _opened(server: Server) -> Meshcat:
    try:
        return started()
    except RuntimeError as cause:
        server.close()
        raise InputError(f"the session cannot listen on any port: {cause}", expected="a port that is free") from cause


def _foremost(verdict: Verdict) -> tuple[str, str] | None:
    """(group, claim) of the answer that matters most, of groups with contacts; None without any."""
    required = {(each.group, each.require) for each in verdict.requirements}
    answers = [
        (claim, group.name, finding.answer, (group.name, claim) in required)
        for group in verdict.groups.values()
        if group.contacts
        for claim, finding in group.findings.items()
    ]
    number = foremost(answers)
    return None if number is None else (answers[number][1], answers[number][0])


def _known(told: tuple[str, str] | None, verdict: Verdict) -> bool:
    return told is not None and told[0] in verdict.groups and told[1] in verdict.groups[told[0]].findings


def _nothing(scene: Scene) -> Story:
    """A story without anything to see, in place of the scene's first one."""
    return Story("stories/none", "", "", scene.satisfied, False, "")
