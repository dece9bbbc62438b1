"""How much forces tell: against the limit that the true sets set, and against a classifier that learns from samples."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fixture_design.assembly import ContactStateGraph, state_graph
from fixture_design.io import assembly_from_data
from fixture_design.recognition import Classifier, Noise, build_classifier
from tests.recognition.synthetic import Measured, TrueSets, measured, rays_at


def in_answer(classifier: Classifier, samples: list[Measured]) -> float:
    return float(np.mean([some.state in classifier.recognize(some.wrench).states for some in samples]))


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_without_noise_the_answer_is_right_and_near_the_limit(
    apart: ContactStateGraph, friction: float, request: pytest.FixtureRequest
) -> None:
    classifier: Classifier = request.getfixturevalue("with_friction" if friction else "frictionless")
    rng = np.random.default_rng(1)
    samples = measured(apart, rng, 10, friction)
    truth = TrueSets.of(apart, rng, 300, friction)
    assert len(samples) > 180
    assert in_answer(classifier, samples) >= 0.99
    possible = [truth.states(some.wrench) for some in samples]
    limit = np.mean([len(states) for states in possible])
    answers = np.mean([len(classifier.recognize(some.wrench).states) for some in samples])
    assert np.mean([some.state in states for some, states in zip(samples, possible, strict=True)]) > 0.98
    assert answers <= 1.1 * limit, (answers, limit)


def test_with_noise_the_true_state_is_in_the_answer(apart: ContactStateGraph, with_friction: Classifier) -> None:
    samples = measured(apart, np.random.default_rng(2), 15, friction=0.2, noise=0.05)
    # the stated bound is two standard deviations
    assert in_answer(with_friction.with_noise(Noise(force=0.1)), samples) >= 0.95
    assert in_answer(with_friction, samples) < 0.95  # without the bound it is not


def narrower(graph: ContactStateGraph, clearance: float) -> ContactStateGraph:
    """The same parts with the hole's walls nearer to the peg."""
    data = {**graph.assembly.data, "fixed": [dict(body) for body in graph.assembly.data["fixed"]]}
    half = 1.0 + clearance
    data["fixed"][0]["polygon"] = [[-30, -30], [-half, -30], [-half, 0], [-30, 0]]
    data["fixed"][1]["polygon"] = [[half, -30], [30, -30], [30, 0], [half, 0]]
    return state_graph(assembly_from_data(data, "narrower.yaml"), samples=10)


@pytest.mark.slow
def test_against_nearest_neighbours_on_another_clearance(graph: ContactStateGraph) -> None:
    """kNN learns on one clearance and is asked on another one; the classifier knows the new part's geometry.

    One force seldom tells one state. kNN names one all the same, mostly a wrong one; the classifier's answer holds the
    true one and is single only where it is sure, which without the state before is next to never.
    """
    rng = np.random.default_rng(4)
    learned = measured(graph, rng, 100, friction=0.2, noise=0.02)
    other = narrower(graph, 0.2)
    by_contacts = {state.contacts: state.id for state in other.states}
    names = {state.id: by_contacts.get(state.contacts, "none") for state in graph.states}
    tree = cKDTree([_unit(some.wrench) for some in learned])
    kinds = np.array([names[some.state] for some in learned])
    classifier = build_classifier(other, friction=0.2, noise=Noise(force=0.1), discriminants=False)
    asked = measured(other, rng, 40, friction=0.2, noise=0.05)
    neighbours = np.array([most(kinds[tree.query(_unit(some.wrench), k=5)[1]]) for some in asked])
    right = float(np.mean(neighbours == [some.state for some in asked]))
    answers = [classifier.recognize(some.wrench) for some in asked]
    single = [(answer.state, some.state) for answer, some in zip(answers, asked, strict=True) if answer.state]
    inside = float(np.mean([some.state in answer.states for answer, some in zip(answers, asked, strict=True)]))
    guessed = [max(answer.margins, key=lambda name: answer.margins[name]) for answer in answers]
    best = float(np.mean([guess == some.state for guess, some in zip(guessed, asked, strict=True)]))
    size = np.mean([len(answer.states) for answer in answers])
    print(f"kNN right {right:.3f}; answers hold the state {inside:.3f}, size {size:.2f}; best margin right {best:.3f}")
    print(f"single {len(single)} of {len(asked)}, right {sum(name == true for name, true in single)}")
    assert inside >= 0.95
    assert right < 0.5
    assert all(name == true for name, true in single)


def _unit(wrench: np.ndarray) -> np.ndarray:
    return wrench / np.linalg.norm(wrench)


def most(kinds: np.ndarray) -> str:
    names, counts = np.unique(kinds, return_counts=True)
    return str(names[counts.argmax()])


@pytest.mark.slow
def test_force_and_motion_jointly_tell_more(apart: ContactStateGraph) -> None:
    """A motion that keeps the loaded contacts contradicts states where another contact would be in its way."""
    rng = np.random.default_rng(6)
    jointly = build_classifier(apart, measure="both", noise=Noise(0.02, 0.02), accuracy=0.01, discriminants=False)
    alone = build_classifier(apart, noise=Noise(0.02), accuracy=0.01, discriminants=False)
    sizes, held = [], []
    for some in measured(apart, rng, 15):
        kept = rays_at(some.q, apart.state(some.state).contacts, 0.0)
        twist = rng.normal(size=3)
        twist -= twist @ np.linalg.pinv(kept) @ kept  # d . dq = 0
        both = jointly.recognize(some.wrench, twist)
        held.append(some.state in both.states)
        sizes.append((len(both.states), len(alone.recognize(some.wrench).states)))
    with_motion, without = np.mean(sizes, axis=0)
    assert np.mean(held) >= 0.98
    assert with_motion <= 0.95 * without
