"""What contact-state graphs cost against the number of features; prints the README's table.

By hand: `python -m tests.benchmarks.compare_states [SEED]`.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from fixture_design.assembly import Assembly, geometry_of, state_graph
from fixture_design.io import assembly_from_data, read_assembly
from tests.assembly.parts import FIGURE_14
from tests.assembly.solids import prism
from tests.assembly.test_not_convex import HOLE, PLATE, spatial
from tests.benchmarks.test_states import CUBE
from tests.geometry.parts import SHARED

FACTORY = SHARED / "IsaacGymEnvs" / "assets" / "factory" / "mesh" / "factory_insertion"

#: A floor and two walls, and where a cube may be among them.
CORNER: dict = {
    "fixed": [
        CUBE["fixed"],
        {"box": [2, 20, 20], "pose": {"xyz": [-1, 0, 0]}},
        {"box": [20, 2, 20], "pose": {"xyz": [0, -1, 0]}},
    ],
    "region": {"x": [0, 2], "y": [0, 2], "z": [0, 2]},
}


def main(seed: int) -> None:
    print("| assembly | pairs | states | transitions | processor time [s] |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, assembly in _assemblies(Path(folder)):
            pairs = len(geometry_of(assembly).names)
            start = time.process_time()
            graph = state_graph(assembly, samples=4, seed=seed)
            spent = time.process_time() - start
            print(f"| {name} | {pairs} | {len(graph.states)} | {len(graph.transitions)} | {spent:.1f} |", flush=True)


def _assemblies(folder: Path) -> Iterator[tuple[str, Assembly]]:
    yield "Figure 14, in the plane", read_assembly(FIGURE_14)
    yield "cube on a plane", assembly_from_data(CUBE, "cube.yaml")
    region: dict = {"x": [-0.15, 0.15], "y": [-0.15, 0.15], "z": [-0.4, 0.3]}
    plate = prism(folder / "plate.obj", PLATE, -2, 0, [HOLE])
    yield "square peg, not turned", spatial({"box": [1, 1, 1]}, plate, **region, rotation="fixed")
    yield "square peg, 0.1 rad", spatial({"box": [1, 1, 1]}, plate, **region, rotation=0.1)
    if FACTORY.is_dir():
        region = {"x": [-1e-3, 1e-3], "y": [-1e-3, 1e-3], "z": [4e-3, 11e-3]}
        yield "round peg, 0.1 rad", spatial(*_factory("round", "8mm_loose", "8mm_subdiv_3x"), **region, rotation=0.1)
        peg = _factory("rectangular", "8mm_loose_subdiv_3x", "8mm_subdiv_3x")
        yield "rectangular peg, not turned", spatial(*peg, **region, rotation="fixed")
    yield "cube in a corner", assembly_from_data(CUBE | CORNER, "corner.yaml")


def _factory(kind: str, peg: str, hole: str) -> tuple[dict, dict]:
    """IsaacGym's factory parts."""
    first, second = FACTORY / f"factory_{kind}_peg_{peg}.obj", FACTORY / f"factory_{kind}_hole_{hole}.obj"
    return {"mesh": str(first)}, {"mesh": str(second)}


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
