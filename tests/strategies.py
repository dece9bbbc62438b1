"""Hypothesis strategies for the vectors of cones in R^2, R^3 and R^6, degenerate ones mixed in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st

from fixture_design.cones import PolyhedralConvexCone

DIMENSIONS = (2, 3, 6)

Integers = tuple[int, ...]


@dataclass(frozen=True)
class Vectors:
    """Integer vectors of one dimension (there may be none): face or span vectors, and both-way ones."""

    dimension: int
    rows: tuple[Integers, ...]
    both_ways: tuple[Integers, ...] = ()

    @property
    def as_faces(self) -> PolyhedralConvexCone:
        return PolyhedralConvexCone.from_faces(self.rows, self.both_ways, dimension=self.dimension)

    @property
    def as_span(self) -> PolyhedralConvexCone:
        return PolyhedralConvexCone.from_span(self.rows, self.both_ways, dimension=self.dimension)

    @property
    def array(self) -> np.ndarray:
        return np.array(self.rows, dtype=float).reshape(-1, self.dimension)


def dimensions() -> st.SearchStrategy[int]:
    return st.sampled_from(DIMENSIONS)


def integer_vectors(dimension: int, size: int = 3) -> st.SearchStrategy[Integers]:
    """Small integers, zeros often: parallel, coplanar and zero vectors come up by themselves."""
    return st.tuples(*[st.integers(-size, size) | st.just(0)] * dimension)


@st.composite
def vector_sets(draw: st.DrawFn, dimension: int | None = None, most: int = 9, both_ways: bool = True) -> Vectors:
    """Rows on a small grid, and then some of: zero vectors, repeats, multiples, opposites, sums, a flat cone, a line,
    the whole space or {o}.
    """
    d = draw(dimensions()) if dimension is None else dimension
    rows = draw(st.lists(integer_vectors(d), max_size=most))
    for change in draw(st.lists(st.sampled_from(_CHANGES), max_size=3)):
        rows = change(draw, rows, d)
    lines = draw(st.lists(integer_vectors(d), max_size=2)) if both_ways and draw(st.booleans()) else []
    return Vectors(d, tuple(map(tuple, rows)), tuple(lines))


def _zero(draw, rows, d):
    return [*rows, (0,) * d]


def _multiple(draw, rows, d):
    factor = draw(st.sampled_from([1, 2, 1000, -1, -3]))
    return [*rows, tuple(factor * v for v in draw(st.sampled_from(rows)))] if rows else rows


def _sum(draw, rows, d):
    return [*rows, tuple(map(sum, zip(*rows[:3], strict=True)))] if rows else rows


def _balancing(draw, rows, d):
    """A row that closes the first few: they become a linear space."""
    chosen = rows[: draw(st.integers(1, 7))]
    return [*rows, tuple(-sum(column) for column in zip(*chosen, strict=True))] if rows else rows


def _flat(draw, rows, d):
    """Everything in one coordinate hyperplane."""
    k = draw(st.integers(0, d - 1))
    return [tuple(0 if i == k else v for i, v in enumerate(row)) for row in rows]


def _shuffled(draw, rows, d):
    return draw(st.permutations(rows))


def _everything(draw, rows, d):
    return rows + [tuple(sign * int(i == k) for i in range(d)) for k in range(d) for sign in (1, -1)]


_CHANGES = (_zero, _multiple, _sum, _balancing, _flat, _shuffled, _everything)


@st.composite
def float_rows(draw: st.DrawFn, dimension: int, least: int = 0, most: int = 12) -> np.ndarray:
    """Random floats from a drawn seed, of lengths from 1e-6 to 1e6 (Hypothesis's own floats are seldom generic)."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(least, most))
    return rng.normal(size=(count, dimension)) * 10.0 ** rng.integers(-6, 7, size=(count, 1))


def seeds() -> st.SearchStrategy[np.random.Generator]:
    return st.integers(0, 2**32 - 1).map(np.random.default_rng)
