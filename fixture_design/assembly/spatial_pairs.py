"""Contact pairs of convex polyhedral bodies: apex on facet, facet on apex, edge across edge (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.rims import Rims
from fixture_design.tolerances import APART, SUM_ROUNDING

Space = Float[np.ndarray, "_ 3"]

#: Sine of the angle below which two edges are parallel and have no common normal [-].
PARALLEL = 1e-6

#: `APART` by this is neither apart nor touching [-].
_BETWEEN = 30.0


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

    def equations(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, m, 3), the last one zero, and gradients (n, m, 3, 6)."""
        points, arms, sign = self._seen(R, position, chosen)
        facet = self.facet[chosen]
        normals = np.broadcast_to(self.normals[facet], points.shape)
        gap = np.einsum("nmi,nmi->nm", normals, points) - self.offsets[facet]
        over, across = self.rims.over(points, facet)
        gradients = [_gradient(self._in_world(R, direction), arms, sign) for direction in (normals, across)]
        gradients[1] = np.where((over > 0)[..., None], gradients[1], 0.0)
        values = np.stack([gap, over, np.zeros_like(gap)], axis=-1)
        return values, np.stack([*gradients, np.zeros_like(gradients[0])], axis=-2)

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
        return self._seen(R, position, chosen)[1]

    def _places(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """All apices in the facets' frame, shape (n, a, 3) [m]."""
        if self.apex_moves:
            return self.apices @ np.swapaxes(R, 1, 2) + position[:, None]
        return (self.apices - position[:, None]) @ R

    def _in_order(self, table: np.ndarray) -> np.ndarray:
        """From (n, apices, facets) to (n, p)."""
        return (table if self.apex_moves else np.swapaxes(table, 1, 2)).reshape(len(table), len(self.apex))

    def _seen(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """The apices in the facets' frame, from the moving body's origin in fixed axes, and how a motion counts."""
        apices = self.apices[self.apex[chosen]]
        if self.apex_moves:
            arms = apices @ np.swapaxes(R, 1, 2)
            return arms + position[:, None], arms, 1.0
        arms = apices - position[:, None]
        return arms @ R, arms, -1.0

    def _in_world(self, R: np.ndarray, directions: np.ndarray) -> np.ndarray:
        return directions if self.apex_moves else directions @ np.swapaxes(R, 1, 2)


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

    @cached_property
    def outward(self) -> np.ndarray:
        return np.tile(self.their_outward, (len(self.my_edges), 1))

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
        triple = np.cross(begin, t) @ s.T - t @ np.cross(s, start).T
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

    def equations(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, m, 3): the gap along the common normal, and how far the crossing is beyond either edge's ends.

        Parallel edges have no common normal; they count as far apart, since their ends touch facets.
        """
        arms = np.einsum("nij,nmej->nmei", R, self.mine[chosen])
        fixed = self.theirs[chosen]
        mine, theirs = arms[..., 1, :] - arms[..., 0, :], fixed[..., 1, :] - fixed[..., 0, :]
        lengths = np.linalg.norm(mine, axis=-1), np.linalg.norm(theirs, axis=-1)
        t, s = mine / lengths[0][..., None], theirs / lengths[1][..., None]
        away = arms[..., 0, :] + position[:, None] - fixed[..., 0, :]
        common = np.cross(t, s)
        sine = np.linalg.norm(common, axis=-1)
        parallel = sine < PARALLEL
        side = np.where(_dot(common, self.outward[chosen]) < 0, -1.0, 1.0)
        normal = common * (side / np.where(parallel, 1.0, sine))[..., None]
        cosine, squared = _dot(t, s), np.where(parallel, 1.0, sine**2)
        along = (cosine * _dot(s, away) - _dot(t, away)) / squared, (_dot(s, away) - cosine * _dot(t, away)) / squared
        slopes = (cosine[..., None] * s - t) / squared[..., None], (s - cosine[..., None] * t) / squared[..., None]
        closest = arms[..., 0, :] + t * along[0][..., None]
        over = [a - np.clip(a, 0.0, length) for a, length in zip(along, lengths, strict=True)]
        rows = [_gradient(normal, closest, 1.0), *(_gradient(slope, arms[..., 0, :], 1.0) for slope in slopes)]
        for k in (1, 2):
            rows[k] = np.where((over[k - 1] != 0)[..., None], rows[k], 0.0)
        far = np.where(parallel, lengths[0] + lengths[1], _dot(normal, away))
        values = np.stack([far, *(np.where(parallel, 0.0, o) for o in over)], axis=-1)
        return values, np.stack(rows, axis=-2)

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


@dataclass(frozen=True, eq=False)
class SpatialPairs:
    """All pairs: apices on facets, facets on apices, edges across edges, in this order.

    Attributes:
        names: the moving feature first.
    """

    names: tuple[str, ...]
    groups: tuple[FacetPairs, FacetPairs, EdgePairs]
    sizes: Indices

    def equations(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> PairEquations:
        """Values and gradients of chosen pairs (n, m)."""
        chosen = np.broadcast_to(chosen, (len(R), chosen.shape[1]))
        values = np.zeros((*chosen.shape, 3))
        gradients = np.zeros((*chosen.shape, 3, 6))
        for group, start, size in zip(self.groups, self._starts(), self.sizes.tolist(), strict=True):
            rows, columns = np.nonzero((chosen >= start) & (chosen < start + size))
            if rows.size:
                local = chosen[rows, columns][:, None] - start
                found = group.equations(R[rows], position[rows], local)
                values[rows, columns], gradients[rows, columns] = found[0][:, 0], found[1][:, 0]
        return PairEquations(values, gradients)

    def distances(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """H of every pair, shape (n, P) [m]."""
        return np.concatenate([group.distances(R, position) for group in self._some()], axis=1)

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the contact points of chosen pairs (n, m), fixed axes, (n, m, 3) [m]."""
        chosen = np.broadcast_to(chosen, (len(R), chosen.shape[1]))
        arms = np.zeros((*chosen.shape, 3))
        for group, start, size in zip(self.groups, self._starts(), self.sizes.tolist(), strict=True):
            inside = (chosen >= start) & (chosen < start + size)
            if inside.any():
                found = group.arms(R, position, np.clip(chosen - start, 0, size - 1))
                arms = np.where(inside[..., None], found, arms)
        return arms

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far apices are beyond rims and crossings beyond ends, not positive within, shape (n, P) [m]."""
        return np.concatenate([group.beyond(R, position) for group in self._some()], axis=1)

    def levers(self, position: np.ndarray) -> np.ndarray:
        """How fast turning changes each pair's distance, shape (n, P) [m]."""
        return np.concatenate([group.levers(position) for group in self._some()], axis=1)

    def _some(self) -> list[FacetPairs | EdgePairs]:
        return [group for group, size in zip(self.groups, self.sizes, strict=True) if size]

    def _starts(self) -> list[int]:
        return [0, int(self.sizes[0]), int(self.sizes[:2].sum())]


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", first, second)


def _gradient(direction: np.ndarray, arm: np.ndarray, sign: float) -> np.ndarray:
    """[n, arm X n], with the sign of how the part's motion counts."""
    return sign * np.concatenate([direction, np.cross(arm, direction)], axis=-1)
