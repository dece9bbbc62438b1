"""Operations on a session by name, each judged before it counts: a change that geometry refuses is not made.

What a person steers by: the session, its verdict, and a message about the last thing that happened. A script may use
it as it is; `live` puts it into a browser.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import ROLES, unit_normal
from fixture_design.design import DesignResult, repair
from fixture_design.design.next_element import NextElement, next_element
from fixture_design.errors import InputError
from fixture_design.geometry import Polygon
from fixture_design.layout import Layout, PinTip, Verdict, element_name
from fixture_design.viewing.session import session as steps
from fixture_design.viewing.session.errand import Errand, Work
from fixture_design.viewing.session.files import content_of, copies, recover, write_known, written_anew
from fixture_design.viewing.session.finding import addition_in_words, changes_in_words, no_changes_in_words
from fixture_design.viewing.session.session import Session
from fixture_design.viewing.session.sliding import axes
from fixture_design.viewing.session.tips import tips_after
from fixture_design.viewing.session.workpiece import Workpiece


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
        self._known = content_of(target)
        self.verdict: Verdict = self.work.verify(layout)
        self.message, self.version = "", 0
        self.told: tuple[str, str] | None = None
        self.lock = threading.RLock()
        self._errand: Errand | None = None

    @property
    def layout(self) -> Layout:
        return self.session.layout

    @property
    def busy(self) -> bool:
        """Whether something is being looked for; nothing is changed meanwhile."""
        return self._errand is not None

    @property
    def actions(self) -> dict[str, Callable[[], None]]:
        """The operations without arguments, by the names of their buttons; none of them takes long."""
        return {
            "add at the best place": self.look_for_place,
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
        self.look_for_place()
        self.wait()

    def look_for_place(self) -> None:
        """Starts to look for the best place of the element that the layout needs next; `poll` puts it there."""
        layout = self.layout
        self._begin("looking for the best place", lambda progress, cancelled: next_element(layout, self.work))

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
            for tip in tips_after(element.tip, self.work.scale().length, self._along(element.at)):
                if self._try(lambda session, tip=tip: steps.with_tip(session, tip)):
                    return

    def undo(self) -> None:
        """Takes back the last step."""
        self._try(steps.undone)

    def redo(self) -> None:
        """Makes the last step that was taken back again."""
        self._try(steps.redone)

    def save(self, path: str | Path | None = None) -> None:
        """Writes the layout, to ``path`` from now on where it is given; not over what others wrote meanwhile."""
        with self.lock:
            target = self.target if path is None else Path(path)
            try:
                known = self._known if target == self.target else content_of(target)
                self._saved(target, write_known(self.layout, target, known))
            except InputError as error:
                self._say(f"not saved: {error}")

    def save_copy(self) -> None:
        """Saves to a new file, and goes on with that."""
        with self.lock:
            try:
                target = written_anew(self.layout, copies(self.target))
                self._saved(target, content_of(target))
            except InputError as error:
                self._say(f"not saved: {error}")

    def make_valid(self) -> None:
        """Starts to look for the fewest changes that make the requirements hold; `poll` puts them in."""
        layout = self.layout
        self._begin(
            "looking for the fewest changes",
            lambda progress, cancelled: repair(layout, self.work, progress=progress, cancelled=cancelled),
        )

    def cancel(self) -> None:
        """Gives up what is being looked for."""
        with self.lock:
            if self._errand is not None:
                self._errand.cancel()
                self._say("cancelling")

    def poll(self) -> None:
        """Puts in what was looked for, once it is found."""
        with self.lock:
            errand = self._errand
            if errand is None or not errand.done:
                return
            self._errand, found = None, errand.found
            if errand.cancelled:
                self._say("cancelled; nothing has changed")
            elif isinstance(found, InputError):
                self._say(str(found))
            elif isinstance(found, Exception):
                raise found
            else:
                self._put(found)

    def wait(self) -> None:
        """Until nothing is being looked for any more."""
        errand = self._errand
        if errand is not None:
            errand.wait()
        self.poll()

    def tell(self, story: tuple[str, str] | None) -> None:
        """Looks at another answer."""
        with self.lock:
            self.told = None if story == self.told else story
            self.version += 1

    def leave(self) -> Path | None:
        """Ends: what is not saved goes to a recovery file, which is told."""
        with self.lock:
            if self._errand is not None:
                self._errand.cancel()
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

    def _begin(self, about: str, work: Work) -> None:
        """Sends for something; who asks for the same again meanwhile changes nothing."""
        with self.lock:
            if self._errand is not None and self._errand.about == about:
                return
            if not self._refuses():
                self._say(about)
                self._errand = Errand(about, work, self._progress)

    def _refuses(self) -> bool:
        if self._errand is not None:
            self._say(f"{self._errand.about}: wait, or `cancel` first")
        return self.busy

    def _say(self, message: str) -> None:
        with self.lock:
            self.message = message
            self.version += 1

    def _saved(self, target: Path, content: str | None) -> None:
        self.session, self.target, self._known = steps.as_saved(self.session), target, content
        nothing = "" if self.verdict.contacts else "; it has no contacts yet, and `verify` refuses such a layout"
        self._say(f"saved {target}{nothing}")

    def _progress(self, words: str, part: float) -> None:
        """From the errand's thread."""
        with self.lock:
            if self._errand is not None and not self._errand.cancelled:
                self._say(f"{words} ({part:.0%})")

    def _put(self, found: object) -> None:
        if isinstance(found, NextElement):
            if self._try(lambda session: steps.added(session, found.name, found.role, found.at)):
                self._say(addition_in_words(found, self.work.scale()))
            return
        assert isinstance(found, DesignResult)
        if found.layout is None or not found.steps:
            self._say(no_changes_in_words(found))
            return
        layout = found.layout
        if self._try(lambda session: steps.put(session, layout)):
            self._say(changes_in_words(found))

    def _along(self, at: Point) -> Point:
        """A direction along the surface, in W."""
        if isinstance(self.work.geometry, Polygon):
            on = next(contact for contact in self.verdict.contacts if element_name(contact.name) == self.session.chosen)
            normal = unit_normal(on.normals[0])
            return np.array([-normal[1], normal[0]])
        return axes(self.work.ground, at)[0]
