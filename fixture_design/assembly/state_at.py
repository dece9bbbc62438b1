"""The contact state of one given configuration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import ArrayLike
from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.sorting import State, state_of
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


@dataclass(frozen=True)
class StateAt:
    """What touches at a configuration.

    Attributes:
        contacts: the pairs within ``within`` of each other [m].
        coincident: whether two apices are in one point.
        overlap: how deep the parts overlap [m]; up to ``within`` they do not.
        admissible: whether they do not, and the configuration is in the region.
    """

    contacts: State
    coincident: bool
    admissible: bool
    overlap: float
    within: float


def state_at(assembly: Assembly, configuration: ArrayLike, within: float | None = None) -> StateAt:
    """The state of a configuration, planar [x, y, theta].

    Args:
        within: distance up to which features touch [m]; None: `TOUCHING` of the assembly's size. A configuration
            written with five digits touches within 1e-5 only.

    Raises:
        AssemblyError: not as many numbers as a configuration has, or numbers that are not finite.
    """
    geometry = geometry_of(assembly)
    q = np.atleast_1d(np.asarray(configuration, dtype=np.float64))
    numbers = 3 if assembly.space == "planar" else 7
    if q.shape != (numbers,) or not np.isfinite(q).all():
        raise AssemblyError(f"a configuration is {numbers} finite numbers", found=f"{q.tolist()}"[:60])
    near = TOUCHING * geometry.size if within is None else within
    distances = geometry.distances(q[None])
    overlap = max(float(geometry.overlap(q[None])[0]), 0.0)
    admissible = bool(geometry.inside(q[None])[0]) and overlap <= near
    coincident = bool(geometry.coincident(q[None], near)[0])
    return StateAt(state_of(geometry, distances[0] <= near), coincident, admissible, overlap, near)
