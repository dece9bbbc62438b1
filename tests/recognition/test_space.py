"""In space: a cube over a plane, its forces, friction pyramids around the cones, and its states told apart."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, state_graph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.rotations import matrices
from fixture_design.io import assembly_from_data
from fixture_design.recognition import build_classifier
from tests.recognition.graphs import subgraph

CUBE: dict = {
    "schema": "fixture_design/assembly/1",
    "space": "spatial",
    "moving": {"box": [1, 1, 1]},
    "fixed": {"box": [20, 20, 2], "pose": {"xyz": [0, 0, -1]}},
    "region": {"x": [-1, 1], "y": [-1, 1], "z": [0, 2], "rotation": 0.5},
}


@pytest.fixture(scope="module")
def cube() -> ContactStateGraph:
    """No contact, a corner, an edge and a face on the plane."""
    graph = state_graph(assembly_from_data(CUBE, "cube.yaml"), samples=12)
    chosen = {len(state.contacts): state.contacts for state in graph.states}
    assert {0, 1, 2, 4} <= set(chosen)
    return subgraph(graph, tuple(chosen[count] for count in (0, 1, 2, 4)))


@pytest.mark.parametrize("friction", [0.0, pytest.param(0.3, marks=pytest.mark.slow)])
def test_forces_of_a_cube_are_in_its_sets(cube: ContactStateGraph, friction: float) -> None:
    classifier = build_classifier(cube, friction=friction, edges=4, accuracy=0.05, discriminants=False)
    rng = np.random.default_rng(0)
    for state in cube.states:
        for q in state.samples if state.contacts else ():
            wrench = on_the_plane(q, len(state.contacts), friction, rng)
            assert state.id in classifier.recognize(wrench).states, state.contacts


def test_up_and_aside_are_told(cube: ContactStateGraph) -> None:
    classifier = build_classifier(cube, friction=0.3, edges=4, interpolation="none", discriminants=False)
    touching = [state.id for state in cube.states if state.contacts]
    for wrench in ([0, 0, 5.0, 0, 0, 0], [5.0, 0, -1.0, 0, 0, 0]):  # pulled off, and beyond friction
        assert not set(classifier.recognize(wrench).states) & set(touching)
    assert len(classifier.recognize([0, 0, -5.0, 0, 0, 0]).states) < len(cube.states)


def on_the_plane(q: np.ndarray, contacts: int, friction: float, rng: np.random.Generator) -> np.ndarray:
    """The lowest corners pushed onto the plane z = 0, with friction within its cone."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    arms = corners @ matrices(q[None, 3:])[0].T
    lowest = np.argsort(arms[:, 2])[:contacts]
    assert np.allclose(arms[lowest, 2] + q[2], 0, atol=1e-6)
    total = np.zeros(6)
    for arm in arms[lowest]:
        angle, slope = rng.uniform(0, 2 * np.pi), friction * rng.uniform()
        force = rng.exponential() * np.array([slope * np.cos(angle), slope * np.sin(angle), -1.0])
        total += [*force, *np.cross(arm, force)]
    return total


def test_contact_points_in_space(cube: ContactStateGraph) -> None:
    """`arms` are where the pairs touch: on the plane."""
    geometry = geometry_of(cube.assembly)
    for state in cube.states:
        if state.contacts:
            chosen = np.array([geometry.names.index(name) for name in state.contacts])[None]
            points = geometry.arms(state.samples, chosen) + state.samples[:, None, :3]
            np.testing.assert_allclose(points[..., 2], 0, atol=1e-9)


def test_a_box_on_stacked_bodies_is_pushed_from_outside_only() -> None:
    """A wall that stands on the floor has a hidden bottom, in whose rim the seated box touches too: it pushes nowhere.

    With the rotation fixed: free, on the floor, at the wall, in the corner.
    """
    data = {
        "schema": "fixture_design/assembly/1",
        "space": "spatial",
        "name": "stacked",
        "moving": {"box": [0.06, 0.04, 0.03]},
        "fixed": [
            {"box": [0.4, 0.4, 0.02], "pose": {"xyz": [0.1, 0.1, -0.01]}},
            {"box": [0.02, 0.4, 0.2], "pose": {"xyz": [-0.01, 0.1, 0.1]}},
        ],
        "region": {"x": [0, 0.08], "y": [0.05, 0.15], "z": [0, 0.06], "rotation": "fixed"},
    }
    graph = state_graph(assembly_from_data(data, "stacked.yaml"), samples=6)
    made = build_classifier(graph, discriminants=False)
    seated = max(made.states, key=lambda state: len(state.contacts))
    for wrench in ([0, 0, -1.0, 0, 0, 0], [-1.0, 0, 0, 0, 0, 0], [-1.0, 0, -1.0, 0, 0, 0]):
        assert seated.id in made.recognize(wrench).states
    for wrench in ([0, 0, 1.0, 0, 0, 0], [1.0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, 0], [-1.0, 0, 0.2, 0, 0, 0]):
        assert seated.id not in made.recognize(wrench).states
    assert seated.measured.widening.force < 0.01
