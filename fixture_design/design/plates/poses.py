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

from fixture_design.arrays import Weights
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


def solve_poses(triples: Triples, grown: GrownEdges, pitch: float) -> Poses:
    """All poses of the candidates, with each locator within its grown edge and locators of one edge in their order.

    Left out: triples of parallel normals, which leave the part free to slide along them (one-parameter families), and
    double roots, where the three normals meet in a point and leave it free to turn about that: neither locates the
    part, and no clamp can hold it with three contacts of rank two.
    """
    families, which = unique_rows(triples.edges, len(grown.edges))
    normals, offsets = grown.normals[families], grown.offsets[families]
    weights = _cross(normals[:, [1, 2, 0]], normals[:, [2, 0, 1]])
    usable = np.abs(weights).max(axis=1) > PARALLEL_EDGES
    inverses = np.zeros((len(families), 2, 3))
    inverses[usable] = np.linalg.pinv(normals[usable])
    rows = np.flatnonzero(usable[which])
    which, h = which[rows], pitch * triples.holes[rows]
    dots = np.einsum("kij,kij->ki", normals[which], h)
    crosses = _cross(normals[which], h)
    index, turns = _roots(
        np.einsum("ki,ki->k", weights[which], dots),
        np.einsum("ki,ki->k", weights[which], crosses),
        np.einsum("ti,ti->t", weights, offsets)[which],
    )
    rows, which, h = rows[index], which[index], h[index]
    gaps = turns[:, :1] * dots[index] + turns[:, 1:] * crosses[index] - offsets[which]
    shifts = np.einsum("kij,kj->ki", inverses[which], gaps)
    centers = in_part(h, turns[:, None]) - shifts[:, None]
    edges = triples.edges[rows]
    along = np.einsum("kij,kij->ki", centers - grown.starts[edges], grown.tangents[edges])
    poses = Poses(edges, triples.holes[rows], turns, shifts, centers, along)
    inside = ((grown.first[edges] < along) & (along < grown.last[edges])).all(axis=1)
    in_order = ((edges[:, 1:] > edges[:, :-1]) | (along[:, 1:] > along[:, :-1])).all(axis=1)
    return poses.kept(inside & in_order)


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
