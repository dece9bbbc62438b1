"""The part's weight, where forces are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.analysis.acting import wrench_at
from fixture_design.arrays import Point, Vector
from fixture_design.errors import looking_at
from fixture_design.layout import Group, Layout
from fixture_design.verification.found import FoundContacts

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry, Polygon


@dataclass(frozen=True, eq=False)
class Weight:
    """What gravity does to the part: ``force`` [N] at ``center``, in W [m]; ``note``: what was assumed, for people."""

    force: Vector
    center: Point
    note: str | None = None

    @property
    def wrench(self) -> Vector:
        """[f; m] about W's origin [N, N m]."""
        return wrench_at(self.center, self.force)


def weight_of(layout: Layout, geometry: PartGeometry | Polygon | None = None) -> Weight | str:
    """The part's weight in the layout's gravity; in words why it is not known, where gravity acts but it is not.

    Args:
        geometry: the part's, where it is loaded already.

    Raises:
        InputError: the part's file, which has to be read for it, cannot be used.
    """
    if layout.gravity is None or not np.any(layout.gravity):
        zero = np.zeros(2 if layout.space == "planar" else 3)
        return Weight(zero, zero)
    if layout.part is None:
        return "gravity is given, but no part with a mass"
    mass, center, note = layout.part.mass, layout.part.center, None
    if mass is None or center is None:
        from fixture_design.geometry import load_geometry, mass_of  # noqa: PLC0415 - only where the file must tell

        with looking_at(layout.source, layout.places.get(("part",))):
            told = mass_of(layout.part, geometry or load_geometry(layout.part))
        if told is None:
            return f"gravity is given, but nothing says how heavy {layout.part.name} is (`mass` of the part)"
        mass, center, note = told.mass, told.center, told.note
    return Weight(mass * np.asarray(layout.gravity), layout.part.pose.points(np.asarray(center)[None])[0], note)


#: Requirements that ask what gravity does.
_ABOUT_FORCES = ("seated", "holds_loads")


def weight_notes(layout: Layout, groups: Sequence[Group], found: FoundContacts) -> list[str]:
    """What was assumed about the weight, where a requirement asks about forces."""
    asked = any(group.gravity and group.contacts and {*group.require} & {*_ABOUT_FORCES} for group in groups)
    weight = weight_of(layout, found.geometry) if asked else None
    return [weight.note] if isinstance(weight, Weight) and weight.note is not None else []
