"""Contacts of a layout's elements with parts of 1,000 to 50,000 triangles, once they are loaded: a plate with bores.

Twelve elements, so that twelve times the operations per second are contacts per second; beside them Drake's own twelve
signed distances, which nothing here can do without.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from fixture_design.geometry import PartGeometry
from fixture_design.geometry.elements import contacts_of_elements
from fixture_design.layout import (
    Element,
    Layout,
    LineTip,
    PadTip,
    Part,
    PinTip,
    PointTip,
    Pose,
    SoftTip,
    SphereTip,
    Tip,
)
from tests.geometry.parts import circle, prism

Benchmark = Callable[..., Any]

#: About so many triangles: strips a bore, and how often every triangle is cut in four.
SIZES = {1_000: (24, 0), 10_000: (64, 1), 50_000: (80, 2)}
COUNT = 12
RADIUS = 0.004
CENTERS = [(0.02 * i, 0.02 * j) for i in range(1, 6) for j in (1, 2)]
ALONG = np.array([1.0, 0, 0])
TIPS: dict[str, Tip] = {
    "point": PointTip(),
    "ball": SphereTip(0.002),
    "soft": SoftTip(0.002),
    "pad": PadTip(0.003, 0.002, ALONG),
    "line": LineTip(0.003, ALONG),
    "pin": PinTip(2 * RADIUS - 1e-5, 1e-5, "round"),
}


@cache
def plate(size: int) -> PartGeometry:
    """120 mm x 60 mm x 10 mm with ten bores, loaded: what is computed once is there."""
    strips, cuts = SIZES[size]
    outline = [[0.0, 0.0], [0.12, 0.0], [0.12, 0.06], [0.0, 0.06]]
    vertices, faces = prism(outline, 0.01, [circle(RADIUS, strips, center) for center in CENTERS])
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    for _ in range(cuts):
        mesh = mesh.subdivide()
    points = np.array(mesh.vertices)
    for center in CENTERS:
        # what was put in between goes onto the bore
        away = points[:, :2] - center
        distance = np.linalg.norm(away, axis=1, keepdims=True)
        points[:, :2] = np.where(distance < 1.001 * RADIUS, center + away / distance * RADIUS, points[:, :2])
    assert len(mesh.faces) == pytest.approx(size, rel=0.1)
    return PartGeometry("plate", points, np.array(mesh.faces), np.full(len(points), 1e-18))


def layout(tip: str) -> Layout:
    """Twelve elements with one kind of tip, on the top and the bottom between the bores; pins in the bores."""
    rng = np.random.default_rng(1)
    elements = []
    for number in range(COUNT):
        aside = rng.uniform(-0.003, 0.003, 2)
        at, axis = np.array([0.01 + 0.02 * (number % 6) + aside[0], 0.03 + aside[1], 0.01 * (number % 2)]), None
        if tip == "pin":
            at, axis = np.array([*CENTERS[number % len(CENTERS)], 0.004]), np.array([0.0, 0, 1])
        elements.append(Element(f"E{number}", "locator", at, TIPS[tip], axis=axis))
    part = Part("plate", "mesh", Path("plate.stl"), None, 1.0, Pose.identity(3))
    return Layout("plate", part=part, elements=tuple(elements))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.benchmark(group=f"contacts of {COUNT} elements, warm")
def test_contacts(benchmark: Benchmark, tip: str, size: int) -> None:
    geometry, elements = plate(size), layout(tip)
    assert len(contacts_of_elements(elements, geometry).contacts) >= COUNT
    benchmark(contacts_of_elements, elements, geometry)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.benchmark(group=f"contacts of {COUNT} elements, warm")
def test_distances_alone(benchmark: Benchmark, size: int) -> None:
    surface, points = plate(size).surface, [element.at for element in layout("point").elements]
    found = benchmark(lambda: [surface.at(point)[0] for point in points])
    assert np.abs(found).max() < 1e-12
