"""What acts on the part besides contacts: loads, and what clamps push with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Vector, Weights
from fixture_design.contacts import Contact, cross
from fixture_design.layout import Layout, Load, element_name


@dataclass(frozen=True, eq=False)
class LoadRow:
    """A wrench [f; m] about W's origin [N, N m] that acts on the part: a load, or one point of a load path."""

    load: str
    row: int | None
    wrench: Vector


def wrench_at(point: Point, force: Point, moment: Weights | None = None) -> Weights:
    """[f; p X f + m]: a force in a point, and a free moment, about the origin."""
    turning = cross(np.asarray(point)[None], np.asarray(force)[None])[0]
    return np.concatenate([force, turning if moment is None else turning + moment])


def load_wrench(load: Load, plane: int) -> Vector:
    """The wrench of a load that is no path, about W's origin."""
    force = np.zeros(plane) if load.force is None else np.asarray(load.force, dtype=np.float64)
    point = np.zeros(plane) if load.point is None else np.asarray(load.point, dtype=np.float64)
    return wrench_at(point, force, load.moment)


def preloads_of(layout: Layout, contacts: Sequence[Contact]) -> dict[str, float]:
    """What those clamps push with that have a preload and touch the part here [N], in file order."""
    touching = {element_name(contact.name) for contact in contacts if contact.role == "clamp"}
    known = [element for element in layout.elements if element.name in touching and element.role == "clamp"]
    return {element.name: float(element.preload) for element in known if element.preload is not None}
