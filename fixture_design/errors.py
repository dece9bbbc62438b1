"""Exceptions that carry what was given, what was expected and what to try.

Everything a user can cause derives from `InputError`; the command line prints its message and exits with 2. Whatever
else escapes is a fault of the toolkit (exit code 4).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path


class FixtureDesignError(Exception):
    """Base of all exceptions that this package raises on purpose."""


class InputError(FixtureDesignError, ValueError):
    """Something the user gave cannot be used.

    Attributes:
        problem: what is wrong, in one sentence.
        source: the file it was read from, if any.
        place: where in the file ("line 12, elements[2].role"), if known.
        found: the offending value as text, if there is one.
        expected: what would have been right, if that can be said.
        named_at: where the layout names ``source``, if that is another file than the layout's own.
    """

    def __init__(
        self,
        problem: str,
        *,
        source: str | Path | None = None,
        place: str | None = None,
        found: str | None = None,
        expected: str | None = None,
    ) -> None:
        self.problem, self.source, self.place, self.found, self.expected = problem, source, place, found, expected
        self.named_at: str | None = None
        super().__init__(problem)

    def __str__(self) -> str:
        where = ": ".join(str(part) for part in (self.source, self.place) if part)
        words = {"found": self.found, "expected": self.expected, "named at": self.named_at}
        text = "; ".join([self.problem, *(f"{word} {value}" for word, value in words.items() if value)])
        return f"{where}: {text}" if where else text

    def within(self, source: str | Path, place: str | None = None) -> InputError:
        """The same error, with the file (and place) it was met in, where it did not know them yet."""
        self.source = self.source or source
        self.place = self.place or place
        return self

    def met_at(self, source: str | Path | None, place: str | None) -> InputError:
        """The same error, met while looking at this place of a layout: there, or in a file that it names there."""
        if self.source is None or str(self.source) == str(source):
            self.source = source
            self.place = ": ".join(filter(None, [place, self.place])) or None
        else:
            self.named_at = self.named_at or place
        return self


@contextmanager
def looking_at(source: str | Path | None, place: str | None) -> Iterator[None]:
    """Errors that come up in here know that this place of a layout was looked at."""
    try:
        yield
    except InputError as error:
        error.met_at(source, place)
        raise


class KernelError(FixtureDesignError):
    """The compiled kernel failed where it should not have, or was asked for where it is not: a fault of ours."""


class SolverError(FixtureDesignError):
    """A solver ended without an answer: neither an optimum nor a proof that there is none."""


class FileFormatError(InputError):
    """A file cannot be read, does not parse, or does not follow its schema."""


class UnknownNameError(InputError):
    """A name that should refer to something does not; the message lists the names there are."""

    def __init__(
        self,
        kind: str,
        name: str,
        known: Iterable[str],
        *,
        source: str | Path | None = None,
        place: str | None = None,
    ) -> None:
        names = sorted(known)
        close = get_close_matches(name, names, n=1)
        hint = f"did you mean {close[0]!r}? " if close else ""
        self.name, self.known = name, names
        problem = f"no {kind} is called {name!r}; {hint}there are: {', '.join(names) or 'none'}"
        super().__init__(problem, source=source, place=place)


class DimensionError(InputError):
    """Arrays, cones or contacts of different dimensions were put together."""


class ConeError(InputError):
    """A cone operation cannot give its result (no form given, values not finite, size beyond the limits)."""


class ContactError(InputError):
    """A contact is not one: zero or non-finite normal, negative friction, nothing to touch with."""


class GeometryError(InputError):
    """A part's geometry cannot be used: not closed, empty, unreadable, or refused by the geometry engine."""


class AssemblyError(InputError):
    """Two parts cannot be put together as asked: a body or region that is none, a configuration that overlaps."""


class UnsupportedError(InputError):
    """Valid input that this version of the toolkit does not evaluate yet."""


class OffSurfaceError(GeometryError):
    """An element does not reach the surface it should touch.

    Attributes:
        element: the element's name.  distance: signed distance [m].  feature: the nearest facet's name.
    """

    def __init__(self, element: str, part: str, distance: float, feature: str, gap: float) -> None:
        self.element, self.distance, self.feature = element, distance, feature
        side = "off the surface of" if distance > 0 else "inside"
        super().__init__(
            f"element {element!r} is {format_length(abs(distance))} {side} {part!r}; nearest: {feature}; "
            f"move it there, or raise `surface_gap` ({format_length(gap)})"
        )


class PenetrationError(GeometryError):
    """A fixture body is inside the part, deeper than counts as touching.

    Attributes:
        body: its name.  depth: the largest one found [m].  point: where, in W [m].
    """

    def __init__(self, body: str, depth: float, point: Sequence[float], inner: str, outer: str, gap: float) -> None:
        self.body, self.depth, self.point = body, depth, tuple(float(x) for x in point)
        place = ", ".join(f"{round(x, 6) + 0.0:g}" for x in self.point)
        super().__init__(
            f"body {body!r} and the part overlap by {format_length(depth)} at [{place}] m: {inner} is inside {outer}; "
            f"move the body, or raise `surface_gap` ({format_length(gap)})"
        )


def format_length(metres: float) -> str:
    """A length as people write it: 4.2 mm, 0.35 um, 1.2 m (input in metres)."""
    for factor, unit in ((1.0, "m"), (1e3, "mm")):
        text = f"{metres * factor:.3g}"
        if abs(float(text)) >= 1:
            return f"{text} {unit}"
    return f"{metres * 1e6:.3g} um"
