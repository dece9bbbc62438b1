"""Grown edges against shapely, and the annuli that they give."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from fixture_design.design.plates.clearance import plungers_clear, tips_clear
from fixture_design.design.plates.grown_edges import GrownEdges, distances, grown_edges
from fixture_design.design.plates.outline import Outline
from tests.design.plates.polygons import SPECIAL, random_case


def lines_of(grown: GrownEdges) -> list[shapely.LineString]:
    every = np.arange(len(grown.edges))
    ends = zip(grown.centers(every, grown.first), grown.centers(every, grown.last), strict=True)
    return [shapely.LineString(pair) for pair in ends]


@pytest.mark.parametrize("radius", [0.0, 0.3, 1.0])
def test_distances_are_those_of_the_segments(radius: float) -> None:
    """Also where they cross: far out, and in notches."""
    crossing = 0
    for seed in range(20):
        grown = grown_edges(Outline.of(random_case(seed)[0]), radius, 0.0)
        lines = lines_of(grown)
        nearest, farthest = distances(grown)
        for i, one in enumerate(lines):
            for j, other in enumerate(lines):
                assert nearest[i, j] == pytest.approx(one.distance(other), abs=1e-12)
                ends = [np.hypot(*np.subtract(a, b)) for a in one.coords for b in other.coords]
                assert farthest[i, j] == pytest.approx(max(ends))
                crossing += one.crosses(other)
    assert crossing or not radius


def test_grown_edges_are_the_straight_sides_of_the_grown_polygon() -> None:
    grown = grown_edges(Outline.of(SPECIAL["parallelogram"]), 0.4, 0.1)
    border = shapely.Polygon(SPECIAL["parallelogram"]).buffer(0.4, quad_segs=64).exterior
    for edge, line in enumerate(lines_of(grown)):
        assert border.buffer(1e-9).contains(line)
        assert line.length == pytest.approx(Outline.of(SPECIAL["parallelogram"]).lengths[edge] - 0.2)


def test_edges_too_short_for_the_margin_are_left_out() -> None:
    assert grown_edges(Outline.of(SPECIAL["rectangle"]), 0.1, 0.8).edges.tolist() == [0, 2]


def test_clearance_is_that_of_shapely() -> None:
    """Tips and plungers anywhere, with any edge left out; short plungers too."""
    rng = np.random.default_rng(2)
    for seed in range(20):
        outline = Outline.of(random_case(seed)[0])
        count, corners = 200, outline.vertices
        tips = corners.mean(axis=0) + rng.normal(size=(count, 2))
        bases = tips + rng.choice([0, 0.1, 1, 5], size=(count, 1)) * rng.normal(size=(count, 2))
        touched = rng.integers(len(corners), size=count)
        sides = [shapely.LineString(pair) for pair in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
        rest = [shapely.MultiLineString(sides[:edge] + sides[edge + 1 :]) for edge in touched]
        points = [shapely.Point(tip) for tip in tips]
        plungers = [shapely.LineString(pair) for pair in zip(tips, bases, strict=True)]
        radius = 0.2
        expected = [line.distance(point) > radius for line, point in zip(rest, points, strict=True)]
        assert tips_clear(outline, tips, touched, radius).tolist() == expected
        expected = [line.distance(plunger) > radius for line, plunger in zip(rest, plungers, strict=True)]
        found = plungers_clear(outline, tips, bases, touched, radius)
        assert found.tolist() == expected
        assert 0 < sum(expected) < count
