"""Polyhedral bodies in space as a `ContactGeometry`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.assembly import rotations
from fixture_design.assembly.assembly import Assembly, Region
from fixture_design.assembly.contact_rows import ContactRows
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.polyhedron import Polyhedron, polyhedron_of
from fixture_design.assembly.separation import SeparatingAxes
from fixture_design.assembly.spatial_features import pairs_in_reach
from fixture_design.assembly.spatial_motions import SpatialMotions
from fixture_design.assembly.spatial_pairs import SpatialPairs


@dataclass(frozen=True, eq=False)
class SpatialGeometry(SpatialMotions):
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
        theirs = [piece for body in fixed for piece in body.pieces]
        axes = tuple(own for piece in moving.pieces for own in SeparatingAxes.of(piece, theirs))
        return cls(moving, fixed, pairs, together, axes, region, size, radius, free)

    @property
    def names(self) -> tuple[str, ...]:
        return self.pairs.names

    @property
    def takes_part(self) -> Mask:
        return np.ones(len(self.pairs.names), dtype=bool)

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        return self.pairs.equations(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

    def solving(self, q: np.ndarray, chosen: np.ndarray, *, ends: bool = True) -> PairEquations:
        return self.pairs.equations(rotations.matrices(q[:, 3:]), q[:, :3], chosen, ends=ends)

    @property
    def ending(self) -> Mask:
        return np.zeros(len(self.names), dtype=bool)

    def distances(self, q: np.ndarray) -> np.ndarray:
        return self.pairs.distances(rotations.matrices(q[:, 3:]), q[:, :3])

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        return self.pairs.arms(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

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

    def rows(self, q: np.ndarray, pairs: np.ndarray, vectors: np.ndarray, at_end: np.ndarray) -> ContactRows:
        return ContactRows.single(vectors, at_end)

    def possible_together(self) -> np.ndarray:
        return self.together
