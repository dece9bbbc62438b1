"""Figure 14's graph and its classifiers, made once."""

import pytest

from fixture_design.assembly import ContactStateGraph, state_graph
from fixture_design.io import read_assembly
from fixture_design.recognition import Classifier, Noise, build_classifier
from tests.assembly.parts import FIGURE_14
from tests.recognition.graphs import FOUR, subgraph


@pytest.fixture(scope="session")
def graph() -> ContactStateGraph:
    return state_graph(read_assembly(FIGURE_14), samples=10)


@pytest.fixture(scope="session")
def apart(graph: ContactStateGraph) -> ContactStateGraph:
    """The 21 states without coincident apices."""
    return subgraph(graph, tuple(state.contacts for state in graph.states if not state.coincident))


@pytest.fixture(scope="session")
def frictionless(apart: ContactStateGraph) -> Classifier:
    return build_classifier(apart, discriminants=False)


@pytest.fixture(scope="session")
def with_friction(apart: ContactStateGraph) -> Classifier:
    return build_classifier(apart, friction=0.2, discriminants=False)


@pytest.fixture(scope="session")
def four(graph: ContactStateGraph) -> Classifier:
    """The four states of section 4.7, with friction, noise and discriminants."""
    return build_classifier(subgraph(graph, FOUR), friction=0.1, noise=Noise(0.02, 0.02, 0.01))


@pytest.fixture(scope="session")
def four_jointly(graph: ContactStateGraph) -> Classifier:
    return build_classifier(subgraph(graph, FOUR), measure="both", accuracy=0.02)
