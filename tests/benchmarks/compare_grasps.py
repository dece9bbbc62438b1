"""How many families of grasps are found for each hand and part, and how many Drake keeps; prints the README's table.

By hand: `python -m tests.benchmarks.compare_grasps [SEED]`. Then how long single grasps take with the repository's own
hands on all parts, seeds 0 to 3.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from fixture_design.geometry import PartGeometry
from fixture_design.grasp import HandModel, Search
from fixture_design.grasp.search import grasp
from fixture_design.layout import Answer, Part
from fixture_design.simulation.grasp_shake import shaken
from tests.benchmarks.test_grasps import PARTS, public_part
from tests.grasp.hands import JAW, PUBLIC, SHARED, THREE, model_of, primitive

HANDS = {"parallel_jaw": JAW, "three_finger": THREE, **{name: SHARED / path for name, path in PUBLIC.items()}}

PRIMITIVES = ("cube", "cylinder", "sphere")


def main(seed: int) -> None:
    parts = {name: primitive(name) for name in PRIMITIVES} | {"featuretype, halved": public_part("featuretype")}
    for name, file in HANDS.items():
        for label, (part, geometry) in parts.items():
            print(f"{name:14}{label:22}{_found_and_kept(model_of(file), part, geometry, seed)}", flush=True)
    parts = {name: primitive(name) for name in PRIMITIVES} | {name: public_part(name) for name in PARTS}
    times, found = [], 0
    for file in (JAW, THREE):
        for part, geometry in parts.values():
            for k in range(4):
                start = time.process_time()
                found += grasp(model_of(file), part, Search(most=1, seed=k), geometry).satisfied is Answer.YES
                times.append(time.process_time() - start)
    spread = f"{min(times):.2f} to {max(times):.2f} s of processor time, median {np.median(times):.2f} s"
    print(f"one grasp: {found} of {len(times)} searches find one, {spread}")


def _found_and_kept(hand: HandModel, part: Part, geometry: PartGeometry, seed: int) -> str:
    start = time.process_time()
    result = grasp(hand, part, Search(seed=seed), geometry)
    spent = time.process_time() - start
    shakes = [shaken(one, geometry) for one in result.grasps if one.closed is Answer.YES]
    kept = [shake for shake in shakes if not isinstance(shake, str) and shake.holds]
    moved = max((shake.moved.max() for shake in kept), default=0.0)
    turned = np.rad2deg(max((shake.turned.max() for shake in kept), default=0.0))
    text = f"{result.satisfied}: {len(shakes)} families in {spent:.1f} s, {len(kept)} kept"
    return f"{text}, moved {1e3 * moved:.2f} mm, {turned:.2f} deg {result.reason or ''}"


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
