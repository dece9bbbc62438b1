"""Contact state graphs: Figure 14 within 2 s, a cube on a plane within 5 s; cost against the number of features."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import Assembly, ContactStateGraph, Region, state_graph
from fixture_design.io import assembly_from_data, read_assembly
from tests.assembly.parts import FIGURE_14, of_polygons, random_polygon
from tests.assembly.solids import prism
from tests.assembly.test_not_convex import HOLE, PLATE, spatial

CUBE: dict = {
    "schema": "fixture_design/assembly/1",
    "space": "spatial",
    "moving": {"box": [1, 1, 1]},
    "fixed": {"box": [20, 20, 2], "pose": {"xyz": [0, 0, -1]}},
    "region": {"x": [-1, 1], "y": [-1, 1], "z": [0, 2]},
}


@pytest.mark.benchmark(group="states")
def test_figure_14(benchmark) -> None:
    graph: ContactStateGraph = benchmark(state_graph, read_assembly(FIGURE_14))
    assert len(graph.states) == 29


@pytest.mark.benchmark(group="states")
def test_a_cube_on_a_plane(benchmark) -> None:
    graph: ContactStateGraph = benchmark(state_graph, assembly_from_data(CUBE, "cube.yaml"))
    assert len(graph.states) == 27


@pytest.mark.benchmark(group="states")
@pytest.mark.parametrize("vertices", [3, 4, 5])
def test_polygons_with_more_vertices(benchmark, vertices: int) -> None:
    """Two polygons with any orientation: 2 v^2 contact pairs."""
    rng = np.random.default_rng(vertices)
    region = Region(np.array([-3.0, -3.0]), np.array([3.0, 3.0]))
    assembly: Assembly = of_polygons(random_polygon(rng, vertices), random_polygon(rng, vertices, 1.2), region)
    graph: ContactStateGraph = benchmark.pedantic(state_graph, (assembly,), rounds=1)
    assert len(graph.states) > 20


@pytest.mark.benchmark(group="states")
@pytest.mark.parametrize("box", [[1, 1, 1], [1, 1, 0.8], [1, 0.9, 0.8]])
def test_boxes_with_fewer_symmetries(benchmark, box: list) -> None:
    """A box on a plane: the same states, found with 192, 64 and 32 symmetries."""
    assembly = assembly_from_data(CUBE | {"moving": {"box": box}}, "box.yaml")
    graph: ContactStateGraph = benchmark.pedantic(state_graph, (assembly,), rounds=1)
    assert len(graph.states) == 27


@pytest.mark.benchmark(group="states")
@pytest.mark.parametrize("rotation", [0.1, None])
def test_a_cube_over_a_square_hole(benchmark, tmp_path: Path, rotation: float | None) -> None:
    """Turned a little, and at any rotation: 8 s, and 60 s on two processors."""
    plate = prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE])
    region: dict = {"x": [-0.15, 0.15], "y": [-0.15, 0.15], "z": [-0.4, 0.3] if rotation else [-0.9, 0.9]}
    assembly = spatial({"box": [1, 1, 1]}, plate, **region, **({"rotation": rotation} if rotation else {}))
    graph: ContactStateGraph = benchmark.pedantic(state_graph, (assembly,), {"samples": 4}, rounds=1)
    assert len(graph.states) == 161 if rotation else len(graph.states) > 39_000
