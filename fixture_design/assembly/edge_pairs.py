"""Pairs of two edges that cross (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, cross_products
from fixture_design.assembly.triples import cross, dot, rate, turned
from fixture_design.tolerances import APART, SUM_ROUNDING

Space = Float[np.ndarray, "_ 3"]

#: Sine of the angle below which two edges are parallel and have no common normal [-].
PARALLEL = 1e-6

#: `APART` by this is neither apart nor touching [-].
_BETWEEN = 30.0


@dataclass(frozen=True, eq=False)
class EdgePairs:
    """Every edge across every other, in the order of the moving edges.

    Attributes:
        my_edges, their_edges: their ends, shapes (a, 2, 3) and (b, 2, 3), in the moving frame and in W.
        their_outward: shape (b, 3), out of the fixed body at its edges: tells which way the gap counts.
    """

    my_edges: Float[np.ndarray, "_ 2 3"]
    their_edges: Float[np.ndarray, "_ 2 3"]
    their_outward: Space

    @cached_property
    def mine(self) -> np.ndarray:
        """The moving edge of each pair, shape (p, 2, 3)."""
        return np.repeat(self.my_edges, len(self.their_edges), axis=0)

    @cached_property
    def theirs(self) -> np.ndarray:
        """The fixed edge of each pair, shape (p, 2, 3)."""
        return np.tile(self.their_edges, (len(self.my_edges), 1, 1))

    def distances(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """H of every pair, shape (n, p) [m]: as `equations`, by products of all edges with all others."""
        begin, end = (self.my_edges[:, k] @ np.swapaxes(R, 1, 2) + position[:, None] for k in range(2))
        start, along = self.their_edges[:, 0], self.their_edges[:, 1] - self.their_edges[:, 0]
        lengths = np.linalg.norm(self.my_edges[:, 1] - self.my_edges[:, 0], axis=1), np.linalg.norm(along, axis=1)
        t, s = (end - begin) / lengths[0][:, None], along / lengths[1][:, None]
        cosine = t @ s.T
        # of the vector from the fixed edge's start to the moving edge's: along s, along t, along t X s
        along_s = begin @ s.T - _dot(start, s)
        along_t = _dot(begin, t)[..., None] - t @ start.T
        triple = cross_products(begin, t) @ s.T - t @ cross_products(s, start).T
        squared = 1.0 - cosine * cosine
        parallel = squared < PARALLEL**2
        squared = np.where(parallel, 1.0, squared)
        here = (cosine * along_s - along_t) / squared, (along_s - cosine * along_t) / squared
        over = [a - np.clip(a, 0.0, most) for a, most in zip(here, (lengths[0][:, None], lengths[1]), strict=True)]
        found = np.sqrt(triple**2 / squared + over[0] ** 2 + over[1] ** 2)
        # where nearly parallel lines cross is known badly: what this says does not touch may do so
        doubtful = found <= SUM_ROUNDING * (lengths[0][:, None] + lengths[1]) / squared
        unclear = APART / _BETWEEN * float(np.abs(self.their_edges).max())
        found = np.where(doubtful & (found > unclear), unclear, found)
        return np.where(parallel, lengths[0][:, None] + lengths[1], found).reshape(len(R), len(self.mine))

    def equations(
        self, R: np.ndarray, position: np.ndarray, chosen: Indices, *, ends: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Values (k, n): the gap along the common normal, and how far the crossing is beyond either edge's ends; and
        gradients (k, 6, n); k is 1 without ``ends``.

        Parallel edges have no common normal; they count as far apart, since their ends touch facets.

        Args:
            R: shape (3, 3, n).  position: shape (3, n) [m].  chosen: one pair each, shape (n,).
        """
        my, their = np.divmod(chosen, len(self.their_edges))
        (begin, t, my_length), (start, s, their_length) = (
            (x[:, rows], unit[:, rows], length[rows])
            for (x, unit, length), rows in zip(self._lines, (my, their), strict=True)
        )
        arm, t = turned(R, begin), turned(R, t)
        away, common = arm + position - start, cross(t, s)
        sine = np.sqrt(dot(common, common))
        parallel = sine < PARALLEL
        side = np.where(dot(common, self.their_outward.T[:, their]) < 0, -1.0, 1.0)
        normal = common * (side / np.where(parallel, 1.0, sine))
        cosine, squared = dot(t, s), np.where(parallel, 1.0, sine**2)
        along_s, along_t = dot(s, away), dot(t, away)
        along = (cosine * along_s - along_t) / squared, (along_s - cosine * along_t) / squared
        values = [np.where(parallel, my_length + their_length, dot(normal, away))]
        rows = [rate(normal, arm + t * along[0])]
        if ends:
            slopes = (cosine * s - t) / squared, (s - cosine * t) / squared
            for a, length, slope in zip(along, (my_length, their_length), slopes, strict=True):
                over = np.where(parallel, 0.0, a - np.clip(a, 0.0, length))
                values.append(over)
                rows.append(np.where(over != 0, rate(slope, arm), 0.0))
        return np.stack(values), np.stack(rows)

    @cached_property
    def _lines(self) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
        """Of both sides' edges the first ends (3, e), the unit vectors along them (3, e), and the lengths."""
        found = []
        for edges in (self.my_edges, self.their_edges):
            along = edges[:, 1] - edges[:, 0]
            lengths = np.linalg.norm(along, axis=1)
            found.append((edges[:, 0].T, (along / lengths[:, None]).T, lengths))
        return tuple(found)

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far the crossing is beyond an end of either edge, negative within both, shape (n, p) [m]."""
        arms = np.einsum("nij,pej->npei", R, self.mine)
        t = arms[..., 1, :] - arms[..., 0, :]
        s = np.broadcast_to(self.theirs[None, :, 1] - self.theirs[None, :, 0], t.shape)
        away = arms[..., 0, :] + position[:, None] - self.theirs[None, :, 0]
        tt, ss, ts = _dot(t, t), _dot(s, s), _dot(t, s)
        squared = np.maximum(tt * ss - ts**2, PARALLEL**2 * tt * ss)
        shares = (
            (ts * _dot(s, away) - ss * _dot(t, away)) / squared,
            (tt * _dot(s, away) - ts * _dot(t, away)) / squared,
        )
        lengths = np.sqrt(tt), np.sqrt(ss)
        over = [np.maximum(-share, share - 1) * length for share, length in zip(shares, lengths, strict=True)]
        return np.maximum(*over)

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the points of the moving edges next to the fixed ones, (n, m, 3) [m]."""
        ends = np.einsum("nij,nmej->nmei", R, self.mine[chosen])
        t, s = ends[..., 1, :] - ends[..., 0, :], self.theirs[chosen][..., 1, :] - self.theirs[chosen][..., 0, :]
        away = ends[..., 0, :] + position[:, None] - self.theirs[chosen][..., 0, :]
        tt, ss, ts = _dot(t, t), _dot(s, s), _dot(t, s)
        squared = np.maximum(tt * ss - ts**2, PARALLEL**2 * tt * ss)
        share = (ts * _dot(s, away) - ss * _dot(t, away)) / squared
        return ends[..., 0, :] + t * np.clip(share, 0.0, 1.0)[..., None]

    def levers(self, position: np.ndarray) -> np.ndarray:
        longest = np.linalg.norm(self.mine, axis=-1).max(axis=1)
        return np.broadcast_to(longest, (len(position), len(longest)))


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", first, second)
