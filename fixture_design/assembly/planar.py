"""Two planar parts as a `ContactGeometry`: everything exact, since lines are lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.assembly.assembly import Assembly, Region
from fixture_design.assembly.contact_geometry import refuse_too_many
from fixture_design.assembly.contact_rows import ContactRows
from fixture_design.assembly.features import PlanarFeatures, planar_features
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.planar_overlap import ConvexPiece, overlap, pieces_of
from fixture_design.assembly.planar_pairs import PlanarPairs
from fixture_design.assembly.together import intervals, overlapping
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


@dataclass(frozen=True, eq=False)
class PlanarGeometry:
    """The contact geometry of a planar assembly; attributes as in `ContactGeometry`."""

    moving: PlanarFeatures
    fixed: PlanarFeatures
    pairs: PlanarPairs
    pieces: tuple[tuple[ConvexPiece, ...], tuple[ConvexPiece, ...]]
    region: Region
    size: float
    radius: float
    free: Mask
    dimension: int = 3

    @classmethod
    def of(cls, assembly: Assembly) -> PlanarGeometry:
        """The geometry of an assembly.

        Raises:
            AssemblyError: polygons that are none, names that do not fit, no pair of features that takes part.
            UnsupportedError: too many features.
        """
        moving, fixed = planar_features(assembly)
        refuse_too_many(2 * len(moving.starts) * len(fixed.starts))
        pairs = PlanarPairs.of(moving, fixed)
        if not pairs.takes_part.any():
            raise AssemblyError("no apex of one part can meet a facet of the other: too few features are named")
        reach = float(np.linalg.norm(moving.starts, axis=1).max())
        low, high = fixed.starts.min(axis=0), fixed.starts.max(axis=0)
        region = assembly.region or Region(low - 1.5 * reach, high + 1.5 * reach)
        extents = [reach, float(np.abs(fixed.starts).max()), float(np.abs([region.low, region.high]).max())]
        taking = [row for row, name in enumerate(moving.apex_names) if name is not None]
        radius = float(np.sqrt((moving.starts[taking] ** 2).sum(axis=1).mean())) if taking else reach
        free = np.array([True, True, region.turning != "fixed"])
        pieces = pieces_of(moving), pieces_of(fixed)
        return cls(moving, fixed, pairs, pieces, region, max(extents), radius or reach, free)

    @property
    def turns(self) -> slice:
        return slice(2, 3)

    @property
    def names(self) -> tuple[str, ...]:
        return self.pairs.names

    @property
    def takes_part(self) -> Mask:
        return self.pairs.takes_part

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        return self.pairs.equations(q, chosen)

    def solving(self, q: np.ndarray, chosen: np.ndarray, *, ends: bool = True) -> PairEquations:
        return self.equations(q, chosen)

    @property
    def ending(self) -> Mask:
        return np.zeros(len(self.names), dtype=bool)

    def distances(self, q: np.ndarray) -> np.ndarray:
        return self.equations(q, np.arange(len(self.names))[None]).distances

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        chosen = np.broadcast_to(chosen, (len(q), chosen.shape[1]))
        return np.take_along_axis(self.pairs.arms(q), chosen[..., None], axis=1)

    def rotations(self, q: np.ndarray) -> np.ndarray:
        c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
        return np.moveaxis(np.array([[c, -s], [s, c]]), -1, 0)

    def reach(self, q: np.ndarray) -> np.ndarray:
        return np.linalg.norm(self.pairs.arms(q), axis=-1)

    def at_apices(self, q: np.ndarray, distance: float) -> np.ndarray:
        along = self.pairs.along(q)
        return (np.abs(along) <= distance) | (np.abs(along - self.pairs.lengths) <= distance)

    def coincident(self, q: np.ndarray, distance: float) -> np.ndarray:
        c, s = np.cos(q[:, 2])[:, None], np.sin(q[:, 2])[:, None]
        x, y = self.moving.starts[self.moving.convex].T
        mine = np.stack([c * x - s * y, s * x + c * y], axis=-1) + q[:, None, :2]
        theirs = self.fixed.starts[self.fixed.convex]
        return (
            (np.linalg.norm(mine[:, :, None] - theirs[None, None], axis=-1) <= distance).reshape(len(q), -1).any(axis=1)
        )

    def overlap(self, q: np.ndarray) -> np.ndarray:
        return overlap(*self.pieces, q)

    def moved(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        return q + displacement

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        difference = end - start
        if self.region.turning == "free":
            difference[:, 2] = _wrapped(difference[:, 2])
        return difference

    def aligned(self, q: np.ndarray) -> np.ndarray:
        if self.region.turning == "fixed":
            return q[:0]
        mine, theirs = (np.arctan2(side.tangents[:, 1], side.tangents[:, 0]) for side in (self.moving, self.fixed))
        angles = np.unique(np.round(_wrapped(theirs[None] + np.pi - mine[:, None]), _ANGLE_DIGITS))
        turned = np.repeat(q, len(angles), axis=0)
        turned[:, 2] = np.tile(angles, len(q))
        return turned

    def canonical(self, q: np.ndarray) -> np.ndarray:
        if self.region.turning != "free":
            return q
        return np.column_stack([q[:, :2], _wrapped(q[:, 2])])

    def random(self, rng: np.random.Generator, count: int) -> np.ndarray:
        smallest, largest = self.region.turns or (-np.pi, np.pi)
        low, high = [*self.region.low, smallest], [*self.region.high, largest]
        return rng.uniform(low, high, (count, 3))

    def inside(self, q: np.ndarray) -> Mask:
        rounding = TOUCHING * self.size
        position = q[:, :2]
        low, high = self.region.low - rounding, self.region.high + rounding
        found = np.logical_and(position >= low, position <= high).all(axis=1).reshape(len(q))
        if self.region.turns is None:
            return found
        smallest, largest = self.region.turns
        return found & (q[:, 2] >= smallest - TOUCHING) & (q[:, 2] <= largest + TOUCHING)

    def rows(self, q: np.ndarray, pairs: np.ndarray, vectors: np.ndarray, at_end: np.ndarray) -> ContactRows:
        return ContactRows.single(vectors, at_end)

    def possible_together(self) -> np.ndarray:
        sides = [_feature_intervals(side) for side in (self.moving, self.fixed)]
        counts = [len(side.starts) for side in (self.moving, self.fixed)]
        apex_moves = self.pairs.apex_moves
        # rows of the sides' intervals: apices first, then facets
        mine = np.where(apex_moves, self.pairs.apex_rows, self.pairs.facet_rows + counts[0])
        theirs = np.where(apex_moves, self.pairs.facet_rows + counts[1], self.pairs.apex_rows)
        return overlapping(sides[0][np.ix_(mine, mine)], sides[1][np.ix_(theirs, theirs)], TOUCHING * self.size)


#: Digits to which angles of edges are compared, so that each is tried once.
_ANGLE_DIGITS = 14


def _feature_intervals(side: PlanarFeatures) -> np.ndarray:
    apices = np.stack([side.starts, side.starts], axis=1)
    return intervals(np.vstack([apices, np.stack([side.starts, side.ends], axis=1)]))


def _wrapped(angle: np.ndarray) -> np.ndarray:
    """In (-pi, pi]."""
    return np.pi - np.mod(np.pi - angle, 2 * np.pi)
