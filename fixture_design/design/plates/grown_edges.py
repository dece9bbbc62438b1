"""Grown edges: the Minkowski sum of the part with a disc has straight sides, the edges moved out by the disc's radius.

A round tip touches an edge in its interior if and only if its centre is on the grown edge. The tip may not be nearer to
the edge's ends than the margin, so grown edges are shortened by it; edges too short for that are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.design.plates.outline import Outline

#: For two grown edges each, the smallest and the largest distance of their points [m].
Distances = tuple[Float[np.ndarray, "n n"], Float[np.ndarray, "n n"]]


@dataclass(frozen=True, eq=False)
class GrownEdges:
    """The grown edges that a tip may touch.

    Attributes:
        edges: which edges of the outline they are, shape (n,), rising.
        starts, tangents, normals: shape (n, 2): where the edge starts, not grown [m]; unit vectors.
        offsets: c = n . start + radius, shape (n,) [m]: a tip at p touches where n . p = c.
        first, last: shape (n,) [m]: the tip touches between these places along the edge, counted from its start.
        radius: of the tip [m].
    """

    edges: Indices
    starts: Points
    tangents: Points
    normals: Points
    offsets: Weights
    first: Weights
    last: Weights
    radius: float

    def centers(self, which: np.ndarray, along: np.ndarray) -> np.ndarray:
        """Centres of tips that touch so far along the edges [m], shape (..., 2)."""
        grown = self.starts + self.radius * self.normals
        return grown[which] + along[..., None] * self.tangents[which]

    def touched(self, which: np.ndarray, along: np.ndarray) -> np.ndarray:
        """The points of the part so far along the edges [m], shape (..., 2)."""
        return self.starts[which] + along[..., None] * self.tangents[which]


def grown_edges(outline: Outline, radius: float, edge_margin: float) -> GrownEdges:
    """The edges of an outline moved out by the radius of a tip, without what is within the margin of their ends [m]."""
    first = np.full(len(outline.vertices), edge_margin + outline.tie)
    last = outline.lengths - edge_margin - outline.tie
    long = np.flatnonzero(first < last)
    offsets = np.einsum("ij,ij->i", outline.normals, outline.vertices) + radius
    return GrownEdges(
        edges=long,
        starts=outline.vertices[long],
        tangents=outline.tangents[long],
        normals=outline.normals[long],
        offsets=offsets[long],
        first=first[long],
        last=last[long],
        radius=radius,
    )


def distances(grown: GrownEdges) -> Distances:
    """The annulus of each two grown edges: how near and how far apart two tips on them can be.

    The largest distance is that of two ends. The smallest one is that of an end from the other edge, or zero where the
    two cross.
    """
    every = np.arange(len(grown.edges))
    ends = np.stack([grown.centers(every, grown.first), grown.centers(every, grown.last)], axis=1)
    away = np.linalg.norm(ends[:, None, :, None] - ends[None, :, None, :], axis=-1)
    farthest = away.max(axis=(2, 3))
    span = grown.last - grown.first
    rest = ends[:, None] - ends[None, :, :1]
    along = np.clip(np.einsum("abkx,bx->abk", rest, grown.tangents), 0, span[None, :, None])
    nearest = np.linalg.norm(rest - along[..., None] * grown.tangents[None, :, None], axis=-1).min(axis=2)
    side = np.einsum("abkx,bx->abk", rest, grown.normals)
    astride = side.min(axis=2) * side.max(axis=2) <= 0
    nearest = np.where(astride & astride.T, 0.0, np.minimum(nearest, nearest.T))
    return nearest, farthest
