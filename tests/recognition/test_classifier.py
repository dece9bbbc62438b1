"""Answers of a classifier: previous states, time, zero forces, weight, axes, joint measurements, bad input."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.recognition import Classifier, Noise, Recogniser, build_classifier
from tests.recognition.graphs import FOUR, subgraph
from tests.recognition.synthetic import configurations, wrench_at


def ids(classifier: Classifier) -> list[str]:
    """Of no contact, apex 3 - facet 5, facet 2 - apex 1, and both apex 4 - facet 7 and facet 2 - apex 1."""
    names = {state.contacts: state.id for state in classifier.states}
    return [names[tuple(sorted(contacts))] for contacts in FOUR]


def forces(graph: ContactStateGraph, classifier: Classifier, state: str, count: int = 10) -> list[np.ndarray]:
    rng = np.random.default_rng(7)
    contacts = classifier.state(state).contacts
    return [wrench_at(q, contacts, 0.1, rng) for q in configurations(graph, graph.state(state), rng, count)]


def test_only_successors_are_asked(graph: ContactStateGraph, four: Classifier) -> None:
    free, on_top, edge, two = ids(four)
    assert set(four.state(free).successors) == {free, on_top, edge, two}
    assert set(four.state(on_top).successors) == {free, on_top}
    assert set(four.recognize([1, 0, 0], previous=on_top).margins) >= {free, on_top}
    for wrench in forces(graph, four, edge):
        answer = four.recognize(wrench, previous=free)
        assert edge in answer.states
        assert set(answer.margins) == set(four.state(free).successors)
        assert answer.expected
        assert (answer.margins[edge] >= 0) == (edge in answer.states)


def test_a_state_that_no_transition_leads_to(graph: ContactStateGraph, four: Classifier) -> None:
    _, on_top, _, two = ids(four)
    (wrench,) = [w for w in forces(graph, four, two) if four.recognize(w).states == (two,)][:1]
    answer = four.recognize(wrench, previous=on_top)
    assert answer.states == (two,)
    assert not answer.expected
    assert answer.state == two


def test_over_time(graph: ContactStateGraph, four: Classifier) -> None:
    free, _, edge, two = ids(four)
    recogniser = Recogniser.start(four, free)
    for name in (edge, two, edge):
        for wrench in forces(graph, four, name, 4):
            recogniser = recogniser.step(wrench)
            assert name in recogniser.possible
            assert recogniser.latest is not None
            assert recogniser.latest.expected
    quiet = recogniser.step(np.zeros(3))
    assert quiet.latest is not None
    assert not quiet.latest.told
    assert set(quiet.possible) == set(four.successors(recogniser.possible))
    nothing = recogniser.step([1e9, 1e9, -1e12])  # fits no state
    assert nothing.possible == recogniser.possible
    assert nothing.latest is not None
    assert nothing.latest.states == ()


def test_scale_and_floor(graph: ContactStateGraph, four: Classifier) -> None:
    edge = ids(four)[2]
    for wrench in forces(graph, four, edge, 5):
        size = np.linalg.norm(wrench)
        one, other = four.recognize(wrench), four.recognize(1000 * wrench)
        assert one.states == other.states
        assert np.allclose(list(one.margins.values()), list(other.margins.values()))
        assert not four.recognize(0.009 * wrench / size).told  # below the floor of 0.01 N


def test_noise_widens(graph: ContactStateGraph, four: Classifier) -> None:
    wider = four.with_noise(Noise(force=0.3))
    rng = np.random.default_rng(0)
    for wrench in rng.normal(size=(40, 3)):
        assert set(four.recognize(wrench).states) <= set(wider.recognize(wrench).states)


@pytest.mark.parametrize("axes", ["fixed", "part"])
def test_a_known_weight(graph: ContactStateGraph, axes: str) -> None:
    """What the robot applies is the contacts' load without the weight; free, it carries the weight."""
    center, mass, down = np.array([0.3, 2.0]), 2.0, np.array([0.0, -9.81])
    four = build_classifier(
        subgraph(graph, FOUR), mass=mass, center=center, gravity=down, axes=axes, discriminants=False
    )  # type: ignore[arg-type]
    rng, worst = np.random.default_rng(1), 0
    for name in ids(four):
        state = graph.state(name)
        qs = state.samples[:8] if not state.contacts else configurations(graph, state, rng, 20)
        for q in qs:
            c, s = np.cos(q[2]), np.sin(q[2])
            R = np.array([[c, -s], [s, c]])
            f, x = mass * down, R @ center
            wrench = wrench_at(q, state.contacts, 0.0, rng) * 20 - [*f, x[0] * f[1] - x[1] * f[0]]
            if axes == "part":
                wrench[:2] = R.T @ wrench[:2]
            worst += name not in four.recognize(wrench).states
    assert worst <= 1
    assert four.recognize(np.zeros(3)).told  # a part that nothing carries is not free
    assert ids(four)[0] not in four.recognize(np.zeros(3)).states


