"""Turned bodies among drilled blocks as a `ContactGeometry`: few features, and the same at any resolution of a mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.assembly import rotations
from fixture_design.assembly.assembly import Assembly, Region
from fixture_design.assembly.circles import ALONG, crossed, lengths_of
from fixture_design.assembly.contact_rows import ContactRows
from fixture_design.assembly.drilled_block import DrilledBlock
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.placement import Placement
from fixture_design.assembly.round_doubts import doubted
from fixture_design.assembly.round_features import RoundPair, pairs_of
from fixture_design.assembly.round_overlap import overlap_with
from fixture_design.assembly.round_planes import Flat
from fixture_design.assembly.spatial_motions import SpatialMotions
from fixture_design.assembly.touch import Touch
from fixture_design.assembly.turned_body import TurnedBody
from fixture_design.tolerances import TOUCHING

#: Points of a disk's rim that stand for all of it, where it lies on a plane: forces and motions there are approximate.
RIM_POINTS = 12

#: What a pair counts as beyond an end where it has no place, relative to the size [-]: nothing solves that, and steps
#: towards a place are hardly damped.
_NOWHERE = 1e-2

#: A touch this near to the end of a feature, relative to the size, may be in one point with another pair's [-].
_JOINED = 1e-5


@dataclass(frozen=True, eq=False)
class RoundGeometry(SpatialMotions):
    """The contact geometry of a turned body and drilled blocks; attributes as in `ContactGeometry`."""

    moving: TurnedBody
    fixed: tuple[DrilledBlock, ...]
    pairs: tuple[RoundPair, ...]
    region: Region
    size: float
    radius: float
    free: Mask
    dimension: int = 6

    @classmethod
    def of(cls, assembly: Assembly, moving: TurnedBody, fixed: tuple[DrilledBlock, ...]) -> RoundGeometry:
        """The geometry of bodies that were recognised.

        Raises:
            UnsupportedError: the region lets the body reach straight edges, or holes that it does not go into.
            AssemblyError: nothing that can touch.
        """
        reach = float(moving.reaches.max())
        everything = np.vstack([block.hull.vertices for block in fixed])
        region = assembly.region or Region(everything.min(axis=0) - 1.5 * reach, everything.max(axis=0) + 1.5 * reach)
        pairs = tuple(pairs_of(moving, fixed, region, reach))
        size = max(reach, float(np.abs([region.low, region.high]).max()))
        free = np.array([True] * 3 + [region.turning != "fixed"] * 3)
        return cls(moving, fixed, pairs, region, size, moving.spread, free)

    @property
    def names(self) -> tuple[str, ...]:
        return self._names

    @cached_property
    def _names(self) -> tuple[str, ...]:
        return tuple(name for pair in self.pairs for name in pair.names)

    @property
    def takes_part(self) -> Mask:
        return np.ones(len(self.names), dtype=bool)

    def possible_together(self) -> np.ndarray:
        return np.ones((len(self.names), len(self.names)), dtype=bool)

    def place(self, q: np.ndarray) -> Placement:
        """The moving body at configurations."""
        return Placement(self.moving, rotations.matrices(q[:, 3:]), q[:, :3])

    def _touches(self, place: Placement) -> list[Touch]:
        """Of every pair, twice where it has two names."""
        return [touch for pair in self.pairs for touch in pair.touch(place)]

    @cached_property
    def _flats(self) -> list[RoundPair | None]:
        """For each name the pair if it is that of a disk on a plane."""
        return [pair if pair.flat is not None else None for pair in self.pairs for _ in pair.names]

    def flat(self, number: int) -> Flat | None:
        """What a pair has if it is a disk on a plane."""
        pair = self._flats[number]
        return None if pair is None else pair.flat

    def distances(self, q: np.ndarray) -> np.ndarray:
        place = self.place(q)
        touches, columns = self._touches(place), []
        for touch, pair in zip(touches, self._flats, strict=True):
            parts = [touch.gap, np.maximum(touch.beyond, 0.0)]
            if pair is not None and pair.flat is not None:
                tilts, _ = pair.flat.tilts(place)
                parts += [self._arm(pair) * tilts[:, 0], self._arm(pair) * tilts[:, 1]]
            columns.append(np.where(touch.exists, np.linalg.norm(parts, axis=0), self.size))
        return doubted(self.pairs, place, touches, np.column_stack(columns), self.size)

    def _arm(self, pair: RoundPair) -> float:
        """What makes lengths of tilts: the disk's radius."""
        assert pair.flat is not None
        return float(self.moving.radii[pair.flat.circle])

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        """Four numbers a pair: gap, how far beyond an end, and two tilts of disks on planes."""
        return self._equations(q, chosen, joined=False)

    def solving(self, q: np.ndarray, chosen: np.ndarray, *, ends: bool = True) -> PairEquations:
        """As `equations`; ``chosen`` may be P more than a pair's number: then the pair is to touch at its end.

        Where a circle passes from a plane or a wall over a rim, its two pairs touch in one point with one normal, and
        both gaps alone tell the place badly: there the second one's is replaced by how far the first is beyond its end.
        """
        return self._equations(q, chosen, joined=True)

    def _equations(self, q: np.ndarray, chosen: np.ndarray, joined: bool) -> PairEquations:
        chosen = np.broadcast_to(chosen, (len(q), chosen.shape[1]))
        place, count = replace(self.place(q), slides=True), len(self.names)
        values = np.zeros((*chosen.shape, 4))
        gradients = np.zeros((*chosen.shape, 4, 6))
        ends: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        for pair, number in zip(self.pairs, self._firsts, strict=True):
            rows = np.flatnonzero(
                ((chosen % count >= number) & (chosen % count < number + len(pair.names))).any(axis=1)
            )
            if not rows.size:
                continue
            some = place.of(rows)
            for k, touch in enumerate(pair.touch(some)):
                one, slopes = self._one(pair, touch, some)
                slide = _rates(touch, some)
                at, column = np.nonzero(chosen[rows] % count == number + k)
                values[rows[at], column], gradients[rows[at], column] = one[at], slopes[at]
                last = chosen[rows[at], column] >= count
                values[rows[at][last], column[last], 2] = touch.beyond[at[last]]
                gradients[rows[at][last], column[last], 2] = slide[at[last]]
                if k == 0 and joined:
                    near = touch.exists & (np.hypot(touch.gap, touch.beyond) <= _JOINED * self.size)
                    ends[pair.names[0]] = rows[near], touch.beyond[near], slide[near]
        if joined:
            self._join(chosen, ends, values, gradients)
        return PairEquations(values, gradients, firm=(0, 2, 3))

    def _join(self, chosen: np.ndarray, ends: dict, values: np.ndarray, gradients: np.ndarray) -> None:
        for pair, number in zip(self.pairs, self._firsts, strict=True):
            replaced = np.zeros(chosen.shape, dtype=bool)
            for name in pair.joins:
                if name in ends:
                    rows, beyond, slide = ends[name]
                    at, column = np.nonzero((chosen[rows] == number) | (chosen[rows] == number + 1))
                    here = rows[at], column
                    # two ends at once are two equations
                    row = np.where(replaced[here], 2, 0)
                    fresh = rows[at][row == 0], column[row == 0]
                    values[fresh], gradients[fresh] = 0.0, 0.0
                    values[*here, row], gradients[*here, row] = beyond[at], slide[at]
                    replaced[here] = True

    @property
    def ending(self) -> Mask:
        return np.array([pair.flat is None and not pair.joins for pair in self.pairs for _ in pair.names])

    @cached_property
    def _firsts(self) -> list[int]:
        """The number of each pair's first name."""
        return [int(n) for n in np.cumsum([0, *(len(pair.names) for pair in self.pairs)])[:-1]]

    def _one(self, pair: RoundPair, touch: Touch, place: Placement) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, 4) and gradients (n, 4, 6) of one pair."""
        values, gradients = np.zeros((len(touch.gap), 4)), np.zeros((len(touch.gap), 4, 6))
        arm = touch.point - place.position
        outside = touch.exists & (touch.beyond > 0)
        values[:, 0] = touch.gap
        values[:, 1] = np.where(outside, touch.beyond, np.where(touch.exists, 0.0, _NOWHERE * self.size))
        gradients[:, 0] = np.concatenate([touch.normal, crossed(arm, touch.normal)], axis=1)
        gradients[outside, 1] = _rates(touch, place)[outside]
        if pair.flat is not None:
            tilts, basis = pair.flat.tilts(place)
            length = self._arm(pair)
            for k in range(2):
                values[:, 2 + k] = length * tilts[:, k]
                gradients[:, 2 + k, 3:] = length * crossed(place.axis, basis[k])
        return values, gradients

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        place = self.place(q)
        points = np.stack([touch.point for touch in self._touches(place)], axis=1)
        rows = np.broadcast_to(chosen, (len(q), chosen.shape[1]))
        return np.take_along_axis(points, rows[..., None], axis=1) - place.position[:, None]

    def reach(self, q: np.ndarray) -> np.ndarray:
        columns = []
        for pair in self.pairs:
            away = 0.0 if pair.fixed_point is None else np.linalg.norm(q[:, :3] - pair.fixed_point, axis=1)
            columns += [np.broadcast_to(pair.lever + away, (len(q),))] * len(pair.names)
        return np.column_stack(columns)

    def at_apices(self, q: np.ndarray, distance: float) -> np.ndarray:
        found = [touch.beyond >= -distance for touch in self._touches(self.place(q))]
        return np.column_stack(found)

    def rows(self, q: np.ndarray, pairs: np.ndarray, vectors: np.ndarray, at_end: np.ndarray) -> ContactRows:
        """A disk on a plane has the rows of `RIM_POINTS` points of its rim, as far as they are on the facet."""
        flats = [self.flat(k) for k in pairs.tolist()]
        if not any(flats):
            return ContactRows.single(vectors, at_end)
        place, scale = self.place(q[None]), np.array([1.0] * 3 + [self.radius] * 3)
        rows, ends, owned = [], [], {}
        for k, flat in zip(pairs.tolist(), flats, strict=True):
            if flat is not None:
                arms = flat.rim_points(place, RIM_POINTS) - place.position
                normals = np.broadcast_to(flat.plane.normal, arms.shape)
                owned[k] = owned[self.names.index(flat.below)] = len(rows) + np.arange(len(arms))
                rows += list(-np.concatenate([normals, np.cross(arms, normals)], axis=1) / scale)
                ends += [False] * len(arms)
        for number, k in enumerate(pairs.tolist()):
            if k not in owned:
                owned[k] = np.array([len(rows)])
                rows.append(vectors[number])
                ends.append(bool(at_end[number]))
        whole = tuple(flat is not None for flat in flats)
        return ContactRows(np.array(rows), np.array(ends), tuple(owned[k] for k in pairs.tolist()), whole)

    def aligned(self, q: np.ndarray) -> np.ndarray:
        """Turned by the least angles that put the moving body's axis along that of a hole, where the region allows.

        A circle in the plane of a rim is the border between leaning towards where they touch, and away from it. One
        configuration of each is enough: the others are the same turned about these axes.
        """
        found = [q[:0]]
        if self.region.turning == "fixed" or not len(q):
            return q[:0]
        q = q[:1]
        place = self.place(q)
        for hole in (hole for block in self.fixed for hole in block.holes):
            for axis in (hole.axis, -hole.axis):
                turn = crossed(place.axis, np.broadcast_to(axis, place.axis.shape))
                sine, cosine = lengths_of(turn), place.axis @ axis
                angle = np.arctan2(sine, cosine) / np.where(sine < ALONG, 1.0, sine)
                turned = self.moved(q, np.concatenate([0 * turn, angle[:, None] * turn], axis=1))
                found.append(turned[self.inside(turned)])
        return np.concatenate(found)

    def coincident(self, q: np.ndarray, distance: float) -> np.ndarray:
        """Where two pairs touch in one point: a circle on a rim."""
        touches = self._touches(self.place(q))
        points = np.stack([touch.point for touch in touches], axis=1)
        near = self.distances(q) <= distance
        together = np.linalg.norm(points[:, :, None] - points[:, None], axis=-1) <= distance
        together &= near[:, :, None] & near[:, None] & ~np.eye(near.shape[1], dtype=bool)
        return together.any(axis=(1, 2))

    def overlap(self, q: np.ndarray) -> np.ndarray:
        if not len(q):
            return np.zeros(0)
        place = self.place(q)
        return np.max([overlap_with(place, block, TOUCHING * self.size) for block in self.fixed], axis=0)


def _rates(touch: Touch, place: Placement) -> np.ndarray:
    """How ``beyond`` changes with displacements, shape (n, 6)."""
    force, moment = touch.slide[:, :3], touch.slide[:, 3:]
    return np.concatenate([force, moment + crossed(touch.point - place.position, force)], axis=1)
