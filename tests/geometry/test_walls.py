"""Walls inside a part made of several solids, and cavities, which are none."""

from __future__ import annotations

import numpy as np

from fixture_design.geometry import PartGeometry
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.walls import is_wall
from tests.geometry.parts import box

Mesh = tuple[np.ndarray, np.ndarray]


def made_of(*meshes: Mesh) -> PartGeometry:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    vertices = np.vstack([vertices for vertices, _ in meshes])
    triangles = np.vstack([triangles + start for (_, triangles), start in zip(meshes, starts, strict=False)])
    return PartGeometry("part", vertices, triangles, np.full(len(vertices), 1e-17))


def cube(side: float, center: object = (0, 0, 0), inside_out: bool = False) -> Mesh:
    vertices, triangles = box(side, side, side)
    return vertices + np.array(center), triangles[:, ::-1] if inside_out else triangles


def at(geometry: PartGeometry, *point: float) -> bool | None:
    p = np.array(point)
    touched = touched_triangles(geometry, p, geometry.on_edge)
    assert len(touched)
    return is_wall(geometry, p, touched)


def test_faces_of_solids_that_overlap() -> None:
    pair = made_of(cube(2), cube(2, (1, 0.3, 0.3)))
    assert at(pair, -1, 0.1, 0.1) is False
    assert at(pair, 2, 0.1, 0.1) is False
    assert at(pair, 1, 0.4, 0.2) is True
    assert at(pair, 0, 0.4, 0.2) is True
    # where the surfaces cross, both have a say
    assert at(pair, 1, -0.7, 0.2) is None


def test_faces_of_solids_that_lie_on_each_other() -> None:
    pair = made_of(cube(2), cube(2, (2, 0, 0)))
    assert at(pair, 1, 0.1, 0.2) is None
    assert at(pair, 3, 0.1, 0.2) is False


def test_a_cavity_is_no_wall() -> None:
    hollow = made_of(cube(4), cube(2, inside_out=True))
    assert at(hollow, 2, 0.1, 0.2) is False
    assert at(hollow, 1, 0.1, 0.2) is False


def test_a_cavity_that_another_solid_fills() -> None:
    filled = made_of(cube(4), cube(2, inside_out=True), cube(3))
    assert at(filled, 1, 0.1, 0.2) is True
    assert at(filled, 1.5, 0.1, 0.2) is True
    assert at(filled, 2, 0.1, 0.2) is False
