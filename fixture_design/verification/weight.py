"""The part's weight, where forces are asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.errors import looking_at
from fixture_design.layout import Layout
from fixture_design.verification.found import FoundContacts


@dataclass(frozen=True, eq=False)
class Weight:
    """What gravity does to the part: ``force`` [N] at ``center``, in W [m]; ``note``: what was assumed, for people."""

    force: Vector
    center: Point
    note: str | None = None

    @property
    def wrench(self) -> Vector:
        """[f; m] about W's origin [N, N m]."""
        return np.append(self.force, np.atleast_1d(np.cross(self.center, self.force)))


def weight_of(layout: Layout, found: FoundContacts) -> Weight | str:
    """The part's weight in the layout's gravity; in words why it is not known, where gravity acts but it is not.

    Raises:
        InputError: the part's file, which has to be read for it, cannot be used.
    """
    if layout.gravity is None or not np.any(layout.gravity):
        zero = np.zeros(2 if layout.space == "planar" else 3)
        return Weight(zero, zero)
    if layout.part is None:
        return "gravity is given, but no part with a mass"
    from fixture_design.geometry import load_geometry, mass_of  # noqa: PLC0415 - only where gravity acts

    with looking_at(layout.source, layout.places.get(("part",))):
        mass = mass_of(layout.part, found.geometry or load_geometry(layout.part))
    if mass is None:
        return f"gravity is given, but nothing says how heavy {layout.part.name} is (`mass` of the part)"
    center = layout.part.pose.points(mass.center[None])[0]
    return Weight(mass.mass * np.asarray(layout.gravity), center, mass.note)
