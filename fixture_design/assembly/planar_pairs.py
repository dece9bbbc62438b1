"""Contact pairs in the plane and their distance functions, (3-3), (3-5), (3-30), (3-31), (3-34), (3-35)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Weights
from fixture_design.assembly.features import PlanarFeatures
from fixture_design.assembly.pair_equations import PairEquations

Plane = Float[np.ndarray, "_ 2"]


@dataclass(frozen=True, eq=False)
class PlanarPairs:
    """Apex - facet pairs (the apex moves), then facet - apex pairs (the facet moves).

    Attributes:
        names: the moving feature first.
        takes_part: whether both features do.
        apex_moves: shape (P,).
        apices: the apices' coordinates, in the frame of the side they belong to, shape (P, 2) [m].
        starts, tangents, normals, lengths: the facets', in their own frame; outward unit normals.
        apex_rows, facet_rows: rows of the sides' `PlanarFeatures`.
    """

    names: tuple[str, ...]
    takes_part: Mask
    apex_moves: Mask
    apices: Plane
    starts: Plane
    tangents: Plane
    normals: Plane
    lengths: Weights
    apex_rows: Indices
    facet_rows: Indices

    @classmethod
    def of(cls, moving: PlanarFeatures, fixed: PlanarFeatures) -> PlanarPairs:
        """All pairs of a convex apex of one side with a facet of the other."""
        parts = [_pairs(moving, fixed, True), _pairs(fixed, moving, False)]
        joined = [np.concatenate([part[k] for part in parts]) for k in range(1, len(parts[0]))]
        return cls(parts[0][0] + parts[1][0], *joined)

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        """Values and gradients of chosen pairs, with k = 2: the gap, and how far the apex is beyond an end.

        With the apex moving, w = R xi_j + x_0 - x_k^1 and the gap is n_k . w (3-3, 3-31); with the facet moving,
        w = x_j - x_0 - R xi_k^1 and the gap is (R n_k) . w (3-5).
        """
        chosen = np.broadcast_to(chosen, (len(q), chosen.shape[1]))
        moves = self.apex_moves[chosen]
        c, s = np.cos(q[:, 2])[:, None], np.sin(q[:, 2])[:, None]
        position = q[:, None, :2]
        still = np.where(moves, 1.0, c), np.where(moves, 0.0, s)  # the facet's own rotation
        apex, start = self.apices[chosen], self.starts[chosen]
        turned = _rotated(np.where(moves[..., None], apex, start), c, s)
        away = np.where(moves[..., None], turned + position - start, apex - position - turned)
        arm = np.where(moves[..., None], turned, apex - position)
        sign = np.where(moves, 1.0, -1.0)
        normal, tangent = _rotated(self.normals[chosen], *still), _rotated(self.tangents[chosen], *still)
        along = _dot(tangent, away)
        beyond = np.where(along < 0, along, np.maximum(along - self.lengths[chosen], 0.0))
        values = np.stack([_dot(normal, away), beyond], axis=-1)
        rows = [_gradient(direction, arm, sign) for direction in (normal, tangent)]
        rows[1] = np.where((beyond != 0)[..., None], rows[1], 0.0)
        return PairEquations(values, np.stack(rows, axis=-2))

    def along(self, q: np.ndarray) -> np.ndarray:
        """Where on its facet's line each pair's apex is, shape (n, P), from 0 to the facet's length [m]."""
        c, s = np.cos(q[:, 2])[:, None], np.sin(q[:, 2])[:, None]
        position = q[:, None, :2]
        arm = self.arms(q)
        tangent = np.where(self.apex_moves[:, None], self.tangents, _rotated(self.tangents[None], c, s))
        start = np.where(self.apex_moves[:, None], self.starts - position, _rotated(self.starts[None], c, s))
        return _dot(tangent, arm - start)

    def arms(self, q: np.ndarray) -> np.ndarray:
        """From the moving body's origin to each pair's apex, fixed axes, shape (n, P, 2) [m]."""
        c, s = np.cos(q[:, 2])[:, None], np.sin(q[:, 2])[:, None]
        turned = _rotated(self.apices[None], c, s)
        return np.where(self.apex_moves[:, None], turned, self.apices - q[:, None, :2])


def _pairs(apices: PlanarFeatures, facets: PlanarFeatures, apex_moves: bool) -> tuple:
    rows = np.array([(a, f) for a in np.flatnonzero(apices.convex) for f in range(len(facets.starts))])
    a, f = rows[:, 0], rows[:, 1]
    lengths = np.linalg.norm(facets.ends - facets.starts, axis=1)
    named = [(apices.apex_names[i], facets.facet_names[j]) for i, j in rows]
    ordered = [pair if apex_moves else pair[::-1] for pair in named]
    return (
        tuple(f"{first or '?'} - {second or '?'}" for first, second in ordered),
        np.array([None not in pair for pair in named]),
        np.full(len(rows), apex_moves),
        apices.starts[a],
        facets.starts[f],
        facets.tangents[f],
        facets.normals[f],
        lengths[f],
        a,
        f,
    )


def _rotated(vectors: np.ndarray, c: np.ndarray, s: np.ndarray) -> np.ndarray:
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return first[..., 0] * second[..., 0] + first[..., 1] * second[..., 1]


def _gradient(direction: np.ndarray, arm: np.ndarray, sign: np.ndarray) -> np.ndarray:
    """[n, arm X n], with the sign of how the part's motion counts."""
    turn = arm[..., 0] * direction[..., 1] - arm[..., 1] * direction[..., 0]
    return sign[..., None] * np.concatenate([direction, turn[..., None]], axis=-1)
