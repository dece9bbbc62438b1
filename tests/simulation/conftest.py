"""The peg and hole, its graph, classifier and plan, made once; one simulated insertion that several tests look at."""

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph
from fixture_design.io import read_classifier, read_graph
from fixture_design.recognition import Classifier
from fixture_design.simulation import Outcome, Trial, corner_first, insert
from tests.simulation.peg import KEPT


@pytest.fixture(scope="session")
def peg() -> ContactStateGraph:
    """Kept, since it takes ten seconds with checked shapes, the classifier fifteen; `make_kept` makes both."""
    return read_graph(KEPT / "peg_and_hole.graph.json")


@pytest.fixture(scope="session")
def peg_classifier() -> Classifier:
    return read_classifier(KEPT / "peg_and_hole.classifier.json")


@pytest.fixture(scope="session")
def trial(peg: ContactStateGraph, peg_classifier: Classifier) -> Trial:
    return Trial(corner_first(peg), peg_classifier)


@pytest.fixture(scope="session")
def inserted(trial: Trial) -> Outcome:
    return insert(trial, np.array([0.004, -0.001, 0.03]), seed=1)
