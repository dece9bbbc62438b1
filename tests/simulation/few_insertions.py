"""Five insertions by each way, as JSON: in a process of its own, where shapes are not checked at every step."""

from __future__ import annotations

import json

import numpy as np

from fixture_design.io import read_classifier, read_graph
from fixture_design.simulation import Trial, closed_loop, corner_first, insert, straight_down, without_looking
from tests.simulation.peg import KEPT

#: Where the hole is [m, m, rad]; twice off by more than its half, so that the corner lands beside it.
SHIFTS = (
    (0.006, 0.001, 0.02),
    (-0.005, -0.001, -0.03),
    (0.0115, 0.0, 0.02),
    (-0.0115, 0.001, 0.0),
    (0.002, 0.002, -0.05),
)

if __name__ == "__main__":
    graph = read_graph(KEPT / "peg_and_hole.graph.json")
    trial = Trial(corner_first(graph), read_classifier(KEPT / "peg_and_hole.classifier.json"), duration=12.0)
    found = {
        maker.__name__: [insert(trial, np.array(shift), seed, maker).inserted for seed, shift in enumerate(SHIFTS)]
        for maker in (closed_loop, straight_down, without_looking)
    }
    print(json.dumps(found))
