"""The polyhedral convex cone (PCC) of section 2.4, with both its forms.

Face form (2-24):  A = face{a_1..a_m} = {x : a_i . x <= 0}, with *equalities* e . x = 0 kept apart.
Span form (2-26):  A = span{u_1..u_k} = {sum c_j u_j : c_j >= 0}, with *lines* (both directions) kept apart.

A form that was not computed is None, never an empty array: without face vectors a cone is the whole space, without span
vectors it is {o}, and neither may be mistaken for "not known".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import ArrayLike, Mask, Rows, Vector, read_only
from fixture_design.errors import ConeError, DimensionError
from fixture_design.tolerances import ZERO_ROW


@dataclass(frozen=True, eq=False)
class FaceForm:
    """{x : faces . x <= 0, equalities . x = 0}; shapes (m, d) and (e, d)."""

    faces: Rows
    equalities: Rows


@dataclass(frozen=True, eq=False)
class SpanForm:
    """{c @ spans + b @ lines : c >= 0}; shapes (k, d) and (l, d)."""

    spans: Rows
    lines: Rows


@dataclass(frozen=True, eq=False)
class PolyhedralConvexCone:
    """A polyhedral convex cone in R^d in face form, span form or both.

    Build one with `from_faces`, `from_span`, `whole_space` or `origin`; `convert` adds the missing form. Vectors keep
    the scale they were given; zero vectors among them are allowed and say nothing. Arrays are read-only. ``certain`` is
    False once a conversion met a value in the undecided band (`tolerances`): the cone may have another structure.

    Example:
        >>> quadrant = PolyhedralConvexCone.from_faces([[-1, 0], [0, -1]])
        >>> quadrant.dimension
        2
    """

    dimension: int
    face_form: FaceForm | None = None
    span_form: SpanForm | None = None
    certain: bool = True

    @classmethod
    def from_faces(
        cls, faces: ArrayLike, equalities: ArrayLike = (), *, dimension: int | None = None
    ) -> PolyhedralConvexCone:
        """A = {x : a . x <= 0 for the faces, e . x = 0 for the equalities}  (2-24).

        Args:
            faces: shape (m, d); may be empty if ``dimension`` or ``equalities`` tells d.
            equalities: shape (e, d).
            dimension: d, needed only where no vector tells it.

        Raises:
            DimensionError: vectors of different lengths, or no way to tell d.
            ConeError: NaN or infinite entries.
        """
        d = _common_dimension(dimension, faces, equalities)
        return cls(d, face_form=FaceForm(_vectors(faces, d), _vectors(equalities, d)))

    @classmethod
    def from_span(
        cls, spans: ArrayLike, lines: ArrayLike = (), *, dimension: int | None = None
    ) -> PolyhedralConvexCone:
        """A = {sum c_j u_j + sum b_i l_i : c_j >= 0, any b_i}  (2-26). Arguments and errors as in `from_faces`."""
        d = _common_dimension(dimension, spans, lines)
        return cls(d, span_form=SpanForm(_vectors(spans, d), _vectors(lines, d)))

    @classmethod
    def whole_space(cls, dimension: int) -> PolyhedralConvexCone:
        """R^d, in both forms."""
        none, all_ = np.zeros((0, dimension)), np.eye(dimension)
        return cls(dimension, FaceForm(read_only(none), read_only(none)), SpanForm(read_only(none), read_only(all_)))

    @classmethod
    def origin(cls, dimension: int) -> PolyhedralConvexCone:
        """{o}, in both forms."""
        none, all_ = np.zeros((0, dimension)), np.eye(dimension)
        return cls(dimension, FaceForm(read_only(none), read_only(all_)), SpanForm(read_only(none), read_only(none)))

    @property
    def faces(self) -> Rows:
        """Face vectors, shape (m, d). Raises ConeError while the face form is not there: `convert` computes it."""
        return self._face_form().faces

    @property
    def equalities(self) -> Rows:
        """Vectors orthogonal to the whole cone, shape (e, d). Raises like `faces`."""
        return self._face_form().equalities

    @property
    def spans(self) -> Rows:
        """Span vectors, shape (k, d). Raises ConeError while the span form is not there: `convert` computes it."""
        return self._span_form().spans

    @property
    def lines(self) -> Rows:
        """Vectors contained in both directions, shape (l, d). Raises like `spans`."""
        return self._span_form().lines

    def _face_form(self) -> FaceForm:
        if self.face_form is None:
            raise ConeError("this cone is known in span form only; convert(cone) computes its face form")
        return self.face_form

    def _span_form(self) -> SpanForm:
        if self.span_form is None:
            raise ConeError("this cone is known in face form only; convert(cone) computes its span form")
        return self.span_form

    def __repr__(self) -> str:
        known = []
        if self.face_form is not None:
            known.append(f"{len(self.faces)} faces, {len(self.equalities)} equalities")
        if self.span_form is not None:
            known.append(f"{len(self.spans)} spans, {len(self.lines)} lines")
        return f"PolyhedralConvexCone(R^{self.dimension}: {'; '.join(known)})"


def unit_rows(rows: Rows) -> tuple[Rows, Mask]:
    """Rows of length one, and which of the given rows they came from: zero rows are left out.

    A row counts as zero only next to nothing at all (`tolerances.ZERO_ROW` of the longest): vectors of one cone may
    differ in scale by any factor that a float holds.
    """
    largest = np.max(np.abs(rows), axis=1, initial=0.0)
    kept = largest > ZERO_ROW * float(largest.max(initial=0.0))
    # two steps, so that neither huge nor tiny rows overflow or underflow in the norm
    scaled = rows[kept] / largest[kept, None]
    return scaled / np.linalg.norm(scaled, axis=1, keepdims=True), kept


def unit_vector(vector: Vector) -> Vector | None:
    """The vector scaled to length one, or None for a zero vector."""
    rows, _ = unit_rows(vector[None, :])
    return rows[0] if len(rows) else None


def require_same_dimension(*cones: PolyhedralConvexCone) -> int:
    """The dimension that the cones share; raises DimensionError if they differ."""
    dimensions = {cone.dimension for cone in cones}
    if len(dimensions) != 1:
        raise DimensionError(f"cones of different dimensions: {sorted(dimensions)}")
    return dimensions.pop()


def _common_dimension(dimension: int | None, *groups: ArrayLike) -> int:
    found = {dimension} if dimension is not None else set()
    for group in groups:
        try:
            array = np.asarray(group, dtype=np.float64)
        except (TypeError, ValueError) as cause:
            raise DimensionError("cone vectors must be rows of numbers of one length") from cause
        if array.ndim == 2 and array.shape[1]:
            found.add(array.shape[1])
        elif array.size:
            raise DimensionError(f"cone vectors must be a list of rows; got an array of shape {array.shape}")
    if not found:
        raise DimensionError("without any vector the dimension must be given: dimension=3")
    if len(found) != 1:
        raise DimensionError(f"cone vectors of different lengths: {sorted(found)}")
    return found.pop()


def _vectors(values: ArrayLike, dimension: int) -> Rows:
    array = read_only(values).reshape(-1, dimension)
    if not np.isfinite(array).all():
        bad = int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])
        raise ConeError(f"cone vector {bad} is not finite: {array[bad]}")
    return array
