"""Makes what the tests of simulations keep: graph, classifier, logs. `python -m tests.simulation.make_kept`."""

from __future__ import annotations

import numpy as np

from fixture_design.io import write_classifier, write_graph, write_log
from fixture_design.recognition import Log
from fixture_design.simulation import Trial, corner_first, insert
from tests.simulation.peg import KEPT, classifier_of, peg_graph

#: Where the hole was [m, m, rad]; the corner misses the second one.
SHIFTS = {"insertion_1": (0.002, -0.001, -0.045), "insertion_2": (-0.011, 0.001, -0.02)}

if __name__ == "__main__":
    graph = peg_graph(samples=8)
    classifier = classifier_of(graph)
    write_graph(graph, KEPT / "peg_and_hole.graph.json")
    write_classifier(classifier, KEPT / "peg_and_hole.classifier.json")
    trial = Trial(corner_first(graph), classifier)
    for seed, (name, shift) in enumerate(SHIFTS.items()):
        log = insert(trial, np.array(shift), seed).run.log
        assert log.twists is not None
        # six digits are more than any sensor has
        rounded = [np.round(rows, 6) for rows in (log.times, log.wrenches, log.twists)]
        write_log(Log.of(*rounded, log.truth), KEPT / f"{name}.csv")
