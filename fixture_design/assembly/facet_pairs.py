"""Pairs of an apex and a facet (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.assembly.rims import Rims
from fixture_design.assembly.triples import dot, rate, turned, turned_back

Space = Float[np.ndarray, "_ 3"]


@dataclass(frozen=True, eq=False)
class FacetPairs:
    """All apex - facet pairs of one kind: the apices move, or the facets do; in the order of the moving features.

    Attributes:
        apices: shape (a, 3), in their own frame.  normals, offsets: of the facets, in theirs, shapes (f, 3), (f,).
        rims: of the facets.
        apex, facet: of each pair, shape (p,).
    """

    apex_moves: bool
    apices: Space
    normals: Space
    offsets: Weights
    rims: Rims
    apex: Indices
    facet: Indices

    @classmethod
    def of(cls, apex_moves: bool, apices: Points, planes: tuple[Points, Weights], rims: Rims) -> FacetPairs:
        """Every apex with every facet."""
        first, second = np.divmod(
            np.arange(len(apices) * len(planes[1])), len(planes[1]) if apex_moves else len(apices)
        )
        rows = (first, second) if apex_moves else (second, first)
        return cls(apex_moves, apices, *planes, rims, *rows)

    def equations(
        self, R: np.ndarray, position: np.ndarray, chosen: Indices, *, ends: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Values (k, n), gap and what is beyond the rim, and gradients (k, 6, n); k is 1 without ``ends``.

        Args:
            R: shape (3, 3, n).  position: shape (3, n) [m].  chosen: one pair each, shape (n,).
        """
        facet, apices = self.facet[chosen], self.apices.T[:, self.apex[chosen]]
        arms = turned(R, apices) if self.apex_moves else apices - position
        points = arms + position if self.apex_moves else turned_back(R, arms)
        normals = self.normals.T[:, facet]
        values, directions = [dot(normals, points) - self.offsets[facet]], [normals]
        if ends:
            over, across = self.rims.over(np.ascontiguousarray(points.T)[:, None], facet[:, None])
            values.append(over[:, 0])
            directions.append(np.where(values[1] > 0, across[:, 0].T, 0.0))
        rows = [rate(d, arms) if self.apex_moves else -rate(turned(R, d), arms) for d in directions]
        return np.stack(values), np.stack(rows)

    def distances(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """H of every pair, shape (n, p) [m]."""
        gaps = self._places(R, position) @ self.normals.T - self.offsets
        return np.hypot(self._in_order(gaps), np.maximum(self.beyond(R, position), 0.0))

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far each apex is beyond the rim, negative within it, shape (n, p) [m]."""
        return self._in_order(self.rims.beyond(self._places(R, position)))

    def levers(self, position: np.ndarray) -> np.ndarray:
        """Distances of the apices from the moving body's origin, shape (n, p) [m]."""
        if self.apex_moves:
            lengths = np.linalg.norm(self.apices, axis=1)[self.apex]
            return np.broadcast_to(lengths, (len(position), len(lengths)))
        return np.linalg.norm(self.apices[None] - position[:, None], axis=-1)[:, self.apex]

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the apices, fixed axes, shape (n, m, 3) [m]."""
        apices = self.apices[self.apex[chosen]]
        return apices @ np.swapaxes(R, 1, 2) if self.apex_moves else apices - position[:, None]

    def _places(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """All apices in the facets' frame, shape (n, a, 3) [m]."""
        if self.apex_moves:
            return self.apices @ np.swapaxes(R, 1, 2) + position[:, None]
        return (self.apices - position[:, None]) @ R

    def _in_order(self, table: np.ndarray) -> np.ndarray:
        """From (n, apices, facets) to (n, p)."""
        return (table if self.apex_moves else np.swapaxes(table, 1, 2)).reshape(len(table), len(self.apex))
