"""Unions of cones: Table 1, (2-37), (2-51), (2-58)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones import (
    ConeUnion,
    PolyhedralConvexCone,
    convert,
    convex_sum,
    dual,
    element,
    union_dual,
    union_element,
    union_interior,
    union_nonzero,
)
from fixture_design.errors import ConeError, DimensionError
from tests import exact
from tests.checks import same_set
from tests.strategies import Vectors, dimensions, vector_sets


@st.composite
def unions(draw: st.DrawFn) -> list[Vectors]:
    d = draw(dimensions())
    return draw(st.lists(vector_sets(d, most=6, both_ways=False), min_size=1, max_size=4))


@given(unions())
def test_the_dual_of_a_union_is_the_dual_of_the_sum_2_37(parts: list[Vectors]):
    found = union_dual(ConeUnion.of(part.as_faces for part in parts))
    expected = dual(convert(convex_sum(*(part.as_faces for part in parts))))
    assert same_set(convert(found), expected)


@given(unions())
def test_the_dual_of_a_union_is_the_intersection_of_the_duals(parts: list[Vectors]):
    """Exactly: its faces are the extreme rays of all the parts together."""
    d = parts[0].dimension
    forms = [exact.extreme(part.rows, dimension=d) for part in parts]
    spans, lines = [row for rays, _ in forms for row in rays], [row for _, both_ways in forms for row in both_ways]
    expected = convert(PolyhedralConvexCone.from_faces(spans, lines, dimension=d))
    assert same_set(convert(union_dual(ConeUnion.of(part.as_faces for part in parts))), expected)


@given(unions())
def test_nonzero_and_interior_are_those_of_some_part(parts: list[Vectors]):
    union = ConeUnion.of(part.as_faces for part in parts)
    assert union_nonzero(union) == (not all(exact.closes(part.rows, part.dimension) for part in parts))
    expected = any(exact.separable([row for row in part.rows if any(row)]) for part in parts)
    assert union_interior(union) == expected


@given(unions(), st.integers(0, 2**32 - 1))
def test_element_is_that_of_some_part(parts: list[Vectors], seed: int):
    vector = np.random.default_rng(seed).integers(-3, 4, size=parts[0].dimension)
    union = ConeUnion.of(part.as_faces for part in parts)
    assert union_element(vector, union) == any(exact.in_faces(vector.tolist(), part.rows) for part in parts)


def test_a_union_is_not_convex():
    axes = ConeUnion.of([PolyhedralConvexCone.from_span([[1, 0]]), PolyhedralConvexCone.from_span([[0, 1]])])
    assert union_element([1, 0], axes)
    assert not union_element([1, 1], axes)
    assert element([-1, -1], union_dual(axes))
    assert not union_interior(axes)


def test_unusable_unions():
    with pytest.raises(ConeError, match="at least one"):
        ConeUnion(())
    with pytest.raises(DimensionError, match=r"\[2, 3\]"):
        ConeUnion.of([PolyhedralConvexCone.whole_space(2), PolyhedralConvexCone.whole_space(3)])
