"""The rows of contacts: their logic, and that neither place nor unit nor length of a normal matters."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import Contact, Provenance, Scale, constraints_of, scale_of
from fixture_design.errors import ContactError, DimensionError
from tests.generated import KINDS, generate_one
from tests.problems import figure_8
from tests.strategies import seeds

OR = (np.array([-1.0, 1.0]), np.array([-1.0, -1.0]))
AND = (np.array([0.0, 1.0]), np.array([1.0, 0.0]))
HERE = np.zeros(2)


def a_layout():
    """A facet, an OR of two and an AND of two."""
    return [
        Contact.on_facet("facet", "locator", [1, 1], [0, 1], friction=0.2),
        Contact("or", "locator", np.array([-2.0, 0.0]), (OR,), friction=0.2),
        Contact("and", "clamp", np.array([0.0, -1.0]), tuple((normal,) for normal in AND)),
    ]


def test_logic_without_friction():
    found = constraints_of(a_layout())
    assert found.rows.shape == (5, 3)
    assert found.alternative.tolist() == [0, 1, 2, 3, 4]
    assert found.clause.tolist() == [0, 1, 1, 2, 3]
    assert found.contact.tolist() == [0, 1, 2, 2]
    assert found.branch_count == 2
    assert found.alternatives_of(1).tolist() == [1, 2]
    assert found.rows_of([0, 2]).tolist() == [0, 2]


def test_logic_with_friction():
    found = constraints_of(a_layout(), with_friction=True)
    assert found.alternative.tolist() == [0, 0, 1, 1, 2, 2, 3, 4]
    assert found.clause.tolist() == [0, 1, 1, 2, 3]
    assert found.rows_of([2]).tolist() == [4, 5]


def test_clause_values_are_min_over_alternatives_of_max_over_rows():
    found = constraints_of(a_layout(), with_friction=True)
    values = found.clause_values(np.array([1.0, 2.0, 5.0, 3.0, -1.0, 4.0, 7.0, -8.0]))
    assert values.tolist() == [2.0, 4.0, 7.0, -8.0]


def test_the_number_of_branches_may_be_astronomical():
    apex = Contact("apex", "locator", HERE, (OR,))
    assert constraints_of([apex] * 100).branch_count == 2**100


@given(st.sampled_from(KINDS), st.integers(0, 10**6), seeds())
def test_rows_do_not_depend_on_place_unit_or_length_of_the_normals(kind, seed, rng):
    contacts = generate_one(kind, 0, seed).contacts[:6]
    width = len(contacts[0].point)
    shift, unit = rng.normal(size=width), 10.0 ** rng.integers(-3, 1)
    spread = scale_of(contacts)
    moved = [
        Contact(
            c.name,
            c.role,
            unit * (c.point + spread.length * shift),
            tuple(tuple(n * 10.0 ** rng.integers(-6, 7) for n in clause) for clause in c.clauses),
            c.friction,
        )
        for c in contacts
    ]
    before, after = constraints_of(contacts), constraints_of(moved)
    same_length = len(contacts) == 1 or spread.length < 1e-9 * np.abs(contacts[0].point).max()
    if not same_length:
        assert after.scale.length == pytest.approx(unit * spread.length, rel=1e-6)
    assert after.rows == pytest.approx(before.rows, abs=1e-12 * (1 + before.scale.offset) * 100)


@given(st.sampled_from(KINDS), st.integers(0, 10**6))
def test_rows_have_unit_normals_and_their_moments_are_about_the_reference(kind, seed):
    contacts = generate_one(kind, 0, seed).contacts
    found = constraints_of(contacts)
    width = len(contacts[0].point)
    assert np.linalg.norm(found.rows[:, :width], axis=1) == pytest.approx(np.ones(len(found.rows)))
    # a point on the normal through the reference has no moment: levers are bounded by the distance over the length
    points = np.array([contacts[found.contact[found.clause[a]]].point for a in found.alternative])
    levers = np.linalg.norm(points - found.scale.reference, axis=1) / found.scale.length
    assert (np.linalg.norm(found.rows[:, width:], axis=1) <= levers + 1e-9).all()


def test_scale_of_a_square_and_of_coinciding_points():
    square = [Contact.on_facet("c", "locator", [x, y], [1, 0]) for x in (9, 11) for y in (4, 6)]
    scale = scale_of(square)
    assert scale.reference.tolist() == [10, 5]
    assert scale.length == pytest.approx(np.sqrt(2))
    assert scale.offset == pytest.approx(np.sqrt(125 / 2))
    alone = scale_of(square[:1] * 3)
    assert alone.length > 0
    assert np.isfinite(constraints_of(square[:1] * 3).rows).all()


def test_a_given_scale_is_used():
    contact = Contact.on_facet("P1", "locator", [3, 1], [0, 2])
    found = constraints_of([contact], Scale(np.array([1.0, 0.0]), 4.0))
    assert found.rows.tolist() == [[0, 1, 0.5]]


def test_a_normal_s_error_becomes_an_error_of_its_row():
    exact = Contact.on_facet("P1", "locator", [0, 0, 0], [0, 0, 1])
    fitted = Contact(
        "P2", "locator", np.array([3.0, 0, 0]), ((np.array([0, 0, 1.0]),),), provenance=Provenance("fitted", 0.01)
    )
    found = constraints_of([exact, fitted], Scale(np.zeros(3), 4.0))
    assert found.errors == pytest.approx([0.0, 0.0125])


def test_the_edges_of_a_friction_cone_are_longer_and_so_are_their_errors():
    normals = ((np.array([0.0, 1.0]),),)
    contact = Contact("P1", "locator", HERE, normals, friction=0.75, provenance=Provenance("fitted", 0.01))
    found = constraints_of([contact], Scale(HERE, 1.0), with_friction=True)
    assert found.errors == pytest.approx([0.0125, 0.0125])


def test_unusable_contacts():
    with pytest.raises(ContactError, match="no contacts"):
        constraints_of([])
    with pytest.raises(DimensionError, match="mixed"):
        constraints_of([*figure_8(("P1",)), Contact.on_facet("S", "locator", [0, 0, 0], [0, 0, 1])])


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"clauses": ()}, ContactError, "no normal"),
        ({"clauses": ((),)}, ContactError, "no normal"),
        ({"clauses": ((np.zeros(2),),)}, ContactError, "zero length"),
        ({"clauses": ((np.array([np.nan, 1]),),)}, ContactError, "normal is not finite"),
        ({"clauses": ((np.ones(3),),)}, DimensionError, "'P1': normal"),
        ({"point": np.array([np.inf, 0])}, ContactError, "point must be finite"),
        ({"point": np.ones(4)}, DimensionError, "2 or 3 coordinates"),
        ({"point": np.ones((2, 2))}, DimensionError, "2 or 3 coordinates"),
        ({"friction": -0.1}, ContactError, "friction must be"),
        ({"friction": np.nan}, ContactError, "friction must be"),
    ],
)
def test_a_contact_that_is_none_says_why(change, error, message):
    usable = {"name": "P1", "role": "locator", "point": HERE, "clauses": ((np.array([0.0, 1.0]),),)}
    assert Contact(**usable).dimension == 3
    with pytest.raises(error, match=message):
        Contact(**usable | change)


def test_a_contact_cannot_be_written_to():
    contact = Contact.on_facet("P1", "locator", [1, 1], [0, 1])
    with pytest.raises(ValueError, match="read-only"):
        contact.point[0] = 2.0
    with pytest.raises(ValueError, match="read-only"):
        contact.normals[0][0] = 2.0
