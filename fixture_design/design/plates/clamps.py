"""Clamps: where a plunger along a row or a column of holes meets a grown edge.

A tip whose centre is on a grown edge and on a line of holes touches the edge there. The plunger comes from the side
that the edge's normal points to, from the nearest hole that it can have: a hole further out on the same line would make
the same contact with a longer plunger.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

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
    every = np.arange(len(grown.edges))
    starts = grown.centers(every, grown.first)
    span = grown.last - grown.first
    turns = poses.turns[:, None]
    p_W = in_world(starts[None] + poses.shifts[:, None], turns)
    along_W, out_W = in_world(grown.tangents[None], turns), in_world(grown.normals[None], turns)
    parts = [_on_lines(axis, p_W, along_W, out_W, span, poses.holes, plate, tie) for axis in (0, 1)]
    clamps = Clamps(*(np.concatenate(pair) for pair in zip(*parts, strict=True)))
    holes = np.concatenate([poses.holes[clamps.pose], clamps.holes[:, None]], axis=1)
    fits = plate.holds(holes.max(axis=1) - holes.min(axis=1))
    from_start = grown.first[clamps.edges] + clamps.along
    placed = Clamps(clamps.pose, clamps.edges, clamps.holes, clamps.directions, from_start)
    return placed.kept(fits & (clamps.along > 0) & (clamps.along < span[clamps.edges]))


def _on_lines(
    axis: int,
    p_W: Float[np.ndarray, "k n 2"],
    along_W: Float[np.ndarray, "k n 2"],
    out_W: Float[np.ndarray, "k n 2"],
    span: Weights,
    holes: Int[np.ndarray, "k 3 2"],
    plate: Plate,
    tie: float,
) -> tuple[np.ndarray, ...]:
    """Clamps whose plunger moves along one axis of the grid; ``along`` counts from where the grown edge starts."""
    clamp, pitch, line = plate.plunger, plate.pitch, 1 - axis
    ends = np.stack([p_W[..., line], p_W[..., line] + span * along_W[..., line]]) / pitch
    lowest = np.maximum(np.ceil(ends.min(axis=0)), holes[..., line].max(axis=1)[:, None] - plate.reach)
    highest = np.minimum(np.floor(ends.max(axis=0)), holes[..., line].min(axis=1)[:, None] + plate.reach)
    pushed = np.abs(out_W[..., axis]) >= clamp.least_push - PLATE_TIE
    counts = np.where(pushed, np.maximum(highest - lowest + 1, 0), 0).astype(np.int64)
    pose, edge = np.nonzero(counts)
    counts = counts[pose, edge]
    pose, edge = np.repeat(pose, counts), np.repeat(edge, counts)
    within = np.arange(len(pose)) - np.repeat(np.cumsum(counts) - counts, counts)
    lines = lowest[pose, edge] + within
    along = (lines * pitch - p_W[pose, edge, line]) / along_W[pose, edge, line]
    tip = p_W[pose, edge, axis] + along * along_W[pose, edge, axis]
    out = np.sign(out_W[pose, edge, axis])
    base = np.ceil((out * tip + clamp.shortest - tie) / pitch)
    reached = base * pitch - out * tip <= clamp.longest + tie
    spot = np.stack([out * base, lines] if axis == 0 else [lines, out * base], axis=1)
    way = np.stack([-out, 0 * out] if axis == 0 else [0 * out, -out], axis=1)
    columns = (pose, edge, spot.astype(np.int64), way.astype(np.int64), along)
    return tuple(column[reached] for column in columns)