def test_in_the_part_s_axes(graph: ContactStateGraph) -> None:
    four = build_classifier(subgraph(graph, FOUR), axes="part", discriminants=False)
    rng, missed, asked = np.random.default_rng(2), 0, 0
    for name in ids(four)[1:]:
        state = graph.state(name)
        for q in configurations(graph, state, rng, 20):
            c, s = np.cos(q[2]), np.sin(q[2])
            wrench = wrench_at(q, state.contacts, 0.0, rng)
            wrench[:2] = np.array([[c, s], [-s, c]]) @ wrench[:2]
            missed += name not in four.recognize(wrench).states
            asked += 1
    assert asked > 30
    # of four states alone few samples are at their ends: those are in states with more contacts
    assert missed <= 0.05 * asked


def test_jointly(graph: ContactStateGraph, four_jointly: Classifier) -> None:
    """Pairs that hold the loaded contacts stay; a part that moves against the push fits no state."""
    edge = ids(four_jointly)[2]
    rng, held = np.random.default_rng(5), []
    for q in configurations(graph, graph.state(edge), rng, 30):
        wrench = wrench_at(q, graph.state(edge).contacts, 0.0, rng)
        unit = wrench / np.linalg.norm(wrench)
        twist = rng.normal(size=3)
        twist -= (twist @ unit) * unit
        held.append(edge in four_jointly.recognize(wrench, twist).states)
        assert four_jointly.recognize(wrench, twist - 2 * unit).states == ()
        assert edge in four_jointly.recognize(wrench).states  # the force alone
    assert np.mean(held) >= 0.95


def test_displacements_alone(graph: ContactStateGraph) -> None:
    four = build_classifier(subgraph(graph, FOUR), measure="displacement", discriminants=False)
    free, on_top, _, _ = ids(four)
    down = np.array([0.0, -1.0, 0.0])
    assert free in four.recognize(None, down).states
    assert on_top not in four.recognize(None, down).states  # into facet 5
    assert on_top in four.recognize(None, -down).states
    with pytest.raises(InputError, match="needs a twist"):
        four.recognize([1, 0, 0])


@pytest.mark.parametrize(
    ("wrench", "words"),
    [
        ([1.0, 2.0], "3 numbers"),
        ([1.0, np.nan, 0.0], "finite"),
        (None, "needs a wrench"),
    ],
)
def test_measurements_that_are_none(four: Classifier, wrench: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        four.recognize(wrench)  # type: ignore[arg-type]


def test_names_that_are_none(four: Classifier) -> None:
    with pytest.raises(UnknownNameError, match="no state is called 'N99'"):
        four.recognize([1, 0, 0], previous="N99")
    with pytest.raises(UnknownNameError, match="no state is called 'N99'"):
        Recogniser.start(four, ["N99"])


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"friction": -1.0}, "friction"),
        ({"mass": float("nan")}, "mass"),
        ({"center": [1, 2, 3]}, "center"),
        ({"accuracy": 0.0}, "accuracy"),
        ({"edges": 2}, "pyramid"),
    ],
)
def test_numbers_that_cannot_be(graph: ContactStateGraph, keys: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        build_classifier(graph, **keys)
    with pytest.raises(InputError, match="noise bound"):
        Noise(force=-0.1)
