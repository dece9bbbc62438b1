"""DUAL, INTERSECT, CONVEXSUM: the operations that Theorem 1 makes a matter of writing vectors down (section 2.5)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.cones.cone import FaceForm, PolyhedralConvexCone, SpanForm, require_same_dimension
from fixture_design.cones.convert import convert
from fixture_design.tolerances import DEFAULT, Tolerances


def dual(cone: PolyhedralConvexCone) -> PolyhedralConvexCone:
    """DUAL(A) = A* = {y : x . y <= 0 for all x in A}  (2-28).

    Faces become spans, equalities lines, and the reverse (Theorem 1: 2-30, 2-31). No conversion takes place: the dual
    is known in the opposite of the form(s) that the cone is known in. {o}* = R^d, (A*)* = A  (2-32).
    """
    face = FaceForm(cone.spans, cone.lines) if cone.span_form is not None else None
    span = SpanForm(cone.faces, cone.equalities) if cone.face_form is not None else None
    return PolyhedralConvexCone(cone.dimension, face, span, cone.certain)


def intersect(*cones: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """INTERSECT(A, B): the face vectors of all together (2-33). Cones in span form are converted first.

    Raises:
        DimensionError: cones of different dimensions.
    """
    dimension = require_same_dimension(*cones)
    known = [convert(cone, tolerances) if cone.face_form is None else cone for cone in cones]
    faces = np.vstack([cone.faces for cone in known])
    equalities = np.vstack([cone.equalities for cone in known])
    together = PolyhedralConvexCone.from_faces(faces, equalities, dimension=dimension)
    return replace(together, certain=all(cone.certain for cone in known))


def convex_sum(*cones: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """CONVEXSUM(A, B) = {x + y : x in A, y in B}: the span vectors of all together (2-29, 2-34).

    Cones in face form are converted first. Raises DimensionError for cones of different dimensions.
    """
    dimension = require_same_dimension(*cones)
    known = [convert(cone, tolerances) if cone.span_form is None else cone for cone in cones]
    spans = np.vstack([cone.spans for cone in known])
    lines = np.vstack([cone.lines for cone in known])
    together = PolyhedralConvexCone.from_span(spans, lines, dimension=dimension)
    return replace(together, certain=all(cone.certain for cone in known))
