"""Edges that a mesh cuts to pieces: one again where they are straight, and contacts are those of the uncut solid."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from fixture_design.geometry import PartGeometry
from fixture_design.geometry.bodies import touches_between
from fixture_design.geometry.features import Features
from fixture_design.geometry.straight import straight_edges
from tests.geometry.parts import box, l_shape
from tests.geometry.solids import turn
from tests.geometry.test_bodies_truth import KINDS

GAP = 1e-7


def cut(geometry: PartGeometry, times: int) -> PartGeometry:
    """The same solid, every triangle cut in four again and again."""
    mesh = trimesh.Trimesh(geometry.vertices, geometry.triangles, process=False)
    for _ in range(times):
        mesh = mesh.subdivide()
    vertices = np.array(mesh.vertices)
    return PartGeometry(geometry.name, vertices, np.array(mesh.faces), np.full(len(vertices), 1e-16))


def solid(mesh: tuple[np.ndarray, np.ndarray]) -> PartGeometry:
    return PartGeometry("solid", mesh[0], mesh[1], np.full(len(mesh[0]), 1e-16))


@pytest.mark.parametrize(("mesh", "edges"), [(box(0.03, 0.02, 0.01), 12), (l_shape(), 18)])
def test_a_cut_solid_has_its_edges_again(mesh: tuple[np.ndarray, np.ndarray], edges: int) -> None:
    rotation = turn([1, 2, 3], 0.7)
    found = Features(cut(solid((mesh[0] @ rotation.T, mesh[1])), 3)).edges
    assert len(found) == edges
    whole = Features(solid((mesh[0] @ rotation.T, mesh[1]))).edges
    lengths, expected = (np.sort(np.linalg.norm(e[:, 1] - e[:, 0], axis=1)) for e in (found, whole))
    assert lengths == pytest.approx(expected, rel=1e-12)


def test_a_bend_ends_an_edge() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0.1, 0]])
    ends, owners = np.array([[0, 1], [1, 2], [2, 3]]), np.tile([0, 1], (3, 1))
    assert straight_edges(ends, owners, points, 1e-6).tolist() == [[0, 2], [2, 3]]


def test_edges_of_other_facets_stay_apart() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    ends = np.array([[0, 1], [1, 2]])
    assert straight_edges(ends, np.array([[0, 1], [0, 2]]), points, 1e-6).tolist() == ends.tolist()


def test_a_way_back_is_no_straight_edge() -> None:
    """The vertex is on the line of both edges, but they lie on each other."""
    points = np.array([[0.0, 0, 0], [2, 0, 0], [1, 0, 0]])
    ends, owners = np.array([[0, 1], [1, 2]]), np.tile([0, 1], (2, 1))
    assert straight_edges(ends, owners, points, 1e-6).tolist() == ends.tolist()


def test_a_slow_curve_stays_as_it_is() -> None:
    """No vertex is off the line between its neighbours by more than the blur, but the middle is far off the whole."""
    angles = np.linspace(0, 0.5, 501)
    points = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(501)])
    ends = np.column_stack([np.arange(500), np.arange(1, 501)])
    assert len(straight_edges(ends, np.tile([0, 1], (500, 1)), points, 1e-6)) == 500


@pytest.mark.parametrize("kind", KINDS)
def test_cutting_a_part_changes_no_contact(kind: str) -> None:
    part, body = KINDS[kind](np.random.default_rng(5))
    mine, theirs = part.geometry("part"), body.geometry("body")
    whole, pieces = (touches_between(Features(one), Features(theirs), GAP) for one in (mine, cut(mine, 2)))
    assert len(whole) == len(pieces) > 0
    points = np.array([touch.point for touch in pieces])
    for touch in whole:
        same = pieces[int(np.linalg.norm(points - touch.point, axis=1).argmin())]
        assert same.point == pytest.approx(touch.point, abs=1e-9)
        assert [len(clause) for clause in same.clauses] == [len(clause) for clause in touch.clauses]
        assert (same.twin is None) == (touch.twin is None)
