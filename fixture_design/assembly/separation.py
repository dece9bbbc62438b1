"""Whether convex polytopes overlap, for many poses at once: the axes that can separate them.

Two convex polytopes are apart if and only if they are along a facet's normal or along the cross product of two edges
(Gottschalk's separating axes). The largest separation over these is, where negative, minus the shortest way out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Points, cross_products
from fixture_design.assembly.edge_pairs import PARALLEL
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.triples import components_first, cross, dot, turned, turned_back
from fixture_design.tolerances import SUM_ROUNDING

#: Poses that are looked at together: the arrays are large.
_TOGETHER = 256


@dataclass(frozen=True, eq=False)
class SeparatingAxes:
    """A moving polytope, fixed ones whose features have the same directions, and these, parallel ones once.

    Attributes:
        mine: vertices, shape (v, 3).  theirs: of each fixed one.
    """

    mine: Points
    theirs: tuple[Points, ...]
    my_normals: Points
    their_normals: Points
    my_edges: Points
    their_edges: Points

    @classmethod
    def of(cls, moving: Polytope, fixed: Sequence[Polytope]) -> list[SeparatingAxes]:
        """Of a moving polytope and all fixed ones: boxes along the same axes, as pieces of one body are, together."""
        mine = _lines(moving.normals), _lines(moving.directions)
        groups: list[tuple[Points, Points, list[Points]]] = []
        for body in fixed:
            normals, edges = _lines(body.normals), _lines(body.directions)
            same = [g for g in groups if _same_lines(g[0], normals) and _same_lines(g[1], edges)]
            if same:
                same[0][2].append(body.vertices)
            else:
                groups.append((normals, edges, [body.vertices]))
        return [
            cls(moving.vertices, tuple(theirs), mine[0], normals, mine[1], edges) for normals, edges, theirs in groups
        ]

    def overlap(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How deep the moving one and any fixed one overlap [m], shape (n,); negative: how far they are apart."""
        parts = [self._overlap(R[k : k + _TOGETHER], position[k : k + _TOGETHER]) for k in range(0, len(R), _TOGETHER)]
        return np.concatenate(parts) if parts else np.zeros(0)

    def _overlap(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        R, position = components_first(R), components_first(position)[:, None]
        axes, known = self._axes(R[:, :, None])
        mine = _extent(self.mine, turned_back(R[:, :, None], axes))
        shift = dot(axes, position)
        low, high = mine[0] + shift, mine[1] + shift
        deepest = np.full(R.shape[-1], -np.inf)
        for theirs in self.theirs:
            least, most = _extent(theirs, axes)
            apart = np.where(known, np.maximum(low - most, least - high), -np.inf)
            deepest = np.maximum(deepest, -apart.max(axis=0))
        return deepest

    def _axes(self, R: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The axes for matrices (3, 3, 1, n), shape (3, k, n), and whether they are any, shape (k, n)."""
        count = R.shape[-1]
        crossed = cross(turned(R, self.my_edges.T[..., None])[:, :, None], self.their_edges.T[:, None, :, None])
        crossed = crossed.reshape(3, -1, count)
        lengths = np.sqrt(dot(crossed, crossed))
        crossed = crossed / np.where(lengths > PARALLEL, lengths, 1.0)
        theirs = np.broadcast_to(self.their_normals.T[..., None], (3, len(self.their_normals), count))
        axes = np.concatenate([turned(R, self.my_normals.T[..., None]), theirs, crossed], axis=1)
        known = np.ones(axes.shape[1:], dtype=bool)
        known[len(known) - len(lengths) :] = lengths > PARALLEL
        return axes, known


def _extent(vertices: Points, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far vertices reach along axes (3, k, n): least and most, shape (k, n)."""
    heights = (vertices @ axes.reshape(3, -1)).reshape(len(vertices), *axes.shape[1:])
    return heights.min(axis=0), heights.max(axis=0)


def _lines(directions: Points) -> Points:
    """Directions of which no two are parallel."""
    kept: list[np.ndarray] = []
    for direction in directions:
        if not any(np.linalg.norm(cross_products(direction, other)) < PARALLEL for other in kept):
            kept.append(direction)
    return np.array(kept)


def _same_lines(first: Points, second: Points) -> bool:
    """Whether lines are the same but for rounding, in any order."""
    sines = np.linalg.norm(cross_products(first[:, None], second[None]), axis=-1)
    return len(first) == len(second) and bool(sines.min(axis=1).max() <= SUM_ROUNDING)
