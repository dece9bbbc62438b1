"""What a mesh must be before anything is asked of it: finite, not empty, closed, and wound outward."""

from __future__ import annotations

import numpy as np

from fixture_design.errors import format_length
from fixture_design.geometry.cracks import without_cracks
from fixture_design.geometry.edges import edges_of
from fixture_design.geometry.mending import merged, without_unused
from fixture_design.geometry.needles import without_folds, without_needles
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.repeats import without_repeats
from fixture_design.geometry.shapes import EdgeEnds, Vertices
from fixture_design.geometry.winding import without_sheets, wound_outward
from fixture_design.tolerances import FARTHEST, MERGE_VERTICES, PLAUSIBLE_SIZE, SMALLEST_PART

#: What every part must be.
_CLOSED = "a closed triangle mesh"

#: What is narrower than this next to its length is called a crack [-].
_CRACK = 1e-2


def sound(piece: Piece) -> Piece:
    """The piece with vertices merged and every shell wound outward, without repeated triangles, cracks at T-junctions,
    needles, slivers that rounding folded over, and shells without thickness; notes say what was done.

    Edges where solids touch, with four triangles or more, stay: they are what the shape is like.

    Raises:
        GeometryError: no triangles, vertices that are not finite or do not exist, too far away, too near each other,
            all in one plane, surface not closed, neighbours wound against each other.
    """
    _check_numbers(piece)
    mended = without_cracks(without_repeats(merged(piece)))
    _check_closed(mended)
    mended = wound_outward(without_sheets(without_folds(without_needles(mended))))
    if piece.smooth and len(mended.triangles) != len(piece.triangles):
        raise piece.error("the shape is too thin: its opposite sides are one within rounding", expected="a solid")
    return without_unused(mended)


def size_notes(vertices: Vertices, source: str) -> tuple[str, ...]:
    """A note if the longest side is outside ``PLAUSIBLE_SIZE``: then `scale` is probably missing."""
    longest = float(np.ptp(vertices, axis=0).max())
    smallest, largest = PLAUSIBLE_SIZE
    if smallest <= longest <= largest:
        return ()
    hint = "0.001 for a file in millimetres, 0.0254 in inches" if longest > largest else "1 for a file in metres"
    return (f"{source}: the part is {format_length(longest)} long; check `scale` ({hint})",)


def _check_numbers(piece: Piece) -> None:
    if not len(piece.triangles):
        raise piece.error("the mesh has no triangles", expected=_CLOSED)
    if not np.isfinite(piece.vertices).all():
        bad = np.flatnonzero(~np.isfinite(piece.vertices).all(axis=1))
        raise piece.error(
            f"{len(bad)} vertices are not finite",
            found=f"vertex {int(bad[0]) + 1}: {piece.vertices[bad[0]].tolist()}",
            expected="numbers",
        )
    if piece.triangles.min() < 0 or piece.triangles.max() >= len(piece.vertices):
        raise piece.error("a triangle refers to a vertex that does not exist")
    corners = piece.vertices[piece.triangles.ravel()]
    _check_bounds(piece, corners)
    # a mesh in one plane is closed at best as a sheet folded on itself, and has no inside
    extents = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    if extents[2] <= MERGE_VERTICES * extents[0]:
        raise piece.error("the mesh is flat: all its vertices lie in one plane", expected="a solid")


def _check_bounds(piece: Piece, corners: Vertices) -> None:
    """Squares of numbers far outside of these overflow, or are zero."""
    longest, farthest = float(np.ptp(corners, axis=0).max()), float(np.abs(corners).max())
    if farthest > FARTHEST:
        raise piece.error("the shape reaches too far", f"{farthest:g} m", f"at most {FARTHEST:g} m")
    if 0 < longest < SMALLEST_PART:
        raise piece.error("the shape is too small", f"{longest:g} m", f"at least {SMALLEST_PART:g} m")


def _check_closed(piece: Piece) -> None:
    """Every edge must be used as often in one sense as in the other."""
    if not len(piece.triangles):
        raise piece.error("the mesh has only triangles without area, or back to back", expected=_CLOSED)
    edges = edges_of(piece.triangles, len(piece.vertices))
    for faulty, problem, expected in (
        (edges.odd, "open edges: the surface is not closed", "a closed surface; fill its holes"),
        (edges.balance != 0, "edges whose two triangles are wound against each other", "one sense of winding"),
    ):
        if faulty.any():
            place = piece.vertices[edges.ends[np.flatnonzero(faulty)[0]]].mean(axis=0)
            text = f"the mesh has {int(faulty.sum())} {problem}"
            found = f"one at {np.round(place, 9).tolist()} m{_crack(piece, edges.ends[faulty])}"
            raise piece.error(text, found=found, expected=expected)


def _crack(piece: Piece, ends: EdgeEnds) -> str:
    """How wide the crack at the first of some open edges is, if that is little next to the edge; else nothing."""
    start, end = piece.vertices[ends[:, 0]], piece.vertices[ends[:, 1]]
    apart = ~np.isin(ends, ends[0]).any(axis=1)
    middle, along = (start[0] + end[0]) / 2, (end - start)[apart]
    share = np.einsum("ij,ij->i", middle - start[apart], along) / np.einsum("ij,ij->i", along, along)
    nearest = start[apart] + np.clip(share, 0.0, 1.0)[:, None] * along
    width = float(np.linalg.norm(nearest - middle, axis=1).min(initial=np.inf))
    if width > _CRACK * np.linalg.norm(end[0] - start[0]):
        return ""
    return f", a crack {format_length(width)} wide"
