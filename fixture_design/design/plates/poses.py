"""Poses of the part in which three holes are on three grown edges.

In the part's frame a hole h is at p = R^T h - s, with X_WP = (R(theta), R s). It is on the grown edge with normal n
where n . p = c:

    cos(theta) n . h + sin(theta) n X h - n . s = c.

Three normals of the plane are dependent, sum l_i n_i = 0 with l_1 = n_2 X n_3 and so on; summed with these weights, s
is gone and A cos(theta) + B sin(theta) = C is left: two poses, or none. The three equations then give s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Weights
from fixture_design.design.plates.grown_edges import GrownEdges
from fixture_design.design.plates.triples import Triples, unique_rows
from fixture_design.tolerances import PARALLEL_EDGES


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses with their three locators; all points are in P.

    Attributes:
        edges: which grown edges the locators touch, shape (k, 3).  holes: in pitches, shape (k, 3, 2).
        turns: [cos theta, sin theta], shape (k, 2).
        shifts: s, shape (k, 2) [m].  centers: of the locators, shape (k, 3, 2) [m].
        along: how far along their edges they touch, shape (k, 3) [m].
    """

    edges: Int[np.ndarray, "k 3"]
    holes: Int[np.ndarray, "k 3 2"]
    turns: Float[np.ndarray, "k 2"]
    shifts: Float[np.ndarray, "k 2"]
    centers: Float[np.ndarray, "k 3 2"]
    along: Float[np.ndarray, "k 3"]

    def kept(self, which: np.ndarray) -> Poses:
        """Those that a mask or indices select."""
        columns = (self.edges, self.holes, self.turns, self.shifts, self.centers, self.along)
        return Poses(*(column[which] for column in columns))


@dataclass(frozen=True, eq=False)
class _Families:
    """Three grown edges each, whose normals span the plane.

    Attributes:
        edges: shape (t, 3).  normals: shape (t, 3, 2).  offsets: c, shape (t, 3) [m].
        weights: l with sum l_i n_i = 0, shape (t, 3).
        inverses: of the three normals as rows, shape (t, 2, 3).
    """

    edges: Int[np.ndarray, "t 3"]
    normals: Float[np.ndarray, "t 3 2"]
    offsets: Float[np.ndarray, "t 3"]
    weights: Float[np.ndarray, "t 3"]
    inverses: Float[np.ndarray, "t 2 3"]


def solve_poses(triples: Triples, grown: GrownEdges, pitch: float) -> Poses:
    """All poses of the candidates, with each locator within its grown edge and locators of one edge in their order.

    Left out: triples of parallel normals, which leave the part free to slide along them (one-parameter families), and
    double roots, where the three normals meet in a point and leave it free to turn about that: neither locates the
    part, and no clamp can hold it with three contacts of rank two.
    """
    families, rows, which = _families(triples, grown)
    h = pitch * triples.holes[rows]
    normals, weights, offsets = families.normals[which], families.weights[which], families.offsets[which]
    dots, crosses = (normals * h).sum(axis=2), _cross(normals, h)
    sums = ((weights * terms).sum(axis=1) for terms in (dots, crosses, offsets))
    index, turns = _roots(*sums)
    gaps = turns[:, :1] * dots[index] + turns[:, 1:] * crosses[index] - offsets[index]
    shifts = np.einsum("kij,kj->ki", families.inverses[which[index]], gaps)
    centers = in_part(h[index], turns[:, None]) - shifts[:, None]
    edges = families.edges[which[index]]
    along = ((centers - grown.starts[edges]) * grown.tangents[edges]).sum(axis=2)
    inside = ((grown.first[edges] < along) & (along < grown.last[edges])).all(axis=1)
    in_order = ((edges[:, 1:] > edges[:, :-1]) | (along[:, 1:] > along[:, :-1])).all(axis=1)
    return Poses(edges, triples.holes[rows[index]], turns, shifts, centers, along).kept(inside & in_order)


def _families(triples: Triples, grown: GrownEdges) -> tuple[_Families, Indices, Indices]:
    """The edge triples that are not parallel; which candidates have one, and which one those have."""
    edges, which = unique_rows(triples.edges, len(grown.edges))
    normals = grown.normals[edges]
    weights = _cross(normals[:, [1, 2, 0]], normals[:, [2, 0, 1]])
    spanning = np.abs(weights).max(axis=1) > PARALLEL_EDGES
    kept = np.flatnonzero(spanning)
    families = _Families(
        edges[kept], normals[kept], grown.offsets[edges[kept]], weights[kept], np.linalg.pinv(normals[kept])
    )
    rows = np.flatnonzero(spanning[which])
    return families, rows, (np.cumsum(spanning) - 1)[which[rows]]


def _roots(a: Weights, b: Weights, c: Weights) -> tuple[np.ndarray, Float[np.ndarray, "k 2"]]:
    """[cos, sin] of all solutions of a cos + b sin = c, and the equation that each belongs to."""
    size = np.hypot(a, b)
    rows = np.flatnonzero(np.abs(c) < size)
    # unit vectors first: then the root keeps its digits whatever the part's size
    a, b, c = a[rows] / size[rows], b[rows] / size[rows], c[rows] / size[rows]
    rest = np.sqrt((1 - c) * (1 + c))
    turns = [np.column_stack([a * c - side * b * rest, b * c + side * a * rest]) for side in (1, -1)]
    found = np.concatenate(turns)
    return np.concatenate([rows, rows]), found / np.linalg.norm(found, axis=1, keepdims=True)


def in_part(vectors: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """R^T v: directions given in W, in P."""
    cos, sin, x, y = turns[..., 0], turns[..., 1], vectors[..., 0], vectors[..., 1]
    return np.stack([cos * x + sin * y, cos * y - sin * x], axis=-1)


def in_world(vectors: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """R v: directions given in P, in W."""
    return in_part(vectors, turns * np.array([1, -1]))


def _cross(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
