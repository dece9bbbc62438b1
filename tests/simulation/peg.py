"""The peg and hole of the simulations, for tests and benchmarks."""

from __future__ import annotations

from pathlib import Path

from fixture_design.assembly import ContactStateGraph, state_graph
from fixture_design.io import assembly_from_data, read_assembly
from fixture_design.recognition import Classifier, Noise, build_classifier

ROOT = Path(__file__).resolve().parents[2]
PEG_AND_HOLE = ROOT / "urdf/peg_and_hole/peg_and_hole.assembly.yaml"
KEPT = Path(__file__).parent / "kept"


def peg_graph(clearance: float = 0.0005, samples: int = 20) -> ContactStateGraph:
    """The graph of a peg of 20 mm in a hole with this clearance on each side [m]."""
    assembly = read_assembly(PEG_AND_HOLE)
    data = {**assembly.data, "fixed": [dict(body) for body in assembly.data["fixed"]]}
    half = 10 + 1000 * clearance  # the file is in millimetres
    data["fixed"][0]["polygon"] = [[-half - 50, -50], [-half, -50], [-half, 0], [-half - 50, 0]]
    data["fixed"][1]["polygon"] = [[half, -50], [half + 50, -50], [half + 50, 0], [half, 0]]
    return state_graph(assembly_from_data(data, "peg_and_hole.yaml"), samples=samples)


def classifier_of(graph: ContactStateGraph) -> Classifier:
    """As the README has it: friction 0.2, twice the sensor's noise, and nothing told by less than a newton."""
    return build_classifier(graph, friction=0.2, noise=Noise(force=0.1, floor=1.0), discriminants=False)
