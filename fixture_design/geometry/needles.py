"""Triangles without area, and slivers folded over, taken out, so that the surface stays what it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.errors import format_length
from fixture_design.geometry.edges import neighbours
from fixture_design.geometry.flips import Flips, flat_ones
from fixture_design.geometry.piece import Piece, area_vectors
from fixture_design.geometry.shapes import PerVertex, TriangleMask
from fixture_design.tolerances import ON_EDGE_ROUNDINGS, ZERO_COORDINATE

#: Rounds of flips, each reaching one triangle further, before a mesh is given up [-]: slivers in a fan wait for the one
#: at its end.
_ROUNDS = 10


def without_needles(piece: Piece) -> Piece:
    """The closed piece without triangles of zero area: repeated corners dropped, needles flipped away.

    A needle has its three corners on a line; it closes the gap between one long edge and two short ones. Splitting the
    neighbour across the long edge at the needle's middle corner takes it out and leaves the surface as it was.

    Raises:
        GeometryError: needles that border only on each other, so that nothing is left to split.
    """
    repeated = (piece.triangles == np.roll(piece.triangles, 1, axis=1)).any(axis=1)
    piece, before = replace(piece, triangles=piece.triangles[~repeated]), piece
    flat = np.full(len(piece.vertices), ZERO_COORDINATE * piece.size)
    needles = np.flatnonzero(flat_ones(piece, piece.triangles, flat))
    if not len(needles):
        count = int(repeated.sum())
        return replace(piece, notes=piece.note(_text(count))) if count else before
    flips = Flips(piece, flat)
    flips.run(needles)
    triangles = flips.triangles()
    if len(left := np.flatnonzero(flat_ones(piece, triangles, flat))):
        place = piece.vertices[triangles[left[0]]].mean(axis=0)
        raise piece.error(
            f"the mesh has {len(left)} triangles without area that cannot be taken out",
            found=f"one at {np.round(place, 6).tolist()} m",
            expected="triangles with an area; repair the mesh in the program that made it",
        )
    return replace(piece, triangles=triangles, notes=piece.note(_text(int(repeated.sum()) + flips.count)))


def _text(count: int) -> str:
    return f"{count} triangles without area taken out"


def without_folds(piece: Piece) -> Piece:
    """The closed piece without slivers that are folded over their neighbours, where rounding may have folded them.

    Exporters that close cracks with needles round the corners afterwards, and every other needle turns over. A sliver
    is no higher than ``ON_EDGE_ROUNDINGS`` times the rounding of its vertices, so flipping it moves the surface by no
    more than that. Folds that cannot be flipped away are left to Drake, which refuses those that it cannot measure.
    """
    flat = ON_EDGE_ROUNDINGS * piece.rounding
    before, count = piece, int(_folded(piece, flat).sum())
    if not count:
        return piece
    moved = 0.0
    for rings in range(_ROUNDS):
        folded = _folded(piece, flat)
        if not folded.any():
            break
        flips = Flips(piece, flat)
        flips.run(np.flatnonzero(_with_slivers_around(piece, flat, folded, rings)))
        piece, moved = replace(piece, triangles=flips.triangles()), max(moved, flips.highest)
    left = int(_folded(piece, flat).sum())
    if left >= count:
        return before
    text = f"{count - left} slivers folded over their neighbours flipped away, each by at most {format_length(moved)}"
    return replace(piece, notes=before.note(text))


def _with_slivers_around(piece: Piece, flat: PerVertex, folded: TriangleMask, rings: int) -> TriangleMask:
    """The folded slivers and those up to so many triangles away: in a fan one waits for the next."""
    slivers = flat_ones(piece, piece.triangles, flat)
    across = neighbours(piece.triangles, len(piece.vertices))
    for _ in range(rings):
        folded = folded | (slivers & (folded[across] & (across >= 0)).any(axis=1))
    return folded


def _folded(piece: Piece, flat: PerVertex) -> TriangleMask:
    """Which slivers point away from one of their neighbours."""
    folded = np.zeros(len(piece.triangles), dtype=bool)
    slivers = np.flatnonzero(flat_ones(piece, piece.triangles, flat))
    if len(slivers):
        areas = area_vectors(piece.vertices, piece.triangles)
        across = neighbours(piece.triangles, len(piece.vertices))[slivers]
        away = np.einsum("ij,ikj->ik", areas[slivers], areas[across]) < 0
        folded[slivers] = (away & (across >= 0)).any(axis=1)
    return folded
