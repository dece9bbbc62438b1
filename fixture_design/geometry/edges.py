"""The edges of a triangle mesh, and how often its triangles run along each of them in either sense."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.geometry.shapes import EdgeEnds, EdgeMask, OfSide, PerEdge, Sides, Triangles


def directed_edges(triangles: Triangles) -> Sides:
    """The three edges of each triangle in its own sense, shape (3 t, 2); rows 3 i to 3 i + 2 are of triangle i."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class Edges:
    """The distinct edges of a mesh.

    Attributes:
        ends: shape (e, 2), the lower vertex number first.
        number: shape (3 t,), which edge each row of `directed_edges` is; -1 for one from a vertex to itself.
        uses: shape (e,), how many sides of triangles lie on it: 2 on a plain closed surface, odd at a hole.
        balance: shape (e,), uses in the sense of `ends` less uses against it: 0 where neighbours are wound alike.
    """

    ends: EdgeEnds
    number: OfSide
    uses: PerEdge
    balance: PerEdge

    @property
    def odd(self) -> EdgeMask:
        """Where the surface is not closed."""
        return self.uses % 2 == 1


def edges_of(triangles: Triangles, vertex_count: int) -> Edges:
    """The distinct edges of some triangles."""
    sides = directed_edges(triangles)
    proper = sides[:, 0] != sides[:, 1]
    low, high = sides.min(axis=1), sides.max(axis=1)
    keys, index = np.unique(low[proper] * vertex_count + high[proper], return_inverse=True)
    number = np.full(len(sides), -1, dtype=np.int64)
    number[proper] = index.ravel()
    sense = np.where(sides[proper, 0] < sides[proper, 1], 1, -1)
    balance = np.bincount(index.ravel(), weights=sense, minlength=len(keys)).astype(np.int64)
    uses = np.bincount(index.ravel(), minlength=len(keys)).astype(np.int64)
    return Edges(np.column_stack([keys // vertex_count, keys % vertex_count]), number, uses, balance)


def neighbours(triangles: Triangles, vertex_count: int) -> Triangles:
    """The triangle across each directed edge, shape (t, 3): entry [i, k] shares the edge from corner k to k + 1.

    -1 where an edge has more than two triangles (solids that touch along it): what is across is then not defined.
    """
    edges = directed_edges(triangles)
    forward = edges[:, 0] * vertex_count + edges[:, 1]
    backward = edges[:, 1] * vertex_count + edges[:, 0]
    _, number, uses = np.unique(forward, return_inverse=True, return_counts=True)
    order = np.argsort(forward, kind="stable")
    place = order[np.minimum(np.searchsorted(forward, backward, sorter=order), len(order) - 1)]
    single = uses[number] == 1
    found = (forward[place] == backward) & single & single[place]
    return np.where(found, place // 3, -1).reshape(-1, 3)
