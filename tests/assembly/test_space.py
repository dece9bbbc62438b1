"""Convex bodies in space: states counted by reason, samples that touch exactly so, transitions that are true ones."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import Assembly, ContactStateGraph, contacts_at, rotations, state_at, state_graph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.io import assembly_from_data
from tests.assembly.solids import hull

FLOOR = {"box": [20, 20, 2], "pose": {"xyz": [0, 0, -1]}}
ABOVE = {"x": [-1, 1], "y": [-1, 1], "z": [0, 2]}


def spatial(moving: dict, *fixed: dict, region: dict | None = None) -> Assembly:
    data: dict = {"schema": "fixture_design/assembly/1", "space": "spatial", "moving": moving, "name": "test"}
    return assembly_from_data(data | {"fixed": list(fixed) or [FLOOR], "region": region or ABOVE}, "test.yaml")


TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]) - 0.25
OCTAHEDRON = 0.6 * np.vstack([np.eye(3), -np.eye(3)])


def check(graph: ContactStateGraph) -> None:
    """Samples touch exactly so, by vertices' heights over the floor; transitions are nested."""
    geometry = geometry_of(graph.assembly)
    vertices = geometry.moving.vertices  # type: ignore[attr-defined]
    for state in graph.states:
        for q in state.samples:
            heights = (vertices @ rotations.matrices(q[None, 3:])[0].T + q[:3])[:, 2]
            assert heights.min() > -1e-7
            low = {f"apex {k + 1}" for k in np.flatnonzero(heights < 1e-7)}
            assert low == {contact.split(" - ")[0] for contact in state.contacts}
            assert state_at(graph.assembly, q).contacts == state.contacts
    for edge in graph.transitions:
        assert set(graph.state(edge.loose).contacts) < set(graph.state(edge.tight).contacts)


def test_a_cube_on_a_plane() -> None:
    """1 + V + E + F states; a transition wherever a vertex, edge or face is part of another, and to no contact."""
    graph = state_graph(spatial({"box": [1, 1, 1]}), samples=4)
    assert sorted(len(state.contacts) for state in graph.states) == [0] + [1] * 8 + [2] * 12 + [4] * 6
    assert len(graph.transitions) == 26 + 24 + 24 + 24
    check(graph)


@pytest.mark.parametrize(("points", "counts"), [(TETRAHEDRON, (4, 6, 4)), (OCTAHEDRON, (6, 12, 8))])
def test_polytopes_on_a_plane(tmp_path: Path, points: np.ndarray, counts: tuple[int, int, int]) -> None:
    graph = state_graph(spatial(hull(tmp_path / "part.obj", points)), samples=4)
    vertices, edges, faces = counts
    assert len(graph.states) == 1 + vertices + edges + faces
    assert len(graph.transitions) == (vertices + edges + faces) + 2 * edges + 2 * 3 * faces
    check(graph)


@pytest.mark.slow
def test_a_random_hull_on_a_plane(tmp_path: Path) -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    points *= 0.7 / np.linalg.norm(points, axis=1, keepdims=True)
    graph = state_graph(spatial(hull(tmp_path / "hull.obj", points)), samples=4)
    assert len(graph.states) == 1 + 20 + 54 + 36
    check(graph)


@pytest.mark.slow
def test_a_square_peg_over_a_square_hole_at_fixed_yaw() -> None:
    """No contact; four walls and four corners of the hole; on top, x beside, along or within the play, and y, but not
    both within: 5 * 5 - 1.
    """
    sides = [
        ([4, 8, 2], [-2.6, 0, -1]),
        ([4, 8, 2], [2.6, 0, -1]),
        ([8, 4, 2], [0, -2.6, -1]),
        ([8, 4, 2], [0, 2.6, -1]),
    ]
    fixed = [{"box": box, "pose": {"xyz": xyz}} for box, xyz in sides]
    region = {"x": [-0.5, 0.5], "y": [-0.5, 0.5], "z": [-0.4, 1.5], "rotation": "fixed"}
    graph = state_graph(spatial({"box": [1, 1, 1]}, *fixed, region=region), samples=4)
    assert len(graph.states) == 1 + 4 + 4 + (5 * 5 - 1)
    for state in graph.states:
        q = state.samples[0]
        assert state_at(graph.assembly, q).admissible
        np.testing.assert_array_equal(q[3:], [1, 0, 0, 0])


def test_gradients_are_derivatives() -> None:
    """Gaps of all kinds of pairs against differences; edges across edges where their lines nearly meet."""
    assembly = spatial({"box": [1, 0.8, 0.6]}, {"box": [1, 1, 1]}, region={"x": [-1, 1], "y": [-1, 1], "z": [-1, 1]})
    geometry = geometry_of(assembly)
    q = geometry.random(np.random.default_rng(1), 20)
    chosen = np.arange(len(geometry.names))[None]
    found = geometry.equations(q, chosen)
    assert found.values.shape[1] == 8 * 6 + 6 * 8 + 12 * 12
    for k in range(6):
        step = np.zeros((len(q), 6))
        step[:, k] = 1e-6
        after = geometry.equations(geometry.moved(q, step), chosen).values[:, :, 0]
        before = geometry.equations(geometry.moved(q, -step), chosen).values[:, :, 0]
        np.testing.assert_allclose((after - before) / 2e-6, found.gradients[:, :, 0, k], atol=1e-6)


