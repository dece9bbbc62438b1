"""CONVERT: both forms describe one set, and it is the set that exact arithmetic and the thesis's algorithm find."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fixture_design.cones import PolyhedralConvexCone, convert, convert_rows, element, thesis
from tests import exact
from tests.checks import fits, is_irreducible, matches_exact, same_linear_span, same_rays, same_set, unit
from tests.strategies import Vectors, float_rows, seeds, vector_sets


@given(vector_sets())
def test_face_to_span_is_the_exact_double_description(vectors: Vectors):
    rays, lines = exact.extreme(vectors.rows, vectors.both_ways, dimension=vectors.dimension)
    assert matches_exact(convert(vectors.as_faces), rays, lines)


@given(vector_sets())
def test_span_to_face_is_the_exact_double_description(vectors: Vectors):
    faces, equalities = exact.extreme(vectors.rows, vectors.both_ways, dimension=vectors.dimension)
    cone = convert(vectors.as_span)
    assert same_rays(cone.faces, faces)
    assert same_linear_span(cone.equalities, equalities)


@given(vector_sets(most=7))
def test_the_thesis_finds_the_same_cone(vectors: Vectors):
    for cone in (vectors.as_faces, vectors.as_span):
        fast, slow = convert(cone), thesis.convert(cone)
        assert same_set(fast, slow)
        assert len(fast.spans) == len(slow.spans) or cone.face_form is None
        assert len(fast.faces) == len(slow.faces) or cone.span_form is None


@given(vector_sets())
def test_it_keeps_what_was_given_and_stays_as_it_is(vectors: Vectors):
    cone = vectors.as_faces
    both = convert(cone)
    assert both.face_form is cone.face_form
    assert convert(both) is both


@given(vector_sets(), seeds())
def test_elements_are_combinations_and_nothing_else(vectors: Vectors, rng: np.random.Generator):
    cone = convert(vectors.as_faces)
    combination = rng.random(len(cone.spans)) @ cone.spans + rng.normal(size=len(cone.lines)) @ cone.lines
    assert fits(combination[None], cone.lines, cone.faces, cone.equalities) < 1e-9 or not combination.any()
    assert element(combination, PolyhedralConvexCone.from_span(cone.spans, cone.lines, dimension=cone.dimension))
    at_random = [int(v) for v in rng.integers(-3, 4, size=cone.dimension)]
    inside = exact.in_faces(at_random, vectors.rows, vectors.both_ways)
    span = PolyhedralConvexCone.from_span(cone.spans, cone.lines, dimension=cone.dimension)
    assert element(at_random, span) == inside
    assert element(at_random, vectors.as_faces) == inside


@given(vector_sets())
def test_every_new_face_is_tight(vectors: Vectors):
    """A facet of span{..} holds span vectors of rank (dimension of the cone) - 1."""
    cone = convert(vectors.as_span)
    generators = [*vectors.rows, *vectors.both_ways]
    whole = exact.rank(generators)
    for face in unit(cone.faces):
        on = [row for row in generators if abs(np.dot(face, row)) <= 1e-9 * (1 + np.linalg.norm(row))]
        assert exact.rank(on) == whole - 1


@given(vector_sets())
def test_incidence_tells_which_faces_a_ray_lies_on(vectors: Vectors):
    both_ways = np.array(vectors.both_ways, dtype=float).reshape(-1, vectors.dimension)
    found = convert_rows(vectors.array, both_ways)
    assert found.certain
    assert found.incidence.shape == (len(found.vectors), len(vectors.rows))
    products = found.vectors @ vectors.array.T
    on = np.abs(products) <= 1e-9 * np.maximum(1.0, np.linalg.norm(vectors.array, axis=1))
    assert (found.incidence == on).all()


@given(st.sampled_from([2, 3, 6]).flatmap(float_rows))
def test_random_floats_of_any_length(rows: np.ndarray):
    """No exact answer to compare with: converted twice, the cone and its smallest form are the same."""
    cone = convert(PolyhedralConvexCone.from_faces(rows, dimension=rows.shape[1]))
    assert fits(cone.spans, cone.lines, cone.faces, cone.equalities) < 1e-9
    back = convert(PolyhedralConvexCone.from_span(cone.spans, cone.lines, dimension=cone.dimension))
    assert same_set(cone, back)
    again = convert(PolyhedralConvexCone.from_faces(back.faces, back.equalities, dimension=cone.dimension))
    assert same_rays(again.spans, cone.spans)
    assert same_linear_span(again.lines, cone.lines)


@given(vector_sets(), st.randoms(use_true_random=False))
def test_order_and_scale_of_the_rows_do_not_matter(vectors: Vectors, random):
    rows = [np.array(row) * 10.0 ** random.randint(-6, 6) for row in vectors.rows]
    random.shuffle(rows)
    moved = PolyhedralConvexCone.from_faces(rows, vectors.both_ways, dimension=vectors.dimension)
    plain = convert(vectors.as_faces)
    assert same_rays(convert(moved).spans, plain.spans)
    assert same_linear_span(convert(moved).lines, plain.lines)


@settings(max_examples=30)
@given(vector_sets(most=6))
def test_the_exact_route_is_right_too(vectors: Vectors):
    """Its rays satisfy the faces, are irreducible, and convert back to a cone with the same rays."""
    rays, lines = exact.extreme(vectors.rows, vectors.both_ways, dimension=vectors.dimension)
    assert all(exact.in_faces(ray, vectors.rows, vectors.both_ways) for ray in rays)
    assert is_irreducible(rays, lines)
    faces, equalities = exact.extreme(rays, lines, dimension=vectors.dimension)
    assert exact.extreme(faces, equalities, dimension=vectors.dimension) == (rays, lines)
    generators = [*rays, *lines, *[[-v for v in line] for line in lines]]
    both = [*vectors.rows, *vectors.both_ways, *[[-v for v in row] for row in vectors.both_ways]]
    assert all(exact.in_cone(face, both) for face in faces)
    assert all(exact.in_cone(ray, generators) for ray in rays)


def test_known_cones():
    quadrant = convert(PolyhedralConvexCone.from_faces([[-1, 0], [0, -1]]))
    assert same_rays(quadrant.spans, [[1, 0], [0, 1]])
    wedge = convert(PolyhedralConvexCone.from_faces([[0, -1, 0], [-1, 0, 0]]))
    assert same_rays(wedge.spans, [[1, 0, 0], [0, 1, 0]])
    assert same_linear_span(wedge.lines, [[0, 0, 1]])
    line = convert(PolyhedralConvexCone.from_faces([[1, 0], [-1, 0]]))
    assert not len(line.spans)
    assert same_linear_span(line.lines, [[0, 1]])
    cube_corner = convert(PolyhedralConvexCone.from_span([[1, 1, 1], [1, -1, 1], [-1, 1, 1], [-1, -1, 1]]))
    assert same_rays(cube_corner.faces, [[1, 0, -1], [-1, 0, -1], [0, 1, -1], [0, -1, -1]])


@pytest.mark.parametrize(("slope", "certain"), [(0.0, True), (1e-12, True), (1e-9, False), (3e-9, False), (1e-6, True)])
def test_values_in_the_undecided_band_are_said(slope: float, certain: bool) -> None:
    """Two faces that are opposed but for ``slope``: a plane of lines, a wedge, or not to be told apart."""
    rows = np.array([[1.0, 0.0, 0.0], [-1.0, -slope, 0.0]])
    found = convert_rows(rows, np.zeros((0, 3)))
    assert found.certain is certain
    if certain:
        assert len(found.lines) == (2 if slope < 1e-9 else 1)
    assert convert(PolyhedralConvexCone.from_faces(rows)).certain is certain
