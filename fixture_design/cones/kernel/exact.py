"""The kernel's questions in exact arithmetic, for data that are rational: decimals of files, facets from mesh vertices.

Exact arithmetic on numbers that were rounded answers another question than the one that was meant (a unit normal that
was rounded is not parallel to its opposite any more), so ties of rounded data belong to the tolerant functions; these
here are for numbers that are what they say. A row may be scaled by any positive number: all become integer vectors
without common factor. The compiled kernel lets floats decide what they can for certain (src/certificate.rs has the
bounds and their proof) and does the rest in integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise
from math import lcm

import numpy as np

from fixture_design.arrays import Incidence, Indices, Mask, Rows
from fixture_design.cones.kernel import rational
from fixture_design.cones.kernel.checks import require_finite
from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.double_description import MAX_RAYS
from fixture_design.cones.kernel.rational import Integers, primitive
from fixture_design.cones.kernel.threads import thread_count
from fixture_design.errors import ConeError, DimensionError

#: A number that is what it says: 0.1 as a float is 3602879701896397 / 2^55, as a string or Decimal 1/10.
Rational = int | Fraction | Decimal | str | float


@dataclass(frozen=True, eq=False)
class ExactDescription:
    """Both forms of a cone, exactly.

    Attributes:
        rows: integer vectors without common factor, in the order given.
        lines: reduced echelon basis of the lineality space.
        rays: extreme rays, orthogonal to the lines.
        incidence: shape (k, m), whether row . ray = 0.
        ambient: dimension of the space that the equalities leave.
    """

    rows: tuple[Integers, ...]
    lines: tuple[Integers, ...]
    rays: tuple[Integers, ...]
    incidence: Incidence
    ambient: int


@dataclass(frozen=True, eq=False)
class ExactPartition:
    """Tucker's partition, exactly.

    Attributes:
        balanced: shape (m,), the rows that balance (zero rows do).
        weights: integers, positive on those, zero elsewhere; they balance.
        motion: d_i . motion < 0 for all other rows, 0 for balanced ones; None if there are no others.
        span: reduced echelon basis of what the balanced rows span.
        dimension: d.
    """

    balanced: Mask
    weights: tuple[int, ...]
    motion: Integers | None
    span: tuple[Integers, ...]
    dimension: int

    @property
    def closes(self) -> bool:
        """Whether face{D} is {o}."""
        return len(self.span) == self.dimension


def integer_rows(rows: Sequence[Sequence[Rational]] | np.ndarray, dimension: int) -> list[Integers]:
    """The shortest integer vectors along rational ones.

    Raises:
        DimensionError: rows that are not of length ``dimension``.  ConeError: what is no finite number.
    """
    if isinstance(rows, np.ndarray):
        rows = rows.tolist()
    integers = []
    for index, row in enumerate(rows):
        if len(row) != dimension:
            raise DimensionError(f"row {index} has {len(row)} numbers, where rows of {dimension} go")
        if all(type(value) is int for value in row):
            integers.append(primitive(list(row)))  # pyright: ignore[reportArgumentType]
            continue
        try:
            fractions = [Fraction(value) for value in row]
        except (ValueError, OverflowError, TypeError, ZeroDivisionError) as cause:
            raise ConeError(f"row {index} is not made of rational numbers: {row}") from cause
        scale = lcm(*(value.denominator for value in fractions))
        integers.append(primitive([value.numerator * (scale // value.denominator) for value in fractions]))
    return integers


def exact_double_description(
    rows: Sequence[Sequence[Rational]] | np.ndarray,
    equalities: Sequence[Sequence[Rational]] | np.ndarray = (),
    *,
    dimension: int,
    max_rays: int = MAX_RAYS,
) -> ExactDescription:
    """Both forms of {x : rows . x <= 0, equalities . x = 0}, exactly. No value is near anything: there are no ties.

    Raises:
        DimensionError, ConeError: as `integer_rows`; more than ``max_rays`` extreme rays at some step.

    Example:
        >>> exact_double_description([["-0.1", "0.3"], [0, -1]], dimension=2).rays
        ((1, 0), (3, 1))
    """
    faces, both_ways = integer_rows(rows, dimension), integer_rows(equalities, dimension)
    native = compiled(dimension, len(faces))
    if native is not None:
        lines, rays, incidence, ambient = native.exact_double_description(faces, both_ways, dimension, max_rays)
    else:
        lines, rays, sets, ambient = rational.convert(faces, both_ways, dimension, max_rays)
        incidence = np.array([[bool(on >> k & 1) for k in range(len(faces))] for on in sets], dtype=bool)
        incidence = incidence.reshape(len(rays), len(faces))
    order = sorted(range(len(rays)), key=lambda k: tuple(rays[k]))
    return ExactDescription(
        tuple(faces),
        tuple(map(tuple, lines)),
        tuple(tuple(rays[k]) for k in order),
        incidence[order],
        ambient,
    )


def exact_tucker_partition(rows: Sequence[Sequence[Rational]] | np.ndarray, *, dimension: int) -> ExactPartition:
    """Which rows balance and which motion leaves the others, exactly; errors as `integer_rows`."""
    vectors = integer_rows(rows, dimension)
    native = compiled(dimension)
    if native is not None:
        balanced, weights, motion, span = native.exact_tucker_partition(vectors, dimension)
    else:
        weights, motion, span = rational.partition(vectors, dimension)
        balanced = np.array([weight > 0 for weight in weights], dtype=bool)
    return ExactPartition(
        balanced, tuple(weights), None if motion is None else tuple(motion), tuple(map(tuple, span)), dimension
    )


def exact_closure_sign(rows: Sequence[Sequence[Rational]] | np.ndarray, *, dimension: int) -> int:
    """The sign of s = min over |u| = 1 of max_i d_i . u: 1 closed, -1 some motion leaves all rows, 0 neither.

    Zero rows say nothing; without rows it is -1. Errors as `integer_rows`.
    """
    vectors = [row for row in integer_rows(rows, dimension) if any(row)]
    native = compiled(dimension)
    if native is not None:
        return native.exact_sign(vectors, dimension, True)
    weights, _, span = rational.partition(vectors, dimension)
    return 1 if len(span) == dimension else 0 if any(weights) else -1


def exact_closure_signs(
    rows: Rows, offsets: Indices, indices: Indices | None = None, threads: int | None = None
) -> np.ndarray:
    """`exact_closure_sign` of many sets of float rows, each taken as the number that it is.

    Args:
        rows, offsets, indices, threads: as `closure_tests`.

    Returns:
        shape (n,), int8.
    """
    native = compiled(rows.shape[1])
    if native is not None:
        return native.exact_signs(rows, indices, offsets, True, thread_count(threads))
    require_finite(rows)
    chosen = np.arange(len(rows)) if indices is None else indices
    sets = [rows[chosen[start:end]] for start, end in pairwise(offsets)]
    return np.array([exact_closure_sign(part, dimension=rows.shape[1]) for part in sets], dtype=np.int8)
