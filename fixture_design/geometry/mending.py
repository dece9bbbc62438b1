"""Equal vertices made one, and unused ones dropped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.geometry.piece import Piece
from fixture_design.tolerances import MERGE_VERTICES, ZERO_COORDINATE


def merged(piece: Piece) -> Piece:
    """The piece with vertices closer than ``MERGE_VERTICES`` x size made one, and unused ones dropped.

    Of vertices that differ by noise, the one nearest to the origin is kept: exporters write -3e-16 beside 0.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    piece = without_unused(piece)
    # adding 0.0 turns -0.0 into 0.0
    vertices = np.where(np.abs(piece.vertices) <= ZERO_COORDINATE * piece.size, 0.0, piece.vertices) + 0.0
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
        rounding=piece.rounding[first][chosen],
        triangles=cluster[number.ravel()][piece.triangles].astype(np.int64),
    )


def without_unused(piece: Piece) -> Piece:
    """The piece without vertices that no triangle has: they are no part of the shape, nor of its size."""
    used = np.zeros(len(piece.vertices), dtype=bool)
    used[piece.triangles.ravel()] = True
    if used.all():
        return piece
    number = np.cumsum(used) - 1
    return replace(
        piece, vertices=piece.vertices[used], rounding=piece.rounding[used], triangles=number[piece.triangles]
    )
