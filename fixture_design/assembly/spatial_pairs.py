"""Contact pairs of convex polyhedral bodies: apex on facet, facet on apex, edge across edge (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Weights
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.rims import Rims

Space = Float[np.ndarray, "_ 3"]

#: Sine of the angle below which two edges are parallel and have no common normal [-].
PARALLEL = 1e-6


@dataclass(frozen=True, eq=False)
class FacetPairs:
    """Apex - facet pairs of one kind: the apex moves, or the facet does.

    Attributes:
        apices: shape (p, 3), in the apex's frame.  normals, offsets: of the facets, in their own.
        rims: of the p pairs' facets.
    """

    apex_moves: bool
    apices: Space
    normals: Space
    offsets: Weights
    rims: Rims

    def equations(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, m, 3), the last one zero, and gradients (n, m, 3, 6)."""
        points, arms, sign = self._seen(R, position, chosen)
        normals = np.broadcast_to(self.normals[chosen], points.shape)
        gap = np.einsum("nmi,nmi->nm", normals, points) - self.offsets[chosen]
        over, across = self.rims.over(points, chosen)
        gradients = [_gradient(self._in_world(R, direction), arms, sign) for direction in (normals, across)]
        gradients[1] = np.where((over > 0)[..., None], gradients[1], 0.0)
        values = np.stack([gap, over, np.zeros_like(gap)], axis=-1)
        return values, np.stack([*gradients, np.zeros_like(gradients[0])], axis=-2)

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far each apex is beyond the rim, negative within it, shape (n, p) [m]."""
        return self.rims.beyond(self._seen(R, position, np.arange(len(self.apices))[None])[0])

    def levers(self, position: np.ndarray) -> np.ndarray:
        """Distances of the apices from the moving body's origin, shape (n, p) [m]."""
        if self.apex_moves:
            return np.broadcast_to(np.linalg.norm(self.apices, axis=1), (len(position), len(self.apices)))
        return np.linalg.norm(self.apices[None] - position[:, None], axis=-1)

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the apices, fixed axes, shape (n, m, 3) [m]."""
        return self._seen(R, position, chosen)[1]

    def _seen(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """The apices in the facets' frame, from the moving body's origin in fixed axes, and how a motion counts."""
        if self.apex_moves:
            arms = self.apices[chosen] @ np.swapaxes(R, -1, -2)
            return arms + position[:, None], arms, 1.0
        arms = self.apices[chosen] - position[:, None]
        return np.einsum("nji,nmj->nmi", R, arms), arms, -1.0

    def _in_world(self, R: np.ndarray, directions: np.ndarray) -> np.ndarray:
        return directions if self.apex_moves else np.einsum("nij,nmj->nmi", R, directions)


@dataclass(frozen=True, eq=False)
class EdgePairs:
    """Edge across edge.

    Attributes:
        mine, theirs: the ends of the edges, shape (p, 2, 3), in the moving frame and in W.
        outward: shape (p, 3), out of the fixed body at the fixed edge: tells which way the gap counts.
    """

    mine: Float[np.ndarray, "_ 2 3"]
    theirs: Float[np.ndarray, "_ 2 3"]
    outward: Space

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
            inside = (chosen >= start) & (chosen < start + size)
            if not inside.any():
                continue
            columns = np.flatnonzero(inside.any(axis=0))
            local = np.clip(chosen[:, columns] - start, 0, size - 1)
            found = group.equations(R, position, local)
            here = inside[:, columns]
            values[:, columns] = np.where(here[..., None], found[0], values[:, columns])
            gradients[:, columns] = np.where(here[..., None, None], found[1], gradients[:, columns])
        return PairEquations(values, gradients)

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


def rows_of(pairs: list[tuple[int, int]]) -> tuple[Indices, Indices]:
    """The two columns of a list of pairs, which may be empty."""
    table = np.array(pairs, dtype=int).reshape(-1, 2)
    return table[:, 0], table[:, 1]
