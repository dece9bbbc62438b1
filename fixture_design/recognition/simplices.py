"""Which samples are neighbours: simplices whose middle is in the state as well (4-36), Theorem 9.

Two samples that are near in their span vectors may have none between, where an obstacle is. So every simplex is tried:
its barycentre, moved onto the state's contact equations, must be in the state or, with contacts more, in its closure;
or another sample must have span vectors near those of the middle. Where neither is so, the simplex's edges are tried
alone, and a sample that is left has no neighbour.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.least_squares import solved
from fixture_design.assembly.sorting import sort_configurations
from fixture_design.recognition.chart import Chart
from fixture_design.tolerances import SOLVED

#: More freedoms than this are not cut into simplices of all samples, but each sample takes its nearest ones.
_MOST_TRIANGULATED = 3

#: A sample this near to the middle is between the members, relative to their largest distance [-].
_BETWEEN = 0.25


@dataclass(frozen=True, eq=False)
class Simplices:
    """Neighbours.

    Attributes:
        members: indices of samples.
        middles: configurations of the state, or its closure, between neighbours, shape (n, c).
    """

    members: tuple[tuple[int, ...], ...]
    middles: np.ndarray


@dataclass(frozen=True, eq=False)
class StateEquations:
    """The configurations of a state, as far as they can be solved for.

    Attributes:
        pairs: rows of the contact pairs that touch.
    """

    geometry: ContactGeometry
    pairs: np.ndarray

    @classmethod
    def of(cls, geometry: ContactGeometry, contacts: tuple[str, ...]) -> StateEquations:
        return cls(geometry, np.array(sorted(geometry.names.index(name) for name in contacts), dtype=int))

    def onto(self, starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Starts moved into the state or its closure, shape (m, c), and which of them arrived, shape (n,)."""
        geometry = self.geometry
        q, left = starts, np.zeros(len(starts))
        if len(self.pairs) and len(starts):
            q, left = solved(geometry, starts, np.repeat(self.pairs[None], len(starts), axis=0))
        found = sort_configurations(geometry, q)
        holding = found.touching[:, self.pairs].all(axis=1)
        arrived = (left <= SOLVED * geometry.size) & found.clear & holding
        return q[arrived], arrived


def simplices_of(chart: Chart, chosen: list[int], q: np.ndarray, equations: StateEquations) -> Simplices:
    """Simplices of the chosen samples, as indices among them, each with its middle in the state.

    Args:
        chart: of all samples there are.  chosen: rows of those that simplices are made of.
        q: the chosen samples, shape (n, c); those of the state's closure (with more contacts) may be among them.
    """
    part = chart.taking(chosen)
    tried = _candidates(part)
    middles, arrived = _middles(tried, q, equations)
    arrived |= _met(tried, part.points, chart.points)
    found = [members for members, ok in zip(tried, arrived, strict=True) if ok]
    refused = [members for members, ok in zip(tried, arrived, strict=True) if not ok]
    covered = {pair for members in found for pair in combinations(members, 2)}
    edges = sorted({pair for members in refused if len(members) > 2 for pair in combinations(members, 2)} - covered)
    more, fitting = _middles(edges, q, equations)
    fitting |= _met(edges, part.points, chart.points)
    found += [pair for pair, ok in zip(edges, fitting, strict=True) if ok]
    alone = set(range(len(q))) - {index for members in found for index in members}
    return Simplices(tuple(found) + tuple((index,) for index in sorted(alone)), np.concatenate([middles, more]))


def _candidates(chart: Chart) -> list[tuple[int, ...]]:
    """Simplices by the chart alone, members in order."""
    from scipy.spatial import Delaunay, QhullError  # only where a classifier is built

    count, r = len(chart.points), chart.freedoms
    if r == 0 or count < 2:
        return []
    if r == 1:
        return _gabriel_pairs(chart.points)
    if count <= r + 1:
        return [tuple(range(count))]
    if r > _MOST_TRIANGULATED:
        return _nearest(chart.points, r)
    try:
        return [tuple(sorted(simplex)) for simplex in Delaunay(chart.points[:, :r]).simplices.tolist()]
    except QhullError:  # all in one line or plane: fewer freedoms than the contact equations leave
        return _nearest(chart.points, r)


def _gabriel_pairs(points: np.ndarray) -> list[tuple[int, ...]]:
    """Pairs with no third sample in the ball between them: along a curve, one and the next."""
    squares = ((points[:, None] - points[None]) ** 2).sum(axis=-1)
    between = squares[:, None, :] + squares[None, :, :] < squares[..., None]
    free = ~between.any(axis=-1)
    return [(i, j) for i, j in np.argwhere(np.triu(free, 1)).tolist()]


def _nearest(points: np.ndarray, r: int) -> list[tuple[int, ...]]:
    squares = ((points[:, None] - points[None]) ** 2).sum(axis=-1)
    return sorted({tuple(sorted(row)) for row in np.argsort(squares, axis=1, kind="stable")[:, : r + 1].tolist()})


def _middles(tried: list[tuple[int, ...]], q: np.ndarray, equations: StateEquations) -> tuple[np.ndarray, np.ndarray]:
    """Barycentres in the state, and which of the simplices have one."""
    if not tried:
        return q[:0], np.zeros(0, dtype=bool)
    geometry = equations.geometry
    starts = []
    for members in tried:
        first = np.repeat(q[members[0]][None], len(members), axis=0)
        starts.append(geometry.moved(first[:1], geometry.between(first, q[list(members)]).mean(axis=0)[None]))
    return equations.onto(np.concatenate(starts))


def _met(tried: list[tuple[int, ...]], points: np.ndarray, everywhere: np.ndarray) -> np.ndarray:
    """Which simplices have a sample near their middle that is none of their members."""
    found = np.zeros(len(tried), dtype=bool)
    for index, members in enumerate(tried):
        corners = points[list(members)]
        middle = corners.mean(axis=0)
        near = _BETWEEN * max(float(np.linalg.norm(a - b)) for a, b in combinations(corners, 2))
        found[index] = (np.linalg.norm(everywhere - middle, axis=1) <= near).any()
    return found
