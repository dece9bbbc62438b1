"""The laws of section 2.4 as they stand, (2-28) to (2-41), by Hypothesis on exact integer cones."""

from hypothesis import assume, given
from hypothesis import strategies as st

from fixture_design.cones import PolyhedralConvexCone, convert, convex_sum, dual, equal, intersect, subset
from tests import exact
from tests.checks import same_set
from tests.strategies import Vectors, dimensions, vector_sets


@st.composite
def pairs(draw: st.DrawFn) -> tuple[PolyhedralConvexCone, PolyhedralConvexCone]:
    """Two cones of one dimension, each in either form."""
    d = draw(dimensions())
    sets = [draw(vector_sets(d, most=6)) for _ in range(2)]
    first, second = (v.as_faces if draw(st.booleans()) else v.as_span for v in sets)
    return first, second


def both_forms(cone: PolyhedralConvexCone) -> PolyhedralConvexCone:
    """Both forms, each computed from the other one's conversion, not kept as given."""
    known = convert(cone)
    return convert(PolyhedralConvexCone.from_faces(known.faces, known.equalities, dimension=cone.dimension))


@given(vector_sets(), st.booleans())
def test_the_dual_of_the_dual_is_the_cone_2_32(vectors: Vectors, faces: bool):
    cone = vectors.as_faces if faces else vectors.as_span
    again = dual(convert(PolyhedralConvexCone(cone.dimension, dual(convert(cone)).face_form)))
    assert same_set(convert(cone), convert(again))


@given(vector_sets())
def test_the_dual_of_faces_is_the_span_of_the_same_vectors_2_30(vectors: Vectors):
    assert same_set(convert(dual(convert(vectors.as_faces))), convert(vectors.as_span))


@given(vector_sets())
def test_every_product_with_the_dual_is_negative_or_zero_2_28(vectors: Vectors):
    cone, polar = convert(vectors.as_span), convert(dual(convert(vectors.as_span)))
    assert (cone.spans @ polar.spans.T <= 1e-7 * (1 + abs(cone.spans).max(initial=0))).all()


@given(pairs())
def test_the_dual_of_the_intersection_is_the_sum_of_the_duals_2_35(cones):
    a, b = cones
    assert same_set(both_forms(dual(intersect(a, b))), both_forms(convex_sum(dual(a), dual(b))))


@given(pairs())
def test_the_dual_of_the_sum_is_the_intersection_of_the_duals_2_36(cones):
    a, b = cones
    assert same_set(both_forms(dual(convex_sum(a, b))), both_forms(intersect(dual(a), dual(b))))


@given(vector_sets())
def test_a_face_vector_less_makes_no_cone_smaller_2_38(vectors: Vectors):
    assume(vectors.rows)
    fewer = PolyhedralConvexCone.from_faces(vectors.rows[:-1], vectors.both_ways, dimension=vectors.dimension)
    assert subset(vectors.as_faces, fewer)


@given(vector_sets())
def test_a_span_vector_less_makes_no_cone_larger_2_39(vectors: Vectors):
    assume(vectors.rows)
    fewer = PolyhedralConvexCone.from_span(vectors.rows[:-1], vectors.both_ways, dimension=vectors.dimension)
    assert subset(fewer, vectors.as_span)


@given(pairs())
def test_inclusion_turns_round_under_the_dual_2_40(cones):
    a, b = cones
    assert subset(a, b) == subset(dual(b), dual(a))
    assert subset(a, convex_sum(a, b))
    assert subset(intersect(a, b), a)
    assert subset(dual(convex_sum(a, b)), dual(a))


@given(pairs())
def test_cones_are_equal_if_and_only_if_their_duals_are_2_41(cones):
    a, b = cones
    assert equal(a, b) == equal(dual(a), dual(b))
    assert equal(intersect(a, b), intersect(b, a))
    assert equal(a, convex_sum(a, a))


@given(vector_sets(most=6), vector_sets(most=6))
def test_equal_is_what_exact_arithmetic_says(first: Vectors, second: Vectors):
    assume(first.dimension == second.dimension)

    def form(v: Vectors):
        return exact.extreme(v.rows, v.both_ways, dimension=v.dimension)

    assert equal(first.as_faces, second.as_faces) == (form(first) == form(second))
