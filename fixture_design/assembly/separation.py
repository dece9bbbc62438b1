"""Whether two convex polytopes overlap, for many poses at once: the axes that can separate them.

Two convex polytopes are apart if and only if they are along a facet's normal or along the cross product of two edges
(Gottschalk's separating axes). The largest separation over these is, where negative, minus the shortest way out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Points
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.spatial_pairs import PARALLEL

#: Poses that are looked at together: the arrays are large.
_TOGETHER = 256


@dataclass(frozen=True, eq=False)
class SeparatingAxes:
    """Two polytopes and the directions that matter, parallel ones once."""

    mine: Points
    theirs: Points
    my_normals: Points
    their_normals: Points
    my_edges: Points
    their_edges: Points

    @classmethod
    def of(cls, moving: Polytope, fixed: Polytope) -> SeparatingAxes:
        normals = _lines(moving.normals), _lines(fixed.normals)
        edges = _lines(moving.directions), _lines(fixed.directions)
        return cls(moving.vertices, fixed.vertices, normals[0], normals[1], edges[0], edges[1])

    def overlap(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How deep they overlap [m], shape (n,); negative: how far they are apart at least."""
        parts = [self._overlap(R[k : k + _TOGETHER], position[k : k + _TOGETHER]) for k in range(0, len(R), _TOGETHER)]
        return np.concatenate(parts) if parts else np.zeros(0)

    def _overlap(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        back = np.swapaxes(R, 1, 2)
        placed = self.mine @ back + position[:, None]
        turned = self.my_edges @ back
        crossed = np.cross(turned[:, :, None], self.their_edges[None, None]).reshape(len(R), -1, 3)
        lengths = np.linalg.norm(crossed, axis=-1)
        axes = np.concatenate(
            [
                self.my_normals @ back,
                np.broadcast_to(self.their_normals, (len(R), *self.their_normals.shape)),
                crossed / np.where(lengths > PARALLEL, lengths, 1.0)[..., None],
            ],
            axis=1,
        )
        mine, theirs = axes @ np.swapaxes(placed, 1, 2), axes @ self.theirs.T
        apart = np.maximum(mine.min(axis=2) - theirs.max(axis=2), theirs.min(axis=2) - mine.max(axis=2))
        known = np.concatenate(
            [np.ones((len(R), axes.shape[1] - lengths.shape[1]), dtype=bool), lengths > PARALLEL], axis=1
        )
        return -np.where(known, apart, -np.inf).max(axis=1)


def _lines(directions: Points) -> Points:
    """Directions of which no two are parallel."""
    kept: list[np.ndarray] = []
    for direction in directions:
        if not any(np.linalg.norm(np.cross(direction, other)) < PARALLEL for other in kept):
            kept.append(direction)
    return np.array(kept)
