"""One place where an element's tip touches the part: what a contact is before it has a name and a world."""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.arrays import Point, Rows
from fixture_design.contacts import Provenance


@dataclass(frozen=True, eq=False)
class TipTouch:
    """A point of the surface with the logic of the tip there, in the part's frame P; fields as in `Contact`."""

    point: Point
    clauses: tuple[tuple[Point, ...], ...]
    provenance: Provenance
    feature: str
    torsion: float = 0.0
    clearance: float = 0.0
    slips: tuple[Rows, ...] = ()
