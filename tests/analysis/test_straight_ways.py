"""The cone of directions: by hand, by brute force over the circle and the sphere, and within errors of normals."""

from __future__ import annotations

import time
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.analysis.straight_ways import MAX_BRANCHES, DirectionCone, direction_cone
from fixture_design.contacts import Contact, Provenance, unit_normal

X, Y, Z = np.eye(3)


def faces(*normals: object) -> list[Contact]:
    """One contact a normal, wherever: points have no say."""
    rng = np.random.default_rng(0)
    rows = [np.asarray(normal, dtype=float) for normal in normals]
    return [Contact.on_facet(f"C{k}", "locator", rng.normal(size=len(n)), n) for k, n in enumerate(rows)]


def rays(cone: DirectionCone) -> list[list[float]]:
    return sorted((row.round(9) + 0.0).tolist() for row in cone.branches[0].spans)


def test_three_two_one_leaves_an_octant() -> None:
    cone = direction_cone(faces(-Z, -Z, -Z, -Y, -Y, -X))
    assert cone.truth is True
    assert rays(cone) == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert len(cone.branches[0].lines) == 0
    np.testing.assert_allclose(cone.first, np.ones(3) / np.sqrt(3))
    assert cone.branches[0].leaving == pytest.approx(1 / np.sqrt(3))
    assert cone.slides(cone.first) == ()


def test_a_vee_block_leaves_a_wedge_along_its_axis() -> None:
    cone = direction_cone(faces([0, 1, -1], [0, 1, -1], [0, -1, -1], [0, -1, -1]))
    assert cone.truth is True
    np.testing.assert_allclose(np.abs(cone.branches[0].lines), [X], atol=1e-15)
    np.testing.assert_allclose(cone.first, Z, atol=1e-15)


def test_a_slot_is_left_by_sliding() -> None:
    cone = direction_cone(faces(-Z, Y, -Y))
    assert cone.truth is True
    np.testing.assert_allclose(cone.first, Z, atol=1e-15)
    assert cone.branches[0].leaving == 0.0
    assert cone.slides(cone.first) == ("C1", "C2")
    assert cone.confining is None


def test_a_shaft_in_a_bore_goes_both_ways_and_up_first() -> None:
    walls = [[np.cos(a), np.sin(a), 0] for a in 2 * np.pi * np.arange(5) / 5]
    cone = direction_cone(faces(*walls))
    assert cone.truth is True
    np.testing.assert_allclose(cone.first, Z, atol=1e-12)
    down = direction_cone(faces(*walls), up=np.array([0.1, 0, -3.0]))
    np.testing.assert_allclose(down.first, -Z, atol=1e-12)
    assert {tuple((c.round(6) + 0.0).tolist()) for c in cone.candidates()} == {(0, 0, 1), (0, 0, -1)}
    assert cone.confining is not None


def test_closed_on_all_sides_is_no_with_weights() -> None:
    cone = direction_cone(faces(-Z, Z, -Y, Y, [-1, 0, 0.5], [1, 0, 0.25]))
    assert cone.truth is False
    assert cone.branches == ()
    (weights,) = cone.weights
    values = np.concatenate([weights[f"C{k}"] for k in range(6)])
    units = np.array([unit_normal(c.normals[0]) for c in cone.contacts])
    assert values.min() >= 0
    assert np.linalg.norm(values @ units) < 1e-12
    assert np.linalg.matrix_rank(units[values > 0]) == 3


def test_no_contacts_leave_every_direction() -> None:
    cone = direction_cone([], plane=2)
    assert cone.truth is True
    np.testing.assert_allclose(cone.first, [0, 1])
    assert {tuple(c.tolist()) for c in cone.candidates()} >= {(1, 0), (-1, 0), (0, 1), (0, -1)}


def test_an_alternative_lets_out_what_the_other_does_not() -> None:
    walls = faces([-1, 0], [0, 1], [0, -1])
    corner = Contact.of("A", "locator", [0, 0], [[[1, 0], [0, 1]]])
    cone = direction_cone([*walls, corner])
    assert cone.truth is True
    np.testing.assert_allclose(cone.first, [1, 0], atol=1e-15)
    shut = direction_cone([*walls, *faces([1, 0])[:1]])
    assert shut.truth is False
    both = direction_cone([*walls, Contact.of("A", "locator", [0, 0], [[[1, 0], [1, 1]]])])
    assert both.truth is False
    assert len(both.weights) == 2


def test_more_branches_than_are_listed() -> None:
    corners = [Contact.of(f"A{k}", "locator", [0, 0, 0], [[[0, 1, -1], [0, -1, -1]]]) for k in range(20)]
    cone = direction_cone(corners)
    assert 2 ** len(corners) > MAX_BRANCHES
    assert cone.truth is True
    assert cone.first is not None
    assert cone.admits(cone.first)


