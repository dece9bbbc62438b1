"""In which direction a grasp holds a force worst, over all directions.

The forces through a point that the drives hold are a convex set with 0 in it. The least of all largest ones is the
distance r of its nearest face. Of the hull of some of these forces, which lies inside, the nearest face is no further:

    distance of the hull's nearest face, with normal u  <=  r  <=  largest u . f of a force f that is held

Until both are the same, f joins the hull (the expanding polytope, as in `analysis.hull`). In the direction u nothing
beyond r is held.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Point
from fixture_design.grasp.torques import Drives

#: Forces beyond this are as much as anybody asks for: more counts as without a bound [N].
_ENDLESS = 1e5

#: Times that the hull grows at most; then what it proves is taken.
_GROWTHS = 100

#: Both sides are the same within this, relative to them and at least [N]: a little more than what the solver leaves.
_SAME = 1e-6

#: A hull that is thinner than this, relative to its longest side, is flat [-].
_FLAT = 1e-7


@dataclass(frozen=True, eq=False)
class Weakest:
    """The direction in which a force through a point is held worst.

    Attributes:
        force: at least this is held in every direction [N]; inf where drives without a limit hold anything, 0 where
            there is a direction without any.
        direction: unit; in this one no more is held.
    """

    force: float
    direction: Point


def weakest(drives: Drives) -> Weakest:
    """The direction in which drives hold a force through their reference worst."""
    held = np.vstack([np.zeros(3), *(drives.farthest(way, _ENDLESS) for way in (*np.eye(3), *-np.eye(3)))])
    worst = Weakest(0.0, np.array([0.0, 0.0, -1.0]))
    for _ in range(_GROWTHS):
        more = []
        for worst in _nearest(held):
            force = drives.farthest(worst.direction, _ENDLESS)
            if force @ worst.direction <= worst.force + _SAME * max(1.0, worst.force):
                return worst if worst.force < (1 - _SAME) * _ENDLESS else Weakest(np.inf, worst.direction)
            more.append(force)
        held = np.vstack([held, *more])
    return worst


def _nearest(held: Float[np.ndarray, "n 3"]) -> list[Weakest]:
    """The nearest face of the hull of some forces, 0 among them; of a flat one both sides."""
    size = float(np.abs(held).max())
    _, widths, axes = np.linalg.svd(held)
    if widths[-1] <= _FLAT * max(size, np.finfo(np.float64).tiny):
        return [Weakest(0.0, axes[-1]), Weakest(0.0, -axes[-1])]
    found = nearest_facet(held / size)
    if found is None:  # too flat to tell after all
        return [Weakest(0.0, axes[-1]), Weakest(0.0, -axes[-1])]
    return [Weakest(max(found.at_least, 0.0) * size, found.motion)]
