"""Straight edges: those along which two facets meet, without the vertices that a mesh puts in between."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices
from fixture_design.geometry.shapes import EdgeEnds, PerPoint, Vertices


def straight_edges(ends: EdgeEnds, owners: EdgeEnds, vertices: Vertices, blur: float) -> Int[np.ndarray, "k 2"]:
    """The edges with those made one that follow each other in a line.

    Two edges are one where they alone meet in a vertex, lie between the same two facets, and the vertex is no further
    than ``blur`` [m] from the line between their other ends. A chain of them stays as it is if any of its vertices is
    further than that from the line between the ends of the chain.

    Args:
        ends: vertex numbers, shape (e, 2).  owners: the two facets at each edge, in order, shape (e, 2).

    Returns:
        vertex numbers, shape (k, 2), k <= e, each row in order.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not len(ends):
        return ends
    first, second = _meeting_in_twos(ends, len(vertices))
    mine, theirs = ends[first], ends[second]
    shared = np.where((mine == theirs[:, :1]) | (mine == theirs[:, 1:]), mine, -1).max(axis=1)
    before, after = mine.sum(axis=1) - shared, theirs.sum(axis=1) - shared
    inner = (owners[first] == owners[second]).all(axis=1)
    inner &= _off_lines(vertices[shared], vertices[before], vertices[after]) <= blur
    links = coo_array((np.ones(int(inner.sum())), (first[inner], second[inner])), shape=(len(ends), len(ends)))
    count, chain = connected_components(links, directed=False)
    # what a chain has once are its ends
    places = np.repeat(chain, 2) * len(vertices) + ends.ravel()
    found, times = np.unique(places, return_counts=True)
    of_chain, vertex = found // len(vertices), found % len(vertices)
    single = times == 1
    whole = np.bincount(of_chain[single], minlength=count) == 2
    start, end = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    outer = single & whole[of_chain]
    start[of_chain[outer][::2]], end[of_chain[outer][::2]] = vertex[outer][::2], vertex[outer][1::2]
    off = np.zeros(count)
    np.maximum.at(off, of_chain, _off_lines(vertices[vertex], vertices[start[of_chain]], vertices[end[of_chain]]))
    whole &= off <= blur
    joined = np.column_stack([start[whole], end[whole]])
    return np.unique(np.sort(np.vstack([joined, ends[~whole[chain]]]), axis=1), axis=0)


def _meeting_in_twos(ends: EdgeEnds, vertex_count: int) -> tuple[Indices, Indices]:
    """The two edges at each vertex that has two."""
    corners = ends.ravel()
    order = np.argsort(corners, kind="stable")
    first = np.flatnonzero(np.diff(corners[order], prepend=-1))
    twos = first[np.diff(first, append=len(corners)) == 2]
    return order[twos] // 2, order[twos + 1] // 2


def _off_lines(points: Vertices, starts: Vertices, ends: Vertices) -> PerPoint:
    """Distance of points from the segments between two others each [m]."""
    along = ends - starts
    sizes = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", points - starts, along) / np.where(sizes > 0, sizes, 1.0)
    return np.linalg.norm(points - starts - np.clip(share, 0.0, 1.0)[:, None] * along, axis=1)
