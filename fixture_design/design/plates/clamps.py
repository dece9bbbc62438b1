"""Clamps: where a plunger along a row or a column of holes meets a grown edge.

A tip whose centre is on a grown edge and on a line of holes touches the edge there. The plunger comes from the side
that the edge's normal points to, from the nearest hole that it can have: a hole further out on the same line would make
the same contact with a longer plunger.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices, Weights
from fixture_design.design.plates.grown_edges import GrownEdges
from fixture_design.design.plates.plate import Plate
from fixture_design.design.plates.poses import Poses, in_world
from fixture_design.tolerances import PLATE_TIE


@dataclass(frozen=True, eq=False)
class Clamps:
    """Clamps for some poses.

    Attributes:
        pose: which one each belongs to, shape (k,).  edges: which grown edge it touches.
        holes: in pitches from the first locator's, shape (k, 2).
        directions: the way the plunger pushes, along the grid, shape (k, 2).
        along: how far along the edge it touches [m].
    """

    pose: Indices
    edges: Indices
    holes: Int[np.ndarray, "k 2"]
    directions: Int[np.ndarray, "k 2"]
    along: Weights

    def kept(self, which: np.ndarray) -> Clamps:
        """Those that a mask selects."""
        return Clamps(*(c[which] for c in (self.pose, self.edges, self.holes, self.directions, self.along)))


def clamp_candidates(poses: Poses, grown: GrownEdges, plate: Plate, tie: float) -> Clamps:
    """All clamps that reach an edge from a hole which fits on the plate together with the locators' holes.

    Args:
        grown: by the radius of the clamp's tip.
    """
    edges_W = _EdgesInWorld.of(poses, grown)
    parts = [_along(axis, edges_W, poses.holes, plate, tie) for axis in (0, 1)]
    clamps = Clamps(*(np.concatenate(pair) for pair in zip(*parts, strict=True)))
    holes = np.concatenate([poses.holes[clamps.pose], clamps.holes[:, None]], axis=1)
    fits = plate.holds(holes.max(axis=1) - holes.min(axis=1))
    first, last = grown.first[clamps.edges], grown.last[clamps.edges]
    return clamps.kept(fits & (first < clamps.along) & (clamps.along < last))


@dataclass(frozen=True, eq=False)
class _EdgesInWorld:
    """The grown edges in every pose, from the first locator's hole.

    Attributes:
        starts, ends: of where the tip's centre may be, shape (k, n, 2) [m].
        tangents, normals: unit vectors, shape (k, n, 2).
        first: how far along their edges the starts are, shape (n,) [m].
    """

    starts: np.ndarray
    ends: np.ndarray
    tangents: np.ndarray
    normals: np.ndarray
    first: Weights

    @classmethod
    def of(cls, poses: Poses, grown: GrownEdges) -> _EdgesInWorld:
        every, turns = np.arange(len(grown.edges)), poses.turns[:, None]
        starts, ends = (grown.centers(every, along) + poses.shifts[:, None] for along in (grown.first, grown.last))
        return cls(
            starts=in_world(starts, turns),
            ends=in_world(ends, turns),
            tangents=in_world(grown.tangents[None], turns),
            normals=in_world(grown.normals[None], turns),
            first=grown.first,
        )


def _along(
    axis: int, edges_W: _EdgesInWorld, holes: Int[np.ndarray, "k 3 2"], plate: Plate, tie: float
) -> tuple[np.ndarray, ...]:
    """Clamps whose plunger moves along one axis of the grid, with tips on the lines of the edges."""
    clamp, pitch, other = plate.plunger, plate.pitch, 1 - axis
    pose, edge, line = _crossings(axis, edges_W, holes, plate)
    start, tangent = edges_W.starts[pose, edge], edges_W.tangents[pose, edge]
    from_start = (line * pitch - start[:, other]) / tangent[:, other]
    out = np.sign(edges_W.normals[pose, edge, axis]).astype(np.int64)
    tip = out * (start[:, axis] + from_start * tangent[:, axis])
    base = np.ceil((tip + clamp.shortest - tie) / pitch)
    reached = base * pitch - tip <= clamp.longest + tie
    base = out * base.astype(np.int64)
    spot = np.column_stack([base, line] if axis == 0 else [line, base])
    way = np.column_stack([-out, 0 * out] if axis == 0 else [0 * out, -out])
    columns = (pose, edge, spot, way, edges_W.first[edge] + from_start)
    return tuple(column[reached] for column in columns)


def _crossings(
    axis: int, edges_W: _EdgesInWorld, holes: Int[np.ndarray, "k 3 2"], plate: Plate
) -> tuple[Indices, Indices, Indices]:
    """Which poses, grown edges and lines of holes along an axis cross, where the plunger is not too aslant for that."""
    other = 1 - axis
    ends = np.stack([edges_W.starts[..., other], edges_W.ends[..., other]]) / plate.pitch
    lowest = np.maximum(np.ceil(ends.min(axis=0)), holes[..., other].max(axis=1)[:, None] - plate.reach)
    highest = np.minimum(np.floor(ends.max(axis=0)), holes[..., other].min(axis=1)[:, None] + plate.reach)
    pushed = np.abs(edges_W.normals[..., axis]) >= plate.plunger.least_push * (1 - PLATE_TIE)
    counts = np.where(pushed, np.maximum(highest - lowest + 1, 0), 0).astype(np.int64)
    pose, edge = np.nonzero(counts)
    counts = counts[pose, edge]
    pose, edge = np.repeat(pose, counts), np.repeat(edge, counts)
    step = np.arange(len(pose)) - np.repeat(np.cumsum(counts) - counts, counts)
    return pose, edge, lowest[pose, edge].astype(np.int64) + step
