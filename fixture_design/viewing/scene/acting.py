"""What acts on the part besides contacts: the layout's loads and the weight, with one scale for all."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.layout import Layout, Load
from fixture_design.viewing.palette import LOAD
from fixture_design.viewing.scene.arrows import central_point, wrench_things
from fixture_design.viewing.scene.drawn_sizes import ASIDE, LONGEST_LOAD
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.shapes import Vector3
from fixture_design.viewing.scene.space import Twist, lifted


def load_things(layout: Layout, center: Vector3, size: float) -> Iterator[Thing | Label]:
    """The loads that are one wrench, each at its point; those of load paths are drawn where a story tells of them."""
    wrenches = {load.name: _wrench(load) for load in layout.loads if load.path is None}
    longest = max((float(np.linalg.norm(wrench.along)) for wrench in wrenches.values()), default=0.0)
    scale = LONGEST_LOAD * size / longest if longest > 0 else 0.0
    for number, load in enumerate(layout.loads):
        if load.name in wrenches:
            at = central_point(wrenches[load.name], center) if load.point is None else lifted(load.point)
            yield from wrench_things(f"loads/{number}", wrenches[load.name], at, scale, size, LOAD)
            yield Label(f"loads/{number}", load.name, tail(wrenches[load.name], at, scale, size), LOAD)


def tail(wrench: Twist, at: Vector3, scale: float, size: float) -> Vector3:
    """A little behind the start of a force's arrow: where its name stands."""
    length = float(np.linalg.norm(wrench.along))
    if length == 0:
        return at + np.array([0.0, 0.0, 4 * ASIDE * size])
    return at - wrench.along * (scale + ASIDE * size / length)


def acting_point(layout: Layout, name: str, wrench: Vector, center: Vector3) -> Vector3:
    """Where a load of this name acts: where the layout says, or else on its central axis, nearest to ``center``."""
    given = next((load for load in layout.loads if load.name == name and load.point is not None), None)
    if given is not None and given.point is not None:
        return lifted(given.point)
    return central_point(Twist.of_motion(wrench), center)


def _wrench(load: Load) -> Twist:
    """About W's origin; planar moments are about z."""
    at = np.zeros(3) if load.point is None else lifted(load.point)
    force = np.zeros(3) if load.force is None else lifted(load.force)
    moment = np.zeros(3)
    if load.moment is not None:
        moment[-len(load.moment) :] = load.moment
    return Twist(force, moment + np.cross(at, force))
