"""What design asks of geometry and of verification, handed in by the caller; a fake of ten lines serves the tests."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

from fixture_design.arrays import Mask, Point, Points, Vector
from fixture_design.contacts import Contact, Scale
from fixture_design.design.candidates import Spots
from fixture_design.design.task import CandidateRules
from fixture_design.layout import Element, Layout, Part, Stem, Verdict

#: Told what is being done, in words, and what part of it is behind, from 0 to 1.
Progress = Callable[[str, float], None]


#: [f; m] about W's origin [N, N m]: the weight, and each load, or row of a load path.
Wrenches = tuple[Vector, Sequence[Vector]]


@runtime_checkable
class Hole(Protocol):
    """A round hole or a slot of the part in W, as `geometry.Hole` has it."""

    @property
    def feature(self) -> str: ...
    @property
    def low(self) -> Point: ...
    @property
    def high(self) -> Point: ...
    @property
    def diameter(self) -> float: ...
    @property
    def across(self) -> Point | None: ...


@runtime_checkable
class Ways(Protocol):
    """How a part is touched, and how a layout is judged."""

    def scale(self) -> Scale:
        """Centre of the part in W and half the diagonal of its box."""
        ...

    @property
    def answers(self) -> frozenset[str]:
        """The requirements that verdicts answer."""
        ...

    def spots(self, rules: CandidateRules, seed: int) -> Spots:
        """Candidate points on the part in W, with their normals."""
        ...

    def touching(self, elements: Sequence[Element]) -> Sequence[Sequence[Contact]]:
        """The contacts that each element has by itself; none where it cannot stand."""
        ...

    def fits(self, points: Points, normals: Points, stem: Stem, out: Point | None = None) -> Mask:
        """Which elements of some contacts in W, with unit normals, have room: they do not cut the part.

        Args:
            out: if given, also while the part leaves along this unit direction.
        """
        ...

    def holes(self) -> tuple[Hole, ...]:
        """The holes and slots that pins could be in."""
        ...

    def wrenches(self, layout: Layout) -> Wrenches | str:
        """The weight and the loads that act on a layout's part; or why the weight is not known."""
        ...

    def contacts(self, layout: Layout) -> Sequence[Contact]:
        """The contacts that a layout's elements have."""
        ...

    def verify(self, layout: Layout) -> Verdict:
        """The verdict on a layout."""
        ...


def ways_of(part: Part, surface_gap: float) -> Ways:
    """Geometry and verification of a part in a file, or of a polygon."""
    from fixture_design.verification.surface import PartSurface  # noqa: PLC0415 - only where no fake is given

    return PartSurface(part, surface_gap)
