"""General polyhedral contact: which motions of a contact point two solids that touch there admit, as an AND of ORs.

Let C1 (the moving part) and C2 (a fixed body) be the tangent cones at the contact point, each a union of convex
pieces C1a, C2b. A displacement v of the contact point carries C1 to v + C1, which enters C2 if and only if v = x2 - x1
for some x1 inside C1 and x2 inside C2:

    v is admissible to first order  <=>  for every pair of pieces, v is not in the interior of C2b - C1a.

With m_1..m_k the outward normals of the facets of that difference cone, v stays out of its interior if m_j . v >= 0 for
some j: a clause with the alternatives n_j = -m_j, which point out of the part and into the body. Apex on facet, apex on
convex edge (an OR), apex in a concave edge (an AND), edge across edge (the cross product of the edges) and edge on face
all follow. Beyond the thesis, which has points on facets, edges and apices (2.2.1).

Pieces may overlap or be disjoint as long as their interiors make up the interior of the solid's cone up to walls
between them; where the other side has no volume (a point, a line) they must overlap, so that no wall is left out: at a
concave edge the two half-spaces, not a cut along one of them, which would let the tip slide along it into the material.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from fixture_design.arrays import Point
from fixture_design.cones import PolyhedralConvexCone, convert, convert_rows
from fixture_design.contacts.contact import Clause, unit_normal
from fixture_design.tolerances import Tolerances

#: A convex piece of a tangent cone, {x : n . x <= 0}: the outward normals of its facets, of any length.
Piece = Sequence[Point]

#: Angles are compared directly here, without a band: what is nearly parallel was drawn parallel [rad].
_EXACT = Tolerances(tie=1e-9, band=1.0)


def polyhedral_clauses(
    moving: Sequence[Piece], fixed: Sequence[Piece], parallel: float = _EXACT.tie, *, pass_by: bool = False
) -> tuple[Clause, ...] | None:
    """The clauses of a contact between two polyhedral cones, redundant ones left out.

    A pair whose difference cone has no interior never meets and gives no clause (two points, or flat pieces).

    Args:
        moving, fixed: convex pieces C1a of the part and C2b of the body, each by its outward normals; in R2 or R3.
        parallel: sines up to this are zeros: edges in faces and along edges, facets on facets [-].
        pass_by: pieces that overlap already only pass each other within a gap: they give no clause.

    Returns:
        the AND of ORs; its normals are the part's own where a facet of the part makes the facet, else the body's,
        reversed, else unit cross products of edges. No clause if nothing meets; None if the cones overlap already: the
        solids penetrate, and no motion is admissible.

    Example:
        An edge of a block, along y, on a floor z = 0: one clause with the floor's normal, reversed.
        >>> wedge, floor = [np.array([1.0, 0, -1]), np.array([-1.0, 0, -1])], [np.array([0, 0, 1.0])]
        >>> polyhedral_clauses([wedge], [floor])
        ((array([-0., -0., -1.]),),)
    """
    tolerances = Tolerances(tie=parallel, band=1.0)
    differences = []
    for piece in moving:
        for other in fixed:
            cone = _difference(piece, other, tolerances)
            if len(cone.equalities):
                continue
            if not len(cone.faces):
                if pass_by:
                    continue
                return None
            clause = tuple(_given(-facet, piece, other, parallel) for facet in cone.faces)
            differences.append((cone, clause))
    kept = _without_contained(differences, parallel)
    return tuple(sorted((_sorted(clause) for clause in kept), key=lambda clause: [_key(n) for n in clause]))


def _difference(piece: Piece, other: Piece, tolerances: Tolerances) -> PolyhedralConvexCone:
    """C2b - C1a with both forms: spanned by the body's span vectors and the part's, reversed."""
    mine, theirs = _spanned(piece, tolerances), _spanned(other, tolerances)
    spans = np.vstack([theirs.spans, -mine.spans])
    lines = np.vstack([theirs.lines, mine.lines])
    found = convert_rows(spans, lines, tolerances)
    spanned = PolyhedralConvexCone.from_span(spans, lines, dimension=mine.dimension)
    faces = PolyhedralConvexCone.from_faces(found.vectors, found.lines, dimension=mine.dimension)
    return PolyhedralConvexCone(mine.dimension, faces.face_form, spanned.span_form)


def _spanned(piece: Piece, tolerances: Tolerances) -> PolyhedralConvexCone:
    return _spanned_by(np.array(piece, dtype=np.float64).tobytes(), len(piece[0]), tolerances)


@lru_cache(maxsize=1024)
def _spanned_by(packed: bytes, dimension: int, tolerances: Tolerances) -> PolyhedralConvexCone:
    """The same pieces come again and again, along an edge and all over a face."""
    normals = np.frombuffer(packed).reshape(-1, dimension)
    return convert(PolyhedralConvexCone.from_faces(normals, dimension=dimension), tolerances)


def _given(normal: Point, piece: Piece, other: Piece, parallel: float) -> Point:
    """The normal as the nearest facet has it, where it is one; of equals the part's own. Products are not exact."""
    given = [*piece, *(-facet for facet in other)]
    off = [float(np.linalg.norm(unit_normal(facet) - normal)) for facet in given]
    nearest = int(np.argmin(off))
    if off[nearest] > 3 * parallel:
        return normal
    return next(facet for facet, its in zip(given, off, strict=True) if its <= off[nearest] + _EXACT.tie)


def _without_contained(
    differences: Sequence[tuple[PolyhedralConvexCone, Clause]], parallel: float
) -> tuple[Clause, ...]:
    """The clauses of the largest difference cones: to stay out of one is to stay out of all that it contains."""
    kept: list[tuple[PolyhedralConvexCone, Clause]] = []
    for cone, clause in differences:
        if any(_contains(larger, cone, parallel) for larger, _ in kept):
            continue
        kept = [(smaller, its) for smaller, its in kept if not _contains(cone, smaller, parallel)]
        kept.append((cone, clause))
    return tuple(clause for _, clause in kept)


def _contains(larger: PolyhedralConvexCone, smaller: PolyhedralConvexCone, parallel: float) -> bool:
    generators = np.vstack([smaller.spans, smaller.lines, -smaller.lines])
    lengths = np.linalg.norm(generators, axis=1, keepdims=True)
    return bool((generators / lengths @ larger.faces.T <= 3 * parallel).all())


def _sorted(clause: Clause) -> Clause:
    return tuple(sorted(clause, key=_key))


def _key(normal: Point) -> list[float]:
    return (np.round(unit_normal(normal), 7) + 0.0).tolist()
