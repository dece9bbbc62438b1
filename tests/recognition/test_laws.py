"""Laws of measurement sets, of Theorem 10 and of discriminants."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from fixture_design.assembly import ContactStateGraph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, convert_both, union_element
from fixture_design.recognition import Classifier, MeasurementSet, build_classifier
from fixture_design.recognition.checking import forces_outside
from fixture_design.recognition.discriminants import Against, discriminants, discriminating, smallest, united
from fixture_design.recognition.measurement import oriented_rows
from fixture_design.recognition.merging import merged, unites
from fixture_design.recognition.sample_cones import Physics, sample_cones
from fixture_design.recognition.signals import Signals
from fixture_design.recognition.simplices import StateEquations
from fixture_design.recognition.state_set import Recipe, state_set
from tests.recognition.synthetic import configurations, contact_of, rays_at, wrench_at


@pytest.fixture(params=[0.0, 0.2])
def classifier(request: pytest.FixtureRequest) -> tuple[Classifier, float]:
    return request.getfixturevalue("with_friction" if request.param else "frictionless"), request.param


def test_a_set_contains_the_forces_of_its_samples(
    apart: ContactStateGraph, classifier: tuple[Classifier, float]
) -> None:
    """And those of the configurations half way between samples that are in the state: plain geometry, no cones."""
    made, friction = classifier
    geometry, rng = geometry_of(apart.assembly), np.random.default_rng(3)
    between = 0
    for state in apart.states:
        if not state.contacts or state.coincident:
            continue
        middles = middles_in(geometry, state.contacts, state.samples, rng)
        between += len(middles)
        for q in [*state.samples, *middles]:
            for wrench in (wrench_at(q, state.contacts, friction, rng), rays_at(q, state.contacts, friction)[0]):
                answer = made.recognize(wrench)
                assert state.id in answer.states, (state.id, q, answer.margins[state.id])
    assert between > 100


def middles_in(geometry, contacts, samples, rng) -> list[np.ndarray]:
    """Half way between two near samples, put onto the contacts again, where that is in the state."""
    equations = StateEquations.of(geometry, contacts)
    pairs = [(i, j) for i, j in combinations(range(len(samples)), 2) if np.linalg.norm(samples[i] - samples[j]) < 0.5]
    if not pairs:
        return []
    starts = np.array([(samples[i] + samples[j]) / 2 for i, j in pairs])
    return list(equations.onto(starts)[0][:30])


def test_contacts_here_are_those_of_the_package(graph: ContactStateGraph) -> None:
    """The tests' own geometry touches where the graph says."""
    for state in graph.states:
        if not state.contacts or state.coincident:
            continue
        for q in state.samples[:3]:
            for name in state.contacts:
                x, _ = contact_of(name, q)
                assert np.isfinite(x).all()


def test_no_contact_holds_nothing(classifier: tuple[Classifier, float]) -> None:
    made, _ = classifier
    rng = np.random.default_rng(0)
    for wrench in rng.normal(size=(50, 3)):
        assert "N1" not in made.recognize(wrench).states
    assert set(made.recognize(np.zeros(3)).states) == set(made.ids)
    assert not made.recognize(np.zeros(3)).told


ROWS = st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=5)


@given(ROWS, ROWS, st.integers(0, 10_000))
def test_theorem_10_changes_no_membership(first: list, second: list, seed: int) -> None:
    cones = [convert_both(PolyhedralConvexCone.from_span(rows, dimension=3)) for rows in (first, second)]
    union, fewer = ConeUnion.of(cones), ConeUnion.of(merged(cones))
    rng = np.random.default_rng(seed)
    weights = rng.exponential(size=(40, len(first) + len(second))) * rng.integers(0, 2, (40, len(first) + len(second)))
    tried = np.vstack([weights @ np.array(first + second, float), rng.normal(size=(20, 3)), first, second])
    for vector in tried:
        assert union_element(vector, union) == union_element(vector, fewer)
    if len(fewer) == 1 and len(cones) == 2:
        assert unites(*cones)


def test_theorem_10_unites_and_refuses() -> None:
    """Figure 21: (a) two sectors side by side, (b) with a gap, (c) crossing without uniting."""
    a, b, apart, beside = (
        convert_both(PolyhedralConvexCone.from_span(rows))
        for rows in ([[1, 0], [1, 1]], [[1, 1], [0, 1]], [[-1, 1], [-1, 0]], [[2, 1], [0, 1]])
    )
    assert unites(a, b)
    assert not unites(a, apart)
    assert unites(a, beside)
    assert len(merged([a, b, beside])) == 1
    crossing = [
        convert_both(PolyhedralConvexCone.from_span(rows))
        for rows in ([[1, 0, 1], [-1, 0, 1], [0, 0.1, 1]], [[0, 1, 1], [0, -1, 1], [0.1, 0, 1]])
    ]
    assert not unites(*crossing)


def test_three_sectors_unite_with_none() -> None:
    """Of three sectors of 120 degrees no two unite, though all three are the plane."""
    angles = np.radians([0, 120, 240, 360])
    rays = np.column_stack([np.cos(angles), np.sin(angles)])
    sectors = [convert_both(PolyhedralConvexCone.from_span(rays[k : k + 2])) for k in range(3)]
    assert len(merged(sectors)) == 3


POSITIVE = st.lists(st.tuples(st.integers(-4, 4), st.integers(-4, 4), st.integers(1, 4)), min_size=3, max_size=6)


