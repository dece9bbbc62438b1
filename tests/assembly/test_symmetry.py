"""Symmetries: how many there are, that they are true, and that the graph found with them is the one without."""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import Assembly, ContactStateGraph, geometry_of, state_graph
from fixture_design.assembly.point_motions import point_motions
from fixture_design.assembly.sorting import sort_configurations, states_of
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.assembly.symmetry_search import symmetries_of
from tests.assembly.parts import FIGURE_14
from tests.assembly.solids import hull, prism
from tests.assembly.test_not_convex import HOLE, PLATE, spatial

FLOOR = {"box": [20, 20, 2], "pose": {"xyz": [0, 0, -1]}}
ABOVE: dict = {"x": [-1, 1], "y": [-1, 1], "z": [0, 2]}
PLAY: dict = {"x": [-0.15, 0.15], "y": [-0.15, 0.15]}


def peg(tmp_path: Path, box: list, **region: object) -> Assembly:
    return spatial({"box": box}, prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE]), **PLAY, **region)


def known(graph: ContactStateGraph) -> tuple[set, set]:
    contacts = {state.id: state.contacts for state in graph.states}
    return set(contacts.values()), {(contacts[edge.tight], contacts[edge.loose]) for edge in graph.transitions}


@pytest.mark.parametrize(
    ("box", "region", "count"),
    [
        ([1, 1, 1], {"z": [-0.4, 0.3]}, 48 * 8 // 2),
        ([1, 1, 3], {"z": [-1.5, 2]}, 16 * 8 // 2),
        ([1, 0.9, 3], {"z": [-1.5, 2]}, 8 * 8 // 2),
        ([1, 1, 1], {"z": [-0.4, 0.3], "rotation": 0.1}, 8),
        ([1, 1, 1], {"z": [-0.4, 0.3], "rotation": "fixed"}, 8),
        ([1, 1, 1], {"z": [-2.4, 0.4]}, 48 * 16 // 2),
    ],
)
def test_a_square_peg_has_as_many_as_both_groups(tmp_path: Path, box: list, region: dict, count: int) -> None:
    """Box and plate, rotations with rotations and mirrors with mirrors; with limited angles only the same of both."""
    geometry = geometry_of(peg(tmp_path, box, **region))
    found = symmetries_of(geometry)
    assert len(found) == count
    np.testing.assert_array_equal(found.pairs[0], np.arange(len(geometry.names)))
    assert len(np.unique(found.pairs, axis=0)) <= count
    q = geometry.random(np.random.default_rng(1), 20)
    for element in range(0, count, 7):
        elements = np.full(len(q), element)
        image = found.moved(elements, q)
        expected = found.permuted(elements, geometry.distances(q))
        np.testing.assert_allclose(geometry.distances(image), expected, atol=1e-9)
        step = np.random.default_rng(2).normal(size=(len(q), 6)) * 0.01
        both = geometry.moved(image, found.displaced(elements, step))
        np.testing.assert_allclose(geometry.between(found.moved(elements, geometry.moved(q, step)), both), 0, atol=1e-9)


def test_what_is_nearly_symmetric_is_not(tmp_path: Path) -> None:
    points = (np.array(list(np.ndindex(2, 2, 2))) - 0.5) * 1.0
    points[7] += [1e-6, 2e-6, 3e-6]
    assembly = spatial(hull(tmp_path / "cube.obj", points), FLOOR, **ABOVE)
    geometry = geometry_of(assembly)
    assert len(symmetries_of(geometry)) < 192


def test_the_plane_has_none() -> None:
    from fixture_design.io import read_assembly  # noqa: PLC0415 - only here

    assert len(symmetries_of(geometry_of(read_assembly(FIGURE_14)))) == 1


def test_a_cube_on_a_plane_with_and_without() -> None:
    assembly = spatial({"box": [1, 1, 1]}, FLOOR, **ABOVE)
    graph = state_graph(assembly, samples=4)
    assert known(graph) == known(state_graph(assembly, samples=4, symmetric=False))
    geometry = geometry_of(assembly)
    for state in graph.states:
        found = sort_configurations(geometry, state.samples)
        assert found.clear.all()
        assert set(states_of(geometry, found.touching)) == {state.contacts}


@pytest.mark.slow
def test_a_peg_that_turns_little_with_and_without(tmp_path: Path) -> None:
    assembly = peg(tmp_path, [1, 1, 1], z=[-0.4, 0.3], rotation=0.1)
    assert known(state_graph(assembly, samples=4)) == known(state_graph(assembly, samples=4, symmetric=False))


def test_an_apex_on_an_edge_goes_up_or_aside() -> None:
    """The lowest corner of a cube on the edge x = 0, z = 0 of a box: over it or beside it, not into its material."""
    step = {"box": [2, 20, 2], "pose": {"xyz": [1, 0, -1]}}
    geometry = geometry_of(spatial({"box": [1, 1, 1]}, step, x=[-2, 2], y=[-2, 2], z=[-1, 2]))
    assert isinstance(geometry, SpatialGeometry)
    q = geometry.random(np.random.default_rng(5), 40)
    lowest = [min(geometry.moving.vertices @ R.T, key=lambda corner: corner[2]) for R in geometry.rotations(q)]
    q[:, :3] = np.array([0.0, 0.1, 0.0]) - np.array(lowest)
    found = sort_configurations(geometry, q)
    assert found.clear.all()
    for k, pairs in enumerate(map(np.flatnonzero, found.touching)):
        assert len(pairs) == 5
        normals = geometry.equations(q[k : k + 1], pairs[None]).face_vectors[0, :, :3]
        (motions,) = point_motions(geometry, q[k], pairs, normals)
        facets = [place for place, pair in enumerate(pairs) if "facet" in geometry.names[pair]]
        assert len(facets) == 2
        assert len(motions.signs)
        assert not (motions.signs[:, facets] > 0).all(axis=1).any()
        assert not motions.may_keep(np.isin(np.arange(5), facets))
        assert motions.may_keep(np.arange(5) == facets[0])


def test_of_sets_that_are_images_one_is_tried(tmp_path: Path) -> None:
    """As many as there are orbits of pairs of pairs, each with an image of every set in it."""
    symmetries = symmetries_of(geometry_of(peg(tmp_path, [1, 1, 1], z=[-0.4, 0.3])))
    count = symmetries.pairs.shape[1]
    sets = np.column_stack(np.triu_indices(count, 1))
    first = symmetries.first_of_sets(sets)
    images = np.sort(symmetries.pairs[:, sets], axis=-1)
    orbits = {frozenset(map(tuple, images[:, k].tolist())) for k in range(len(sets))}
    assert len(first) == len(orbits) < len(sets) / 20
    assert {tuple(row) for orbit in orbits for row in orbit} == {tuple(row) for row in sets.tolist()}
    assert len({frozenset(map(tuple, images[:, k].tolist())) for k in first}) == len(orbits)
