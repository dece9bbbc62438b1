"""REDUCTION and BIDIRECTION (section 2.8; Theorems 4 and 5) against exact linear programs."""

import numpy as np
from hypothesis import given

from fixture_design.cones import PolyhedralConvexCone, bidirectional, convert, dual, reduce
from tests import exact
from tests.checks import is_irreducible
from tests.strategies import Vectors, vector_sets


def whole_numbers(rows: np.ndarray) -> list[list[int]]:
    assert (rows == rows.round()).all()
    return [[int(v) for v in row] for row in rows]


@given(vector_sets())
def test_reduce_is_irreducible_and_changes_nothing(vectors: Vectors):
    reduced = reduce(vectors.as_faces)
    faces, equalities = whole_numbers(reduced.faces), whole_numbers(reduced.equalities)
    assert is_irreducible(faces, equalities)
    d = vectors.dimension
    assert exact.extreme(faces, equalities, dimension=d) == exact.extreme(vectors.rows, vectors.both_ways, dimension=d)


@given(vector_sets())
def test_what_stays_was_given(vectors: Vectors):
    reduced = reduce(vectors.as_span)
    given_rows = {*vectors.rows, *vectors.both_ways}
    assert {tuple(row) for row in whole_numbers(reduced.spans)} <= set(vectors.rows)
    assert {tuple(row) for row in whole_numbers(reduced.lines)} <= given_rows


@given(vector_sets())
def test_both_forms_are_reduced(vectors: Vectors):
    cone = convert(vectors.as_faces)
    reduced = reduce(cone)
    assert len(reduced.spans) == len(cone.spans)
    assert len(reduced.lines) == len(cone.lines)
    smallest, equalities = exact.extreme(
        *exact.extreme(vectors.rows, vectors.both_ways, dimension=vectors.dimension), dimension=vectors.dimension
    )
    assert len(reduced.faces) == len(smallest)
    assert len(reduced.equalities) == len(equalities)


def test_of_two_that_make_each_other_redundant_one_stays():
    """Testing each against all others at once, as (4-16) does, would drop both."""
    reduced = reduce(PolyhedralConvexCone.from_faces([[1, 0], [2, 0], [0, 1]]))
    assert reduced.faces.tolist() == [[1, 0], [0, 1]]


@given(vector_sets())
def test_bidirectional_agrees_with_an_exact_linear_program(vectors: Vectors):
    rows = [*vectors.rows, *vectors.both_ways, *[[-v for v in row] for row in vectors.both_ways]]
    expected = exact.balanced(rows)[: len(vectors.rows)]
    assert bidirectional(vectors.as_faces).tolist() == expected


@given(vector_sets())
def test_bidirectional_rows_vanish_on_the_cone_and_others_do_not(vectors: Vectors):
    rays, lines = exact.extreme(vectors.rows, vectors.both_ways, dimension=vectors.dimension)
    expected = [not any(exact.dot(row, v) for v in [*rays, *lines]) for row in vectors.rows]
    assert bidirectional(vectors.as_faces).tolist() == expected
    assert bidirectional(dual(vectors.as_span)).tolist() == expected
