"""How much of the friction a squeeze takes, before any load: what is left is all that holds.

Fingers that press at faces which lean away from each other balance by friction alone. Real skins give way and real
drives are springs, both of which shift the forces, so that a squeeze that needs most of the friction slips, though the
contacts close: in simulation grasps of a torus fell that took 58 and 79 % of it, and held with a stiffer skin.
"""

from __future__ import annotations

from fixture_design.grasp.result import Grasp
from fixture_design.tolerances import FRICTION_LEFT

#: Steps of the bisection; each halves what is not known.
_STEPS = 6


def is_tight(grasp: Grasp) -> bool:
    """Whether a squeeze takes more of the friction than `FRICTION_LEFT` leaves; not where there is no squeeze."""
    return not _squeezes(grasp, 1 - FRICTION_LEFT) and _squeezes(grasp, 1.0)


def friction_used(grasp: Grasp) -> float:
    """The least share of the friction with which the drives can squeeze, from above; 1 where they cannot [-]."""
    low, high = 0.0, 1.0
    for _ in range(_STEPS):
        middle = (low + high) / 2
        low, high = (low, middle) if _squeezes(grasp, middle) else (middle, high)
    return high


def _squeezes(grasp: Grasp, share: float) -> bool:
    """Whether the fingers squeeze with a share of their friction."""
    return grasp.drives(share).squeeze(1.0) is not None