def test_overlap_is_that_of_points() -> None:
    """Boxes: no point of a dense grid of one is inside the other where they are apart; some are where they overlap."""
    geometry = geometry_of(spatial({"box": [1, 0.8, 0.6]}, {"box": [1, 1, 1]}, region={**ABOVE, "z": [-1, 1]}))
    q = geometry.random(np.random.default_rng(2), 200)
    depth = geometry.overlap(q)
    grid = (np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 21)] * 3), axis=-1).reshape(-1, 3)) * [1, 0.8, 0.6]
    poses = zip(rotations.matrices(q[:, 3:]), q[:, :3], strict=True)
    inside = np.array([(np.abs(grid @ R.T + p).max(axis=1) < 0.5).any() for R, p in poses])
    assert not inside[depth < 0].any()
    assert inside[depth > 0.1].all()
    assert 20 < (depth > 0.1).sum() < 180


def test_rotations_there_and_back() -> None:
    turns = np.random.default_rng(3).uniform(-1.8, 1.8, size=(50, 3))  # up to pi about an axis
    quaternions = rotations.from_vectors(turns)
    np.testing.assert_allclose(rotations.vectors(quaternions), turns, atol=1e-12)
    both = rotations.product(quaternions[:25], quaternions[25:])
    product = rotations.matrices(quaternions[:25]) @ rotations.matrices(quaternions[25:])
    np.testing.assert_allclose(rotations.matrices(both), product, atol=1e-12)


def test_every_two_features_are_named_apart() -> None:
    geometry = geometry_of(spatial({"box": [1, 1, 1]}, region={"x": [-20, 20], "y": [-20, 20], "z": [-4, 4]}))
    assert len(set(geometry.names)) == len(geometry.names) == 8 * 6 + 6 * 8 + 12 * 12
    assert not any(a == b for a, b in combinations(geometry.names, 2))


@pytest.mark.slow
def test_a_cube_in_a_corner() -> None:
    """Floor and two walls: 1 + 3 * 26 with one of them, 3 * 240 with two, 336 with all three.

    Two orthogonal directions touch a cube in the faces of their signs s and t, and such directions exist if and only if
    the products s_i t_i are all zero or of both signs: 240 pairs. Three: also the third's signs must fit their cross
    product: 336.
    """
    walls = [{"box": [2, 20, 20], "pose": {"xyz": [-1, 0, 0]}}, {"box": [20, 2, 20], "pose": {"xyz": [0, -1, 0]}}]
    region = {"x": [0, 2], "y": [0, 2], "z": [0, 2]}
    graph = state_graph(spatial({"box": [1, 1, 1]}, FLOOR, *walls, region=region), samples=4)
    walls_touched = [len({contact.split(" - ")[1] for contact in state.contacts}) for state in graph.states]
    assert [walls_touched.count(k) for k in range(4)] == [1, 3 * 26, 3 * 240, 336]


def test_distances_are_those_of_the_equations() -> None:
    """All pairs at once, by products of features, against pair by pair; one moving part inclined, edges parallel."""
    assembly = spatial({"box": [1, 0.8, 0.6]}, {"box": [1, 1, 1]}, region={"x": [-1, 1], "y": [-1, 1], "z": [-1, 1]})
    geometry = geometry_of(assembly)
    q = geometry.random(np.random.default_rng(1), 40)
    q[:10, 3:] = [1, 0, 0, 0]
    expected = geometry.equations(q, np.arange(len(geometry.names))[None]).distances
    np.testing.assert_allclose(geometry.distances(q), expected, atol=1e-12)


def test_a_wall_on_the_floor_counts_at_the_rim_of_its_hidden_bottom() -> None:
    """The seated box's lower corners touch the floor and the wall, and the wall's bottom, which pushes nowhere."""
    wall = {"box": [0.02, 0.4, 0.2], "pose": {"xyz": [-0.01, 0, 0.1]}}
    floor = {"box": [0.4, 0.4, 0.02], "pose": {"xyz": [0, 0, -0.01]}}
    region = {"x": [0, 0.1], "y": [-0.1, 0.1], "z": [0, 0.1]}
    assembly = spatial({"box": [0.06, 0.04, 0.03]}, floor, wall, region=region)
    contacts = contacts_at(assembly, [0.03, 0, 0.015, 1, 0, 0, 0])
    normals = {
        tuple(np.sign(contact.point).tolist()): sorted(np.round(n, 9).tolist() for (n,) in contact.clauses)
        for contact in contacts
    }
    down, left = [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]
    assert normals == {
        (-1, -1, -1): [left, down], (-1, 1, -1): [left, down], (-1, -1, 1): [left], (-1, 1, 1): [left],
        (1, -1, -1): [down], (1, 1, -1): [down],
    }  # fmt: skip
