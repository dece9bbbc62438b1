"""ELEMENT, SUBSET, INTERIOR, NONZERO against exact arithmetic (2-42 to 2-45)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.cones import PolyhedralConvexCone, convert, element, interior, nonzero, subset
from tests import exact
from tests.strategies import Vectors, dimensions, integer_vectors, vector_sets


def generators(vectors: Vectors) -> list[exact.Vector]:
    return [*vectors.rows, *vectors.both_ways, *[[-v for v in row] for row in vectors.both_ways]]


@st.composite
def vectors_and_one(draw: st.DrawFn) -> tuple[Vectors, tuple[int, ...]]:
    d = draw(dimensions())
    vectors = draw(vector_sets(d))
    one = draw(integer_vectors(d))
    if vectors.rows and draw(st.booleans()):
        chosen = draw(st.lists(st.sampled_from(vectors.rows), min_size=1, max_size=4))
        one = tuple(map(sum, zip(*chosen, strict=True)))
    return vectors, one


@given(vectors_and_one())
def test_element_of_a_span(drawn):
    vectors, one = drawn
    assert element(one, vectors.as_span) == exact.in_cone(one, generators(vectors))


@given(vectors_and_one())
def test_element_of_faces(drawn):
    vectors, one = drawn
    assert element(one, vectors.as_faces) == exact.in_faces(one, vectors.rows, vectors.both_ways)


@given(vectors_and_one(), st.sampled_from([1e-9, 1e9]))
def test_element_does_not_depend_on_scale(drawn, factor: float):
    vectors, one = drawn
    assert element(np.array(one) * factor, vectors.as_span) == element(one, vectors.as_span)


@given(vector_sets())
def test_interior_of_faces(vectors: Vectors):
    """There is one if and only if some motion leaves every non-zero row strictly; equalities leave none."""
    rows = [row for row in vectors.rows if any(row)]
    expected = not any(map(any, vectors.both_ways)) and exact.separable(rows)
    assert interior(vectors.as_faces) == expected


@given(vector_sets())
def test_interior_of_a_span(vectors: Vectors):
    assert interior(vectors.as_span) == (exact.rank(generators(vectors)) == vectors.dimension)


@given(vector_sets())
def test_nonzero_of_faces(vectors: Vectors):
    assert nonzero(vectors.as_faces) == (not exact.closes(generators(vectors), vectors.dimension))


@given(vector_sets())
def test_nonzero_of_a_span(vectors: Vectors):
    assert nonzero(vectors.as_span) == any(map(any, generators(vectors)))


@given(vector_sets())
def test_answers_do_not_depend_on_the_form(vectors: Vectors):
    for cone in (vectors.as_faces, vectors.as_span):
        both = convert(cone)
        for form in (both.face_form, both.span_form):
            only = (
                PolyhedralConvexCone(cone.dimension, face_form=form)
                if form is both.face_form
                else PolyhedralConvexCone(cone.dimension, span_form=form)
            )
            assert interior(only) == interior(cone)
            assert nonzero(only) == nonzero(cone)


@st.composite
def two_sets(draw: st.DrawFn) -> tuple[Vectors, Vectors]:
    d = draw(dimensions())
    return draw(vector_sets(d, most=5)), draw(vector_sets(d, most=5))


@given(two_sets())
def test_subset(drawn):
    inner, outer = drawn
    expected = all(exact.in_cone(vector, generators(outer)) for vector in generators(inner))
    assert subset(inner.as_span, outer.as_span) == expected
    inside = all(exact.in_faces(vector, outer.rows, outer.both_ways) for vector in generators(inner))
    assert subset(inner.as_span, outer.as_faces) == inside


def test_just_outside_is_outside():
    """Ten thousand times the tolerance is not a tie."""
    quadrant = PolyhedralConvexCone.from_span([[1, 0], [0, 1]])
    assert element([1.0, 0.0], quadrant)
    assert not element([1.0, -1e-5], quadrant)
    assert not element([1.0, -1e-5], convert(quadrant))
    assert not subset(PolyhedralConvexCone.from_span([[1.0, -1e-5]]), quadrant)
