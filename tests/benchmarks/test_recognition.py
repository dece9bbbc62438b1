"""Recognition: one sample, and a whole classifier. Measure with: pytest tests/benchmarks --benchmark-enable"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, state_graph
from fixture_design.io import read_assembly
from fixture_design.recognition import Classifier, StateClass, build_classifier
from tests.assembly.parts import FIGURE_14
from tests.recognition.graphs import FOUR, subgraph

#: Goals on two shared cores [s].
FOUR_STATES, SIXTY_STATES, WHOLE_GRAPH = 20e-6, 200e-6, 10.0


@pytest.fixture(scope="module")
def few() -> ContactStateGraph:
    return subgraph(state_graph(read_assembly(FIGURE_14), samples=10), FOUR)


def sixty(classifier: Classifier) -> Classifier:
    """Sixty states, by copies of those of a classifier; each may follow six others."""
    states: list[StateClass] = []
    for number in range(60):
        like = classifier.states[number % len(classifier.states)]
        names = tuple(f"N{(number + k) % 60 + 1}" for k in range(-3, 4))
        states.append(replace(like, id=f"N{number + 1}", successors=names))
    return replace(classifier, states=tuple(states), transitions=())


def within(benchmark, goal: float) -> None:
    if benchmark.enabled:
        assert benchmark.stats.stats.median < goal


@pytest.mark.benchmark(group="recognition")
def test_one_sample_of_four_states(benchmark, few: ContactStateGraph) -> None:
    classifier = build_classifier(few, friction=0.2)
    wrench, before = np.array([0.3, -5.0, 2.0]), classifier.ids[0]
    benchmark(classifier.recognize, wrench, None, before)
    within(benchmark, FOUR_STATES)


@pytest.mark.benchmark(group="recognition")
def test_one_sample_of_sixty_states(benchmark, few: ContactStateGraph) -> None:
    classifier = sixty(build_classifier(few, friction=0.2))
    wrench = np.array([0.3, -5.0, 2.0])
    benchmark(classifier.recognize, wrench)
    within(benchmark, SIXTY_STATES)


@pytest.mark.slow
@pytest.mark.benchmark(group="recognition")
def test_the_whole_graph_with_fifty_samples(benchmark) -> None:
    graph = state_graph(read_assembly(FIGURE_14), samples=50)
    classifier: Classifier = benchmark.pedantic(build_classifier, (graph,), {"friction": 0.2}, rounds=1)
    assert len(classifier.states) == 29
    assert len(classifier.transitions) > 100
    within(benchmark, WHOLE_GRAPH)
