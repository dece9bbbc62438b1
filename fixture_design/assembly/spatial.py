"""Polyhedral bodies in space as a `ContactGeometry`."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.assembly import rotations
from fixture_design.assembly.assembly import Assembly, Region
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.polyhedron import Polyhedron, polyhedron_of
from fixture_design.assembly.separation import SeparatingAxes
from fixture_design.assembly.spatial_features import pairs_in_reach
from fixture_design.assembly.spatial_pairs import SpatialPairs
from fixture_design.tolerances import TOUCHING


@dataclass(frozen=True, eq=False)
class SpatialGeometry:
    """The contact geometry of a moving body and some fixed ones; attributes as in `ContactGeometry`.

    Bodies need not be convex: for whether they overlap they are cut into convex pieces. Fixed bodies may overlap.
    Features that the region keeps out of reach form no pairs.
    """

    moving: Polyhedron
    fixed: tuple[Polyhedron, ...]
    pairs: SpatialPairs
    together: np.ndarray
    axes: tuple[SeparatingAxes, ...]
    region: Region
    size: float
    radius: float
    free: Mask
    dimension: int = 6

    @classmethod
    def of(cls, assembly: Assembly) -> SpatialGeometry:
        """The geometry of an assembly.

        Raises:
            UnsupportedError: bodies with round surfaces, or too many features.
            AssemblyError: nothing that can touch.
        """
        moving = polyhedron_of(assembly.moving)
        fixed = tuple(polyhedron_of(body) for body in assembly.fixed)
        reach = float(np.linalg.norm(moving.vertices, axis=1).max())
        everything = np.vstack([body.vertices for body in fixed])
        region = assembly.region or Region(everything.min(axis=0) - 1.5 * reach, everything.max(axis=0) + 1.5 * reach)
        pairs, together = pairs_in_reach(moving, fixed, region, reach)
        size = max(reach, float(np.abs([region.low, region.high]).max()))
        radius = float(np.sqrt((moving.vertices**2).sum(axis=1).mean()))
        free = np.array([True] * 3 + [region.turning != "fixed"] * 3)
        axes = tuple(
            SeparatingAxes.of(a, b) for a, b in product(moving.pieces, (p for body in fixed for p in body.pieces))
        )
        return cls(moving, fixed, pairs, together, axes, region, size, radius, free)

    @property
    def turns(self) -> slice:
        return slice(3, 6)

    @property
    def names(self) -> tuple[str, ...]:
        return self.pairs.names

    @property
    def takes_part(self) -> Mask:
        return np.ones(len(self.pairs.names), dtype=bool)

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        return self.pairs.equations(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

    def distances(self, q: np.ndarray) -> np.ndarray:
        return self.pairs.distances(rotations.matrices(q[:, 3:]), q[:, :3])

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        return self.pairs.arms(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

    def rotations(self, q: np.ndarray) -> np.ndarray:
        return rotations.matrices(q[:, 3:])

    def reach(self, q: np.ndarray) -> np.ndarray:
        return self.pairs.levers(q[:, :3])

    def at_apices(self, q: np.ndarray, distance: float) -> np.ndarray:
        return self.pairs.beyond(rotations.matrices(q[:, 3:]), q[:, :3]) >= -distance

    def coincident(self, q: np.ndarray, distance: float) -> np.ndarray:
        mine = np.einsum("nij,vj->nvi", rotations.matrices(q[:, 3:]), self.moving.vertices) + q[:, None, :3]
        theirs = np.vstack([body.vertices for body in self.fixed])
        near = np.linalg.norm(mine[:, :, None] - theirs[None, None], axis=-1) <= distance
        return near.reshape(len(q), -1).any(axis=1)

    def overlap(self, q: np.ndarray) -> np.ndarray:
        R = rotations.matrices(q[:, 3:])
        return np.max([axes.overlap(R, q[:, :3]) for axes in self.axes], axis=0)

    def moved(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        turned = rotations.product(rotations.from_vectors(displacement[:, 3:]), q[:, 3:])
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        return np.concatenate([q[:, :3] + displacement[:, :3], turned], axis=1)

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        turn = rotations.vectors(rotations.product(end[:, 3:], rotations.inverse(start[:, 3:])))
        return np.concatenate([end[:, :3] - start[:, :3], turn], axis=1)

    def aligned(self, q: np.ndarray) -> np.ndarray:
        """None: coincident apices in space are not tried with facets along each other."""
        return q[:0]

    def canonical(self, q: np.ndarray) -> np.ndarray:
        return np.concatenate([q[:, :3], np.where(q[:, 3:4] < 0, -q[:, 3:], q[:, 3:])], axis=1)

    def random(self, rng: np.random.Generator, count: int) -> np.ndarray:
        position = rng.uniform(self.region.low, self.region.high, (count, 3))
        turned = rng.normal(size=(count, 4))
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        if self.region.turns is not None:
            axes = turned[:, 1:] / np.linalg.norm(turned[:, 1:], axis=1, keepdims=True)
            turned = rotations.from_vectors(axes * rng.uniform(*self.region.turns, (count, 1)))
        return np.concatenate([position, turned], axis=1)

    def inside(self, q: np.ndarray) -> Mask:
        low, high = self.region.low - TOUCHING * self.size, self.region.high + TOUCHING * self.size
        found = np.logical_and(q[:, :3] >= low, q[:, :3] <= high).all(axis=1).reshape(len(q))
        if self.region.turns is None:
            return found
        return found & (np.linalg.norm(rotations.vectors(q[:, 3:]), axis=1) <= self.region.turns[1] + TOUCHING)

    def possible_together(self) -> np.ndarray:
        return self.together
