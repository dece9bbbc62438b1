"""What a mesh must be before anything is asked of it: finite, not empty, closed, and wound outward."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Int

from fixture_design.errors import format_length
from fixture_design.geometry.mending import merged, without_needles
from fixture_design.geometry.piece import Piece, volume
from fixture_design.geometry.shapes import OfTriangle, Triangles, Vector3, Vertices
from fixture_design.tolerances import MERGE_VERTICES, PLAUSIBLE_SIZE


def sound(piece: Piece) -> Piece:
    """The piece with vertices merged, needles out and every shell wound outward; notes say what was done.

    Raises:
        GeometryError: no triangles, vertices that are not finite or do not exist, all in one plane, surface not closed,
            neighbours wound against each other.
    """
    _check_numbers(piece)
    piece = without_needles(merged(piece))
    _check_closed(piece)
    return _wound_outward(piece)


def size_notes(vertices: Vertices, source: str) -> tuple[str, ...]:
    """A note if the longest side is outside ``PLAUSIBLE_SIZE``: then `scale` is probably missing."""
    longest = float(np.ptp(vertices, axis=0).max())
    smallest, largest = PLAUSIBLE_SIZE
    if smallest <= longest <= largest:
        return ()
    hint = "0.001 for a file in millimetres, 0.0254 in inches" if longest > largest else "1 for a file in metres"
    return (f"{source}: the part is {format_length(longest)} long; check `scale` ({hint})",)


def directed_edges(triangles: Triangles) -> Int[np.ndarray, "e 2"]:
    """The three edges of each triangle in its own sense, shape (3 t, 2); rows 3 i to 3 i + 2 are of triangle i."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)


def shells(triangles: Triangles, vertex_count: int) -> OfTriangle:
    """Which shell each triangle belongs to, shape (t,): triangles that share an edge are of one shell."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    edges = np.sort(directed_edges(triangles), axis=1)
    _, edge = np.unique(edges[:, 0] * vertex_count + edges[:, 1], return_inverse=True)
    owner = np.repeat(np.arange(len(triangles)), 3)
    nodes = len(triangles) + int(edge.max(initial=-1)) + 1
    links = coo_array((np.ones(len(owner)), (owner, len(triangles) + edge)), shape=(nodes, nodes))
    _, label = connected_components(links, directed=False)
    return np.unique(label[: len(triangles)], return_inverse=True)[1].astype(np.int64)


def _check_numbers(piece: Piece) -> None:
    if not len(piece.triangles):
        raise piece.error("the mesh has no triangles", expected="a closed triangle mesh")
    if not np.isfinite(piece.vertices).all():
        bad = np.flatnonzero(~np.isfinite(piece.vertices).all(axis=1))
        raise piece.error(
            f"{len(bad)} vertices are not finite",
            found=f"vertex {int(bad[0]) + 1}: {piece.vertices[bad[0]].tolist()}",
            expected="numbers",
        )
    if piece.triangles.min() < 0 or piece.triangles.max() >= len(piece.vertices):
        raise piece.error("a triangle refers to a vertex that does not exist")
    # a mesh in one plane is closed at best as a sheet folded on itself, and has no inside
    corners = piece.vertices[piece.triangles.ravel()]
    extents = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    if extents[2] <= MERGE_VERTICES * extents[0]:
        raise piece.error("the mesh is flat: all its vertices lie in one plane", expected="a solid")


def _check_closed(piece: Piece) -> None:
    """Every edge must be used as often in one sense as in the other."""
    if not len(piece.triangles):
        raise piece.error("the mesh has only triangles without area", expected="a closed triangle mesh")
    edges = directed_edges(piece.triangles)
    forward = edges[:, 0] < edges[:, 1]
    pair, number = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    uses = np.bincount(number.ravel(), minlength=len(pair))
    balance = np.bincount(number.ravel(), weights=np.where(forward, 1.0, -1.0), minlength=len(pair))
    for faulty, problem, expected in (
        (uses % 2 == 1, "open edges: the surface is not closed", "a closed surface; fill its holes"),
        (balance != 0, "edges whose two triangles are wound against each other", "one sense of winding"),
    ):
        if faulty.any():
            place = piece.vertices[pair[np.flatnonzero(faulty)[0]]].mean(axis=0)
            text = f"the mesh has {int(faulty.sum())} {problem}"
            raise piece.error(text, found=f"one at {np.round(place, 9).tolist()} m", expected=expected)


def _wound_outward(piece: Piece) -> Piece:
    """Shells that are inside out are turned, unless another shell surrounds them: then they are cavities."""
    label = shells(piece.triangles, len(piece.vertices))
    triangles, turned = piece.triangles.copy(), 0
    boxes = [_box(piece.vertices[triangles[label == shell].ravel()]) for shell in range(label.max() + 1)]
    for shell, (low, high) in enumerate(boxes):
        mine = label == shell
        surrounded = any(
            other != shell and (boxes[other][0] < low).all() and (high < boxes[other][1]).all()
            for other in range(len(boxes))
        )
        if not surrounded and volume(piece.vertices, triangles[mine]) < 0:
            triangles[mine] = triangles[mine][:, ::-1]
            turned += 1
    if not turned:
        return piece
    return replace(piece, triangles=triangles, notes=piece.note(f"{turned} shells were inside out and were turned"))


def _box(points: Vertices) -> tuple[Vector3, Vector3]:
    return points.min(axis=0), points.max(axis=0)
