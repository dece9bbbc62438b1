"""Mending a mesh without changing its shape: equal vertices merged, triangles without area taken out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.piece import Piece, heights
from fixture_design.geometry.shapes import Triangles
from fixture_design.tolerances import MERGE_VERTICES, ZERO_COORDINATE


def merged(piece: Piece) -> Piece:
    """The piece with vertices closer than ``MERGE_VERTICES`` x size made one, and unused ones dropped.

    Of vertices that differ by noise, the one nearest to the origin is kept: exporters write -3e-16 beside 0.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    used, triangles = np.unique(piece.triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    vertices, rounding = piece.vertices[used], piece.rounding[used]
    # adding 0.0 turns -0.0 into 0.0
    vertices = np.where(np.abs(vertices) <= ZERO_COORDINATE * piece.size, 0.0, vertices) + 0.0
    distinct, first, number = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    pairs = KDTree(distinct).query_pairs(MERGE_VERTICES * piece.size, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(distinct), len(distinct)))
    _, cluster = connected_components(links, directed=False)
    order = np.argsort(np.abs(distinct).sum(axis=1), kind="stable")
    _, kept = np.unique(cluster[order], return_index=True)
    chosen = order[kept]
    return replace(
        piece,
        vertices=distinct[chosen],
        rounding=rounding[first][chosen],
        triangles=cluster[number.ravel()][triangles].astype(np.int64),
    )


def without_needles(piece: Piece) -> Piece:
    """The merged piece without triangles of zero area: repeated corners dropped, needles flipped away.

    A needle has its three corners on a line; it closes the gap between one long edge and two short ones. Splitting the
    neighbour across the long edge at the needle's middle corner takes it out and leaves the surface as it was.

    Raises:
        GeometryError: needles that border only on each other, so that nothing is left to split.
    """
    triangles = piece.triangles
    repeated = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    triangles = triangles[~repeated]
    count = int(repeated.sum())
    # each round takes out at least one needle, or nothing changes any more
    while len(needles := _needles(piece, triangles)):
        flipped = _flip_one(piece, triangles, needles)
        if flipped is None:
            place = piece.vertices[triangles[needles[0]]].mean(axis=0)
            raise piece.error(
                f"the mesh has {len(needles)} triangles without area that cannot be taken out",
                found=f"one at {np.round(place, 6).tolist()} m",
                expected="triangles with an area; repair the mesh in the program that made it",
            )
        triangles, count = flipped, count + 1
    if not count:
        return piece
    return replace(piece, triangles=triangles, notes=piece.note(f"{count} triangles without area taken out"))


def _needles(piece: Piece, triangles: Triangles) -> Indices:
    return np.flatnonzero(heights(piece.vertices, triangles) <= ZERO_COORDINATE * piece.size)


def _flip_one(piece: Piece, triangles: Triangles, needles: Indices) -> Triangles | None:
    """The triangles with one of the needles flipped away, None if none can be."""
    for needle in needles:
        corners = triangles[needle]
        points = piece.vertices[corners]
        # the longest side is from corner `start` to the next one; the third lies between them
        start = int(np.argmax(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)))
        first, second, middle = (int(corners[(start + step) % 3]) for step in range(3))
        across = np.flatnonzero(((triangles == second) & (np.roll(triangles, -1, axis=1) == first)).any(axis=1))
        if len(across) != 1 or middle in triangles[across[0]]:
            continue
        apex = int(next(corner for corner in triangles[across[0]] if corner not in (first, second)))
        result = triangles.copy()
        # the neighbour is (second, first, apex); its edge second -> first becomes second -> middle -> first
        result[across[0]] = (second, middle, apex)
        result[needle] = (middle, first, apex)
        if len(_needles(piece, result[[across[0], needle]])) <= 1:
            return result
    return None
