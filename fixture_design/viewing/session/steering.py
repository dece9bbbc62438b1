"""Operations on a session by name, each judged before it counts: a change that geometry refuses is not made.

What a person steers by: the session, its verdict, and a message about the last thing that happened. A script may use
it as it is; `live` puts it into a browser.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import ROLES, unit_normal
from fixture_design.design import DesignResult, repair
from fixture_design.design.next_element import next_element
from fixture_design.errors import InputError
from fixture_design.geometry import Polygon
from fixture_design.io import write_layout
from fixture_design.layout import (
    Answer,
    Layout,
    LineTip,
    PadTip,
    PinTip,
    PointTip,
    SoftTip,
    SphereTip,
    Tip,
    Verdict,
    element_name,
)
from fixture_design.viewing.motion_words import motion_in_words
from fixture_design.viewing.session import session as steps
from fixture_design.viewing.session.files import another, recover
from fixture_design.viewing.session.session import Session
from fixture_design.viewing.session.sliding import axes
from fixture_design.viewing.session.workpiece import Workpiece

#: Size of a new tip in half diagonals of the part [-].
_TIP = 0.04


class Steering:
    """A session that is being steered; its operations may come from several threads, one at a time.

    Attributes:
        session, verdict: what there is now.
        message: about the last operation, for people; empty if there is nothing to say.
        target: the file that `save` writes.
        version: grows with everything that changes what is seen.
        told: (group, claim) of the answer that is looked at; None for the one that matters most.
    """

    def __init__(self, layout: Layout, target: Path) -> None:
        assert layout.part is not None
        self.work = Workpiece(layout, layout.part)
        self.session, self.target = Session.of(layout), target
        self.verdict: Verdict = self.work.verify(layout)
        self.message, self.version = "", 0
        self.told: tuple[str, str] | None = None
        self.lock = threading.RLock()
        self._repair: threading.Thread | None = None
        self._repaired: DesignResult | Exception | None = None
        self._cancelled = threading.Event()

    @property
    def layout(self) -> Layout:
        return self.session.layout

    @property
    def busy(self) -> bool:
        """Whether a repair is going on; nothing else is done meanwhile."""
        return self._repair is not None

    @property
    def actions(self) -> dict[str, Callable[[], None]]:
        """The operations without arguments, by the names of their buttons."""
        return {
            "add at the best place": self.add,
            "remove": self.remove,
            "role": self.next_role,
            "tip": self.next_tip,
            "make valid": self.make_valid,
            "cancel": self.cancel,
            "undo": self.undo,
            "redo": self.redo,
            "save": self.save,
            "save a copy": self.save_copy,
        }

    def choose(self, number: int) -> None:
        """Chooses an element by its number, from 1."""
        with self.lock:
            elements = self.layout.elements
            if elements:
                name = elements[min(max(number, 1), len(elements)) - 1].name
                self.session = steps.chosen(self.session, name)
                self._say("")

    def slide(self, u: float, v: float = 0.0) -> None:
        """Slides the chosen element to (u, v) [m] from where it was chosen or came to rest."""
        self._try(lambda session: steps.slid_to(session, self.work.ground, u, v))

    def add(self) -> None:
        """Adds the element that the layout needs next, at its best place."""
        with self.lock:
            if self._refuses():
                return
            try:
                best = next_element(self.layout, self.work)
            except InputError as error:
                self._say(str(error))
                return
            if self._try(lambda session: steps.added(session, best.name, best.role, best.at)):
                report = self.work.scale()
                what = (
                    "the margin is largest there"
                    if best.motion is None
                    else f"{best.why} before it: {motion_in_words(best.motion, report.reference, report.length)}"
                )
                self._say(f"{best.name} on {best.feature}: {what}")

    def remove(self) -> None:
        """Removes the chosen element."""
        self._try(steps.removed)

    def next_role(self) -> None:
        """Gives the chosen element the next role: locator, support, clamp, finger, and round again."""
        with self.lock:
            element = self.session.element
            if element is not None:
                role = ROLES[(ROLES.index(element.role) + 1) % len(ROLES)]
                self._try(lambda session: steps.with_role(session, role))

    def next_tip(self) -> None:
        """Gives the chosen element the next tip that fits where it stands."""
        with self.lock:
            if self.session.element is None or self._refuses():
                return
            element = self.session.element
            if isinstance(element.tip, PinTip):
                self._say(f"{element.name} is a pin in its hole: another tip would touch nothing there")
                return
            for tip in self._tips_after(element.tip, element.at):
                if self._try(lambda session, tip=tip: steps.with_tip(session, tip)):
                    return

    def undo(self) -> None:
        """Takes back the last step."""
        self._try(steps.undone)

    def redo(self) -> None:
        """Makes the last step that was taken back again."""
        self._try(steps.redone)

    def save(self, path: str | Path | None = None) -> None:
        """Writes the layout, to ``path`` from now on where it is given."""
        with self.lock:
            target = self.target if path is None else Path(path)
            try:
                write_layout(self.layout, target)
            except InputError as error:
                self._say(f"not saved: {error}")
                return
            self.session, self.target = steps.as_saved(self.session), target
            self._say(f"saved {target}")

    def save_copy(self) -> None:
        """Saves to a new file, and goes on with that."""
        self.save(another(self.target))

    def make_valid(self) -> None:
        """Starts to look for the fewest changes that make the requirements hold; `poll` puts them in."""
        with self.lock:
            if self._refuses():
                return
            self._cancelled.clear()
            self._repaired = None
            self._repair = threading.Thread(target=self._make_valid, args=(self.layout,), daemon=True)
            self._say("looking for the fewest changes")
            self._repair.start()

    def cancel(self) -> None:
        """Gives up `make_valid`."""
        with self.lock:
            if self.busy:
                self._cancelled.set()
                self._say("cancelling")

    def poll(self) -> None:
        """Puts in what a repair has found, once it has."""
        with self.lock:
            if self._repair is None or self._repair.is_alive():
                return
            self._repair, found = None, self._repaired
            if isinstance(found, InputError) or found is None:
                self._say(str(found))
            elif isinstance(found, Exception):
                raise found
            elif self._cancelled.is_set():
                self._say("cancelled; nothing has changed")
            else:
                self._put(found)

    def wait(self) -> None:
        """Until no repair is going on."""
        if self._repair is not None:
            self._repair.join()
        self.poll()

    def tell(self, story: tuple[str, str] | None) -> None:
        """Looks at another answer."""
        with self.lock:
            self.told = None if story == self.told else story
            self.version += 1

    def leave(self) -> Path | None:
        """Ends: what is not saved goes to a recovery file, which is told."""
        with self.lock:
            self._cancelled.set()
            if not self.session.unsaved:
                return None
            path = recover(self.layout, self.target)
            self.session = steps.as_saved(self.session)
            return path

    def _try(self, change: Callable[[Session], Session]) -> bool:
        """Makes a change if what comes of it can be judged; else says why not, and leaves everything as it was."""
        with self.lock:
            if self._refuses():
                return False
            try:
                after = change(self.session)
                self.verdict = self.work.verify(after.layout)
            except InputError as error:
                self._say(str(error))
                return False
            self.session = after
            self._say("")
            return True

    def _refuses(self) -> bool:
        if self.busy:
            self._say("first `cancel`, or wait until the fewest changes are found")
        return self.busy

    def _say(self, message: str) -> None:
        self.message = message
        self.version += 1

    def _make_valid(self, layout: Layout) -> None:
        """In a thread of its own."""
        try:
            self._repaired = repair(layout, self.work, progress=self._progress, cancelled=self._cancelled.is_set)
        except Exception as error:  # noqa: BLE001 - raised again by `poll`, in the thread that waits for it
            self._repaired = error

    def _progress(self, words: str, part: float) -> None:
        if not self._cancelled.is_set():
            self._say(f"{words} ({part:.0%})")

    def _put(self, found: DesignResult) -> None:
        if found.layout is None or not found.steps:
            held = "all that is required holds already" if found.satisfied is Answer.YES else None
            self._say(found.reason or held or "no changes were found")
            return
        layout, count = found.layout, len(found.steps)
        if self._try(lambda session: steps.put(session, layout)):
            names = ", ".join(f"{step.element} {step.action}" for step in found.steps)
            doubt = f"; {found.reason}" if found.reason else ""
            self._say(f"{count} {'change' if count == 1 else 'changes'}: {names}{doubt}")

    def _tips_after(self, tip: Tip, at: Point) -> Iterator[Tip]:
        """The other kinds of tip, in a ring: point, ball, pad, line, soft."""
        size = round_size(_TIP * self.work.scale().length)
        along = self._along(at)
        kinds: list[Tip] = [PointTip(), SphereTip(size), PadTip(size, size, along), LineTip(size, along), SoftTip(size)]
        if isinstance(self.work.geometry, Polygon):
            kinds = [kinds[0], kinds[1], kinds[3]]
        here = next((number for number, kind in enumerate(kinds) if type(kind) is type(tip)), 0)
        yield from (*kinds[here + 1 :], *kinds[:here])

    def _along(self, at: Point) -> Point:
        """A direction along the surface, in W."""
        if isinstance(self.work.geometry, Polygon):
            on = next(contact for contact in self.verdict.contacts if element_name(contact.name) == self.session.chosen)
            normal = unit_normal(on.normals[0])
            return np.array([-normal[1], normal[0]])
        return axes(self.work.ground, at)[0]


#: Leading digits of sizes that people choose.
_DIGITS = (1, 2, 5)


def round_size(length: float) -> float:
    """1, 2 or 5 times a power of ten, the largest below a length [m]."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(digit * power for digit in _DIGITS if digit == 1 or digit * power < length))