def with_error(contact: Contact, error: float, slips: np.ndarray | None = None) -> Contact:
    provenance = Provenance("fitted", error, None if slips is None else 1e-9)
    return replace(contact, provenance=provenance, slips=() if slips is None else (slips,))


def test_what_only_slides_along_walls_that_are_not_known_is_undecided() -> None:
    base, one, other = faces(-Z, Y, -Y)
    cone = direction_cone([base, with_error(one, 1e-3), other])
    assert cone.truth is None
    assert cone.reason is not None
    assert "C1" in cone.reason
    # the wall is a cylinder along z: wherever its normal points, z moves it along itself
    along = np.array([[0, 0, 1, 0, 0, 0], [0, 0.3, 0, 0, 0, 1.0]])
    cone = direction_cone([base, with_error(one, 1e-3, along), other])
    assert cone.truth is True
    np.testing.assert_allclose(cone.first, Z, atol=1e-15)
    # along x it does not help
    assert not cone.admits(X)


def test_what_leaves_by_more_than_the_errors_is_certain() -> None:
    loose = [with_error(contact, 0.1) for contact in faces(-Z, -Y, -X)]
    assert direction_cone(loose).truth is True
    looser = [with_error(contact, 0.7) for contact in faces(-Z, -Y, -X)]
    assert direction_cone(looser).truth is None
    shut = [with_error(contact, 0.01) for contact in faces(-Z, -Y, -X, [1, 1, 1])]
    assert direction_cone(shut).truth is False


def test_walls_that_close_by_less_than_is_known() -> None:
    """Tapered by 1e-10 rad, which is neither parallel nor not: they still let out along z, exactly."""
    cone = direction_cone(faces([1, 1e-10, 0], [-1, 1e-10, 0], [0, -1, 0]))
    assert cone.truth is True
    assert abs(cone.first @ Z) == pytest.approx(1)


normals = st.lists(st.tuples(*[st.integers(-2, 2)] * 2).filter(any), min_size=1, max_size=5)


@given(st.lists(normals.map(lambda some: some[:2]), min_size=1, max_size=4))
def test_planar_cones_against_every_direction_that_matters(clauses: list[list[tuple[int, int]]]) -> None:
    """Of integer normals the cone has a ray across one of them, exactly: some of these must be admitted, or none is."""
    contacts = [Contact.of(f"C{k}", "locator", [k, 0], [clause]) for k, clause in enumerate(clauses)]
    everywhere = [n for clause in clauses for n in clause]
    across = [np.array(t) for n in everywhere for t in ((-n[1], n[0]), (n[1], -n[0]), n, (-n[0], -n[1]))]
    out = any(all(min(np.dot(n, t) for n in clause) <= 0 for clause in clauses) for t in across)
    cone = direction_cone(contacts)
    assert cone.truth is out
    if out:
        assert cone.first is not None
        assert all(min(unit_normal(np.array(n, float)) @ cone.first for n in clause) <= 1e-12 for clause in clauses)


@pytest.mark.parametrize("seed", range(10))
def test_the_best_direction_beats_all_others(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contacts = faces(*(rng.normal(size=(4, 3)) - 1.5 * Z))
    cone = direction_cone(contacts)
    angles = product(np.linspace(0, np.pi, 60), np.linspace(0, 2 * np.pi, 120))
    sphere = np.array([[np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)] for a, b in angles])
    units = np.array([unit_normal(c.normals[0]) for c in contacts])
    most = float((-(sphere @ units.T)).min(axis=1).max())
    if cone.truth:
        assert cone.leaving(cone.first) >= most - 1e-12
    else:
        assert most < 0


def test_turned_together_they_leave_the_same_way() -> None:
    rng = np.random.default_rng(1)
    for _ in range(10):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        contacts = faces(-Z, [-1, -0.3, 0], [-0.2, -1, 0])
        moved = [replace(c, clauses=((turn @ c.normals[0] * 7.0,),), point=c.point * 1e3) for c in contacts]
        one, other = direction_cone(contacts), direction_cone(moved)
        np.testing.assert_allclose(turn @ one.first, other.first, atol=1e-12)


def test_contacts_alone_take_less_than_a_millisecond() -> None:
    contacts = faces(-Z, -Z, -Z, -Y, -Y, -X)
    direction_cone(contacts)
    start = time.process_time()
    for _ in range(50):
        assert direction_cone(contacts).first is not None
    # while testing, with every array checked, ten times as much
    assert time.process_time() - start < 50 * 1e-2
