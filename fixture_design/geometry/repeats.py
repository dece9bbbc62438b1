"""Faces that are there twice: walls without thickness cancel, copies of one triangle become one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices
from fixture_design.geometry.edges import edges_of
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.shapes import Triangles


def without_repeats(piece: Piece) -> Piece:
    """The merged piece without triangles that occur more than once.

    A triangle and its mirror image have nothing between them: both go (a fin without thickness, or the wall between two
    solids that were joined face to face, which become one). Of equal triangles one stays, unless the surface is closed
    only with all of them (solids that overlap and share a face).
    """
    first, net, count = _tally(piece.triangles)
    if (count == 1).all():
        return piece
    single = np.sign(net)
    if _open(piece, _taken(piece.triangles, first, single)) > _open(piece, _taken(piece.triangles, first, net)):
        single = net
    triangles = _taken(piece.triangles, first, single)
    mirrored = int(((count - np.abs(net)) // 2).sum())
    copies = len(piece.triangles) - len(triangles) - 2 * mirrored
    for number, what in (
        (mirrored, "pairs of triangles back to back, with nothing between them, taken out"),
        (copies, "triangles that were there twice taken out"),
    ):
        if number:
            piece = replace(piece, notes=piece.note(f"{number} {what}"))
    return replace(piece, triangles=triangles)


def _tally(triangles: Triangles) -> tuple[Indices, Indices, Indices]:
    """Of each set of three vertices: a triangle that has it, occurrences in its sense less those against it, and all.

    Triangles with a repeated corner have no sense and are left alone: each counts for itself.
    """
    order = np.argsort(triangles, axis=1)
    ordered = np.take_along_axis(triangles, order, axis=1)
    # 0 1 2, 1 2 0 and 2 0 1 are even
    sense = np.where((order[:, 1] - order[:, 0]) % 3 == 1, 1, -1)
    degenerate = (ordered[:, 0] == ordered[:, 1]) | (ordered[:, 1] == ordered[:, 2])
    apart = np.where(degenerate, np.arange(len(triangles)), -1)
    _, first, group = np.unique(np.column_stack([ordered, apart]), axis=0, return_index=True, return_inverse=True)
    net = np.bincount(group.ravel(), weights=sense * sense[first][group.ravel()]).astype(np.int64)
    return first, net, np.bincount(group.ravel()).astype(np.int64)


def _taken(triangles: Triangles, first: Indices, times: Indices) -> Int[np.ndarray, "_ 3"]:
    """Each of some triangles so many times, reversed where negative, in the order of the file."""
    order = np.argsort(first, kind="stable")
    chosen, times = triangles[first[order]], times[order]
    backward = times < 0
    chosen[backward] = chosen[backward, ::-1]
    return np.repeat(chosen, np.abs(times), axis=0)


def _open(piece: Piece, triangles: Triangles) -> int:
    return int(edges_of(triangles, len(piece.vertices)).odd.sum())
