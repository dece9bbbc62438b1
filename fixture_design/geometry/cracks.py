"""Cracks at T-junctions: a row of vertices along one long edge, which the triangle on its other side does not know."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.errors import format_length
from fixture_design.geometry.edges import directed_edges, edges_of
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.shapes import PerVertex
from fixture_design.tolerances import MERGE_VERTICES, ON_EDGE_ROUNDINGS

_Corners = tuple[int, int, int]


def without_cracks(piece: Piece) -> Piece:
    """The merged piece with open edges split at the open vertices that lie on them.

    A vertex lies on an edge if it is no further from it than both are known: ``ON_EDGE_ROUNDINGS`` times the rounding
    of the vertices, and ``MERGE_VERTICES`` of the size. No vertex moves; the surface does by at most that much. A piece
    that this does not bring closer to a closed surface stays as it was.
    """
    edges = edges_of(piece.triangles, len(piece.vertices))
    sides = np.flatnonzero((edges.uses == 1)[edges.number] & (edges.number >= 0))
    if not len(sides):
        return piece
    side, vertex, along, away = _on_edges(piece, sides, np.unique(edges.ends[edges.odd]))
    chains: dict[int, dict[int, list[int]]] = {}
    for index in np.lexsort((along, side)):
        chain = chains.setdefault(int(side[index]) // 3, {}).setdefault(int(side[index]) % 3, [])
        chain.append(int(vertex[index]))
    whole = np.delete(piece.triangles, list(chains), axis=0)
    parts = [part for triangle, own in chains.items() for part in _split(piece.triangles[triangle].tolist(), own)]
    triangles = np.vstack([whole, np.array(parts, dtype=np.int64).reshape(-1, 3)])
    if edges_of(triangles, len(piece.vertices)).odd.sum() >= edges.odd.sum():
        return piece
    text = f"{len(side)} vertices that lie on open edges joined to them (T-junctions); the surface moved by at most "
    return replace(piece, triangles=triangles, notes=piece.note(text + format_length(float(away.max()))))


def _on_edges(piece: Piece, sides: Indices, candidates: Indices) -> tuple[Indices, Indices, PerVertex, PerVertex]:
    """Which of the candidates lie on which sides: pairs as side, vertex, place along it [m], distance from it [m].

    The ends of a side, and what is as near to them as vertices are known, do not count.
    """
    from scipy.spatial import KDTree

    ends = directed_edges(piece.triangles)[sides]
    start, end = piece.vertices[ends[:, 0]], piece.vertices[ends[:, 1]]
    lengths = np.linalg.norm(end - start, axis=1)
    allowed = MERGE_VERTICES * piece.size + ON_EDGE_ROUNDINGS * piece.rounding[ends].max(axis=1)
    near = KDTree(piece.vertices[candidates]).query_ball_point((start + end) / 2, lengths / 2 + allowed)
    row = np.repeat(np.arange(len(sides)), [len(found) for found in near])
    vertex = candidates[np.concatenate([np.asarray(found, dtype=np.int64) for found in near])]
    from_start = piece.vertices[vertex] - start[row]
    units = (end - start)[row] / lengths[row, None]
    along = np.einsum("ij,ij->i", from_start, units)
    away = np.linalg.norm(from_start - along[:, None] * units, axis=1)
    own = (piece.triangles[sides // 3][row] == vertex[:, None]).any(axis=1)
    on = (away <= allowed[row]) & (along > allowed[row]) & (lengths[row] - along > allowed[row]) & ~own
    return sides[row[on]], vertex[on], along[on], away[on]


def _split(triangle: list[int], chains: dict[int, list[int]]) -> Iterable[_Corners]:
    """A triangle cut up so that its side k, from corner k to k + 1, runs over the vertices of ``chains[k]``."""
    parts: list[_Corners] = [(triangle[0], triangle[1], triangle[2])]
    for corner, chain in chains.items():
        start, end = triangle[corner], triangle[(corner + 1) % 3]
        part = next(part for part in parts if (start, end) in ((part[k], part[(k + 1) % 3]) for k in range(3)))
        parts.remove(part)
        apex = next(vertex for vertex in part if vertex not in (start, end))
        parts += [(one, other, apex) for one, other in pairwise([start, *chain, end])]
    return parts
