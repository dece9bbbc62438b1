"""The class itself: forms kept apart, special cones, and errors that name their cause."""

import numpy as np
import pytest

from fixture_design.cones import PolyhedralConvexCone, convert, element, interior, intersect, nonzero
from fixture_design.errors import ConeError, DimensionError


@pytest.mark.parametrize("d", [2, 3, 6])
def test_the_whole_space_and_the_origin_are_not_mistaken_for_each_other(d):
    whole, origin = PolyhedralConvexCone.whole_space(d), PolyhedralConvexCone.origin(d)
    assert (len(whole.faces), len(whole.equalities), len(whole.spans), len(whole.lines)) == (0, 0, 0, d)
    assert (len(origin.faces), len(origin.equalities), len(origin.spans), len(origin.lines)) == (0, d, 0, 0)
    assert nonzero(whole)
    assert interior(whole)
    assert not nonzero(origin)
    assert not interior(origin)


@pytest.mark.parametrize("d", [2, 3, 6])
def test_no_vectors_at_all(d):
    """Without face vectors a cone is the whole space, without span vectors it is {o}."""
    whole = convert(PolyhedralConvexCone.from_faces([], dimension=d))
    assert len(whole.lines) == d
    assert not len(whole.spans)
    origin = convert(PolyhedralConvexCone.from_span([], dimension=d))
    assert len(origin.equalities) == d
    assert not len(origin.faces)


@pytest.mark.parametrize("d", [2, 3, 6])
def test_zero_vectors_are_ordinary_and_say_nothing(d):
    zeros = np.zeros((2, d))
    assert len(convert(PolyhedralConvexCone.from_faces(zeros)).lines) == d
    assert len(convert(PolyhedralConvexCone.from_span(zeros)).equalities) == d
    assert nonzero(PolyhedralConvexCone.from_faces(zeros))
    assert not nonzero(PolyhedralConvexCone.from_span(zeros))
    assert interior(PolyhedralConvexCone.from_faces(zeros))
    assert element(np.ones(d), PolyhedralConvexCone.from_faces(zeros))
    assert not element(np.ones(d), PolyhedralConvexCone.from_span(zeros))


def test_vectors_keep_the_scale_they_were_given_and_cannot_be_written_to():
    cone = PolyhedralConvexCone.from_faces([[1e-9, 0], [0, 1e9]])
    assert cone.faces.tolist() == [[1e-9, 0], [0, 1e9]]
    with pytest.raises(ValueError, match="read-only"):
        cone.faces[0, 0] = 1.0


def test_a_form_that_was_not_computed_is_an_error_not_an_empty_array():
    with pytest.raises(ConeError, match="convert"):
        _ = PolyhedralConvexCone.from_faces([[1, 0]]).spans
    with pytest.raises(ConeError, match="convert"):
        _ = PolyhedralConvexCone.from_span([[1, 0]]).equalities


@pytest.mark.parametrize("make", [PolyhedralConvexCone.from_faces, PolyhedralConvexCone.from_span])
def test_unusable_vectors(make):
    with pytest.raises(ConeError, match="vector 1 is not finite"):
        make([[1.0, 0.0], [np.nan, 0.0]])
    with pytest.raises(ConeError, match="not finite"):
        make([[1.0, 0.0]], [[np.inf, 0.0]])
    with pytest.raises(DimensionError, match="one length"):
        make([[1.0, 0.0], [1.0]])
    with pytest.raises(DimensionError, match="different lengths"):
        make([[1.0, 0.0]], [[1.0, 0.0, 0.0]])
    with pytest.raises(DimensionError, match="different lengths"):
        make([[1.0, 0.0]], dimension=3)
    with pytest.raises(DimensionError, match="dimension must be given"):
        make([])
    with pytest.raises(DimensionError, match="list of rows"):
        make([1.0, 0.0])


def test_vectors_and_cones_that_do_not_fit():
    plane, space = PolyhedralConvexCone.whole_space(2), PolyhedralConvexCone.whole_space(3)
    with pytest.raises(DimensionError, match=r"\[2, 3\]"):
        intersect(plane, space)
    with pytest.raises(DimensionError, match="R\\^2"):
        element([1.0, 0.0, 0.0], plane)


def test_it_says_which_forms_it_has():
    assert repr(PolyhedralConvexCone.from_faces([[1, 0]])) == "PolyhedralConvexCone(R^2: 1 faces, 0 equalities)"