@given(POSITIVE, st.lists(POSITIVE, min_size=1, max_size=3), st.integers(0, 10_000))
def test_discriminants_accept_and_reject(first: list, second: list, seed: int) -> None:
    """They accept all of S_i, and reject all of S_j outside of S_i; none of them can be left out; `smallest` is."""
    s_i = MeasurementSet(ConeUnion.of([convert_both(PolyhedralConvexCone.from_span(first))]))
    s_j = MeasurementSet(ConeUnion.of([convert_both(PolyhedralConvexCone.from_span(rows)) for rows in second]))
    rows = oriented_rows(s_i.cones.cones[0])
    (chosen,) = discriminating(s_i, s_j)
    others = [Against.of(cone) for cone in s_j.cones]
    fewest = smallest(rows, others)
    rng = np.random.default_rng(seed)
    for faces in (chosen, fewest):
        inside = rng.exponential(size=(30, len(first))) @ np.array(first, float)
        assert (inside @ rows[list(faces)].T <= 1e-8).all()
        assert all(separates(rows, list(faces), np.array(spans, float)) for spans in second)
    assert len(fewest) <= len(chosen)
    # one cone against one: irreducible
    for spans, other in zip(second, others, strict=True):
        kept = list(discriminants(rows, other))
        for face in kept:
            assert not separates(rows, [k for k in kept if k != face], np.array(spans, float))


@given(POSITIVE, st.lists(POSITIVE, min_size=1, max_size=2))
def test_the_smallest_group_is_the_smallest(first: list, second: list) -> None:
    rows = oriented_rows(convert_both(PolyhedralConvexCone.from_span(first)))
    others = [Against.of(convert_both(PolyhedralConvexCone.from_span(spans))) for spans in second]
    found = smallest(rows, others)
    smaller = combinations(range(len(rows)), len(found) - 1) if found else ()
    for faces in smaller:
        assert not all(separates(rows, list(faces), np.array(spans, float)) for spans in second), faces


def separates(rows: np.ndarray, chosen: list[int], spans: np.ndarray) -> bool:
    """Whether all vectors of span{spans} that pass the chosen rows pass all: a linear program for each other row."""
    spans = spans / np.linalg.norm(spans, axis=1, keepdims=True)
    products = rows @ spans.T
    for k in set(range(len(rows))) - set(chosen):
        found = linprog(
            -products[k],
            A_ub=np.vstack([products[chosen], np.ones(len(spans))]),
            b_ub=[0.0] * len(chosen) + [1.0],
        )
        if -found.fun > 1e-7:
            return False
    return True


def test_an_intersection_of_groups_keeps_their_order() -> None:
    assert united([(3, 1), (), (1, 2)]) == (1, 2, 3)


def test_configurations_of_a_state_are_in_it(graph: ContactStateGraph) -> None:
    state = graph.with_contacts(["facet 2 - apex 1"])
    assert state is not None
    assert len(configurations(graph, state, np.random.default_rng(0), 20)) > 5


def test_a_set_contains_the_displacements_of_fresh_configurations(apart: ContactStateGraph) -> None:
    """A(q) = {dq : d . dq <= 0} by plain geometry: its random twists, and those at its edges, where sets are tight."""
    made = build_classifier(apart, measure="displacement", accuracy=0.02, discriminants=False)
    rng, missed = np.random.default_rng(8), []
    for state in apart.states:
        if not state.contacts:
            continue
        for q in configurations(apart, state, rng, 20):
            rows = np.array([[*n, x[0] * n[1] - x[1] * n[0]] for x, n in (contact_of(c, q) for c in state.contacts)])
            for twist in admissible(rows, rng):
                missed.append(max(0.0, -made.recognize(None, twist).margins[state.id]))
    assert len(missed) > 1000
    # bounds are found on samples: others may be further out, few and by little (10 here; 26 without bounds)
    assert np.count_nonzero(missed) <= 0.005 * len(missed)
    assert max(missed) <= 0.01


def admissible(rows: np.ndarray, rng: np.random.Generator) -> list[np.ndarray]:
    """Twists with rows @ twist <= 0: random ones, and some that keep the first contact, or all of them."""
    found = list(rng.normal(size=(8, 3)))
    for kept in (rows[:1], rows):
        along = np.eye(3) - np.linalg.pinv(kept) @ kept
        if np.linalg.matrix_rank(kept) < 3:
            found += [along @ twist for twist in rng.normal(size=(4, 3))]
    return [twist for twist in found if (rows @ twist <= 1e-12).all() and np.linalg.norm(twist) > 1e-6]


def test_sets_of_coincident_apices_contain_fresh_configurations(graph: ContactStateGraph) -> None:
    """Their cones are found from both wedges; few fresh ones are further out than the bound, and by little."""
    geometry = geometry_of(graph.assembly)
    physics = Physics(0.2, 8, np.zeros(2), np.zeros(2))
    recipe = Recipe(Signals("force", "fixed", 2, geometry.radius), physics, "neighbours", 0.005, 0)
    for state in graph.states:
        if not state.coincident or len(state.contacts) > 4:
            continue
        found = state_set(graph, geometry, state, recipe)
        fresh = geometry.random(np.random.default_rng(99), 400)
        q = StateEquations.of(geometry, state.contacts).onto(fresh)[0]
        cones = sample_cones(geometry, state.contacts, q, False, recipe.signals, physics)
        beyond = forces_outside(found, cones, recipe.signals) - found.widening.force
        assert len(q) > 100
        assert np.count_nonzero(beyond > 1e-9) <= 0.03 * len(q), state.id
        assert beyond.max() <= 0.025, state.id


def test_a_cone_without_faces_is_told_from_nothing() -> None:
    """Sets of displacements: a part in free air may move in every way."""
    none = np.zeros((0, 3))
    half = PolyhedralConvexCone.from_faces(np.array([[1.0, 0.0, 0.0]]))
    assert smallest(none, [Against.of(half)]) == ()
    assert smallest(none, []) == ()
