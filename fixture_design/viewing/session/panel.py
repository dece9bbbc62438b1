"""The controls in the browser: buttons for what can be done, sliders for the chosen element, and lines of text.

Drake's Meshcat has no text beside the drawing, so a line is a button: a click on an answer shows what it rests on. Its
names are run as code in the page, which is why only `lines.harmless` ones come here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fixture_design.viewing.session.lines import Line

#: Names of the sliders.
ELEMENT, U, V = "element", "u [mm]", "v [mm]"


@dataclass(frozen=True)
class Reading:
    """What the sliders say: the element's number, and how far it is slid [m]."""

    number: int
    u: float
    v: float


class Panel:
    """Buttons, sliders and lines of one Meshcat, in this order from above.

    What is added comes last; the buttons are never made anew, so that no click on them is lost.

    Args:
        reach, step: of the sliders for u and v [m].
        flat: without v, for planar parts.
    """

    def __init__(self, meshcat: object, actions: list[str], reach: float, step: float, flat: bool) -> None:
        self._board: Any = meshcat
        self._actions, self._reach, self._step, self._flat = actions, reach * 1e3, step * 1e3, flat
        self._elements: int | None = None
        self._lines: dict[str, Line] = {}
        self._clicks: dict[str, int] = {}
        self._answered: dict[str, int] = {}  # clicks on lines that stand since then
        for name in actions:
            self._board.AddButton(name)

    def read(self) -> Reading | None:
        """The sliders; None as long as there is nothing to choose."""
        if not self._elements:
            return None
        v = 0.0 if self._flat else self._board.GetSliderValue(V)
        u = self._board.GetSliderValue(U)
        return Reading(round(self._board.GetSliderValue(ELEMENT)), u / 1e3, v / 1e3)

    def clicked(self) -> list[str]:
        """Actions whose buttons were clicked since this was asked last, once for each click."""
        found = []
        for name in self._actions:
            clicks = self._board.GetButtonClicks(name)
            found += [name] * (clicks - self._clicks.get(name, 0))
            self._clicks[name] = clicks
        return found

    def asked(self) -> Line | None:
        """An answer whose line was clicked since this was asked last; lines that are about none are only read."""
        found = None
        for name, line in self._lines.items():
            clicks = self._board.GetButtonClicks(name)
            if clicks != self._answered.get(name, 0) and line.story is not None:
                found = line
            self._answered[name] = clicks
        return found

    def show(self, number: int, elements: int, known: Reading | None = None) -> Reading | None:
        """The sliders for one of some elements, as it stands; what they are set to.

        Args:
            known: what they said when they were last followed; what they say by now stays where that is possible.
        """
        if elements != self._elements:
            self._build(number, elements)
        elif elements:
            for name, wanted, was in self._wanted(number, known):
                if wanted != was:
                    self._board.SetSliderValue(name, wanted)
        return Reading(number, 0.0, 0.0) if elements else None

    def _wanted(self, number: int, known: Reading | None) -> list[tuple[str, float, float | None]]:
        """Of each slider its name, what it is to say, and what it said."""
        said = (None, None, None) if known is None else (float(known.number), known.u, known.v)
        return list(zip((ELEMENT, *self._ways), (float(number), 0.0, 0.0), said, strict=False))

    def write(self, lines: list[Line]) -> None:
        """The lines; from the first that differs on they are written again."""
        new = _by_name(lines)
        old = list(self._lines.items())
        same = next((k for k, pair in enumerate(new.items()) if k >= len(old) or old[k] != pair), len(new))
        for name, _ in old[same:]:
            self._remove(name)
        for name in list(new)[same:]:
            self._board.AddButton(name)
        self._lines = new

    @property
    def _ways(self) -> tuple[str, ...]:
        return (U,) if self._flat else (U, V)

    def _remove(self, name: str) -> None:
        """A line; one of this name that is added later has no clicks yet."""
        self._board.DeleteButton(name)
        self._answered.pop(name, None)

    def _build(self, number: int, elements: int) -> None:
        for name in self._lines:
            self._remove(name)
        for name in (ELEMENT, *self._ways):
            self._board.DeleteSlider(name, strict=False)
        self._lines, self._elements = {}, elements
        if elements:
            # a slider needs a range, also where there is nothing to choose from
            self._board.AddSlider(ELEMENT, 1, max(elements, 2), 1, number)
            for name in self._ways:
                self._board.AddSlider(name, -self._reach, self._reach, self._step, 0.0)


def _by_name(lines: list[Line]) -> dict[str, Line]:
    """Each under a name of its own: lines that are alike get spaces at the end."""
    found: dict[str, Line] = {}
    for line in lines:
        name = line.text or " "
        while name in found:
            name += " "
        found[name] = line
    return found
