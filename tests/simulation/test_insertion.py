"""The loop closed: plans, belief, and insertions against fixed compliance."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph
from fixture_design.errors import AssemblyError
from fixture_design.recognition import Classifier
from fixture_design.simulation import (
    Belief,
    Outcome,
    Sample,
    Trial,
    Wanted,
    corner_first,
    insert,
    plan_of,
    straight_down,
)
from fixture_design.simulation.belief import relative
from tests.recognition.graphs import subgraph
from tests.simulation.peg import ROOT, classifier_of, peg_graph


def test_goals_are_in_their_states(trial: Trial) -> None:
    graph = trial.plan.graph
    wanted = [(), ("facet 2 - apex 1", "facet 3 - apex 2"), ("facet 2 - apex 1", "facet 3 - apex 2"),
              ("facet 2 - apex 1",), (), ()]  # fmt: skip
    assert [graph.state(leg.state).contacts for leg in trial.plan.legs] == wanted
    # the corner stands on both edges, which see it under a right angle: |apex 3 - middle of the hole| is half the hole
    x, y, theta = trial.plan.legs[1].goal
    corner = np.array([x - 0.01 * np.cos(theta), y - 0.01 * np.sin(theta)])
    assert np.linalg.norm(corner) == pytest.approx(0.0105)


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        (Wanted((0.0, -0.01, 0.3)), "leg 2: the goal is in another state"),
        (Wanted((0.0, 0.0, 0.0), ("apex 9 - facet 5",)), "leg 2: the assembly has no pair 'apex 9"),
        (Wanted((0.0, 0.0, 0.1), ("apex 3 - facet 5", "apex 4 - facet 5")), "cannot be closed"),
    ],
)
def test_plans_that_cannot_be(peg: ContactStateGraph, wanted: Wanted, words: str) -> None:
    with pytest.raises(AssemblyError, match=words):
        plan_of(peg, [Wanted((0.0, 0.01, 0.0)), wanted])


def test_a_leg_needs_a_way_through_the_graph(peg: ContactStateGraph) -> None:
    """From the left top to the right one with no other state in between: the graph has no such way."""
    left, right = ("apex 3 - facet 5",), ("apex 4 - facet 8",)
    few = subgraph(peg, (left, right))
    legs = [Wanted((-0.02, 0.005, 0.3), left), Wanted((0.02, 0.005, -0.3), right)]
    with pytest.raises(AssemblyError, match="leg 2: the graph has no way"):
        plan_of(few, legs)
    plan_of(peg, legs)  # through no contact it has


def test_a_surprise_takes_the_last_leg_that_expects_it(trial: Trial) -> None:
    graph, plan = trial.plan.graph, trial.plan

    def named(*contacts: str) -> str:
        state = graph.with_contacts(contacts)
        assert state is not None
        return state.id

    assert plan.joining(named("facet 3 - apex 2"), 4) == 3
    assert plan.joining(named("facet 3 - apex 2"), 2) == 2
    assert plan.joining(named("apex 4 - facet 8"), 5) == 0


def test_belief_finds_the_hole_by_its_edges(trial: Trial, peg_classifier: Classifier) -> None:
    """A corner that is turned while it stands on both edges: the hole is where the corner was, and turned as it was."""
    graph, shift = trial.plan.graph, np.array([0.006, -0.001, 0.02])
    rng = np.random.default_rng(0)
    belief = Belief.start(graph, peg_classifier, [0.007, 0.0012, 0.03], rng)
    both = graph.with_contacts(("facet 2 - apex 1", "facet 3 - apex 2"))
    assert both is not None
    # told no more than that: one of three states
    possible = tuple(
        state.id for state in graph.states
        if state.contacts in {both.contacts, ("facet 3 - apex 2",), ("facet 2 - apex 1",)}
    )  # fmt: skip
    found = None
    for theta in np.linspace(0.5, 0.33, 60):
        corner = 0.0105 * np.array([-np.cos(2 * theta), -np.sin(2 * theta)])
        q = np.array([corner[0] + 0.01 * np.cos(theta), corner[1] + 0.01 * np.sin(theta), theta])
        wrench = np.array([-4.0, -7.0, -0.03])
        found = belief.after(_placed(shift, q), wrench, possible, rng)
        belief = found.belief
    assert found is not None
    assert np.abs(found.shift - shift)[:2].max() < 1e-3
    assert abs(found.shift[2] - shift[2]) < 0.03


def test_nothing_is_believed_where_the_part_has_been(trial: Trial, peg_classifier: Classifier) -> None:
    """Without any contact: the hole is not where a block would be in the part."""
    graph, rng = trial.plan.graph, np.random.default_rng(1)
    belief = Belief.start(graph, peg_classifier, [0.007, 0.0012, 0.03], rng)
    pose = np.array([0.0, -0.02, 0.0])  # deep in where a hole without errors is
    for _ in range(30):
        belief = belief.after(pose, np.zeros(3), graph_ids(graph), rng).belief
    assert abs(belief.weights @ belief.shifts[:, 0]) < 7e-4


def graph_ids(graph: ContactStateGraph) -> tuple[str, ...]:
    return tuple(state.id for state in graph.states)


def test_the_truth_is_nowhere_in_what_a_controller_is_told() -> None:
    assert set(Sample.__dataclass_fields__) == {"time", "pose", "velocity", "wrench", "possible"}


def test_an_insertion_ends_deep_in_the_hole(inserted: Outcome) -> None:
    assert inserted.inserted is not None
    assert inserted.inserted < 12.0
    x, y, theta = inserted.run.true_final
    assert y <= -0.02
    assert abs(x) < 1e-3
    assert abs(theta) < 0.06


def test_closed_loop_against_fixed_compliance() -> None:
    """The loop gets in everywhere, the others do not."""
    command = [sys.executable, "-m", "tests.simulation.few_insertions"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    assert None not in found["closed_loop"]
    assert found["straight_down"].count(None) >= 3
    assert found["without_looking"].count(None) >= 2


def _placed(frame: np.ndarray, q: np.ndarray) -> np.ndarray:
    """X_WP of X_WF and X_FP: what `relative` takes back."""
    c, s = np.cos(frame[2]), np.sin(frame[2])
    pose = np.array([frame[0] + c * q[0] - s * q[1], frame[1] + s * q[0] + c * q[1], frame[2] + q[2]])
    np.testing.assert_allclose(relative(frame, pose), q, atol=1e-12)
    return pose


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_a_hundred_insertions() -> None:
    """The README's table, with the same start errors."""
    graph = peg_graph()
    trial = Trial(corner_first(graph), classifier_of(graph))
    shifts = trial.shifts(100, 7)
    looped = [insert(trial, shift, seed).inserted for seed, shift in enumerate(shifts)]
    fixed = [insert(trial, shift, seed, straight_down).inserted for seed, shift in enumerate(shifts)]
    assert 100 - looped.count(None) >= 95
    assert fixed.count(None) > looped.count(None)
