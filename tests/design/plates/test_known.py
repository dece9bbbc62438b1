"""Cases that a person can count, and input that is none."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.design.plates import Clamp, Plate, best_fixture, enumerate_fixtures, fixture_layout
from fixture_design.errors import GeometryError, InputError, UnknownNameError
from tests.design.plates.polygons import SPECIAL

SQUARE = [[0, 0], [2, 0], [2, 2], [0, 2]]


def test_parallel_edges_alone_locate_nothing() -> None:
    """A strip so long that no locator reaches its ends: any three normals leave it free to slide."""
    assert (
        len(enumerate_fixtures([[0, 0], [20, 0], [20, 1.5], [0, 1.5]], Plate(1.0, 5, 5, 0.25), edge_margin=0.76)) == 0
    )


def test_part_that_no_two_locators_reach_around() -> None:
    assert len(enumerate_fixtures(0.1 * np.array(SPECIAL["square"]), Plate(1.0, 4, 4, 0.25))) == 0


def test_tips_wider_than_their_notch_do_not_reach_into_it() -> None:
    notched = [[0, 0], [3, 0], [3, 3], [1.8, 3], [1.8, 1.5], [1.2, 1.5], [1.2, 3], [0, 3]]
    sharp = enumerate_fixtures(notched, Plate(1.0, 5, 5, 0.1))
    wide = enumerate_fixtures(notched, Plate(1.0, 5, 5, 0.35))
    walls = [3, 4, 5]
    assert np.isin(sharp.edges, walls).any()
    assert len(wide)
    assert not np.isin(wide.edges, walls).any()
    assert not np.isin(wide.clamp_edges, walls).any()


def test_a_square_between_holes_by_hand() -> None:
    """Tips of radius 0.25 on opposite sides of a square of 1.5 are 2 apart, measured square to the sides.

    Two normals of adjacent sides do not hold it, so two tips are on opposite sides, and out of line with each other. If
    the square stands straight, its sides are at 0.25 from columns and rows, and only one column passes through it:
    all tips on opposite sides are in line. So their holes are further apart than 2: sqrt(5) is next, at an angle of
    cos(a) = 2 / sqrt(5) from square, which turns the square as the triangle of sides 3, 4, 5. Each way to do this
    occurs for the four sides to begin with, and mirrored.
    """
    found = enumerate_fixtures(SPECIAL["square with room for tips"], Plate(1.0, 3, 4, 0.25))
    assert len(found) == 4 * 2 * 2
    assert np.allclose(np.sort(np.abs(np.column_stack([np.cos(found.theta), np.sin(found.theta)]))), [0.6, 0.8])
    for edges, holes in zip(found.edges, found.holes, strict=True):
        first, second = next((i, j) for i in range(3) for j in range(3) if edges[j] - edges[i] == 2)
        assert sum((holes[first] - holes[second]) ** 2) == 5
    margins, counts = np.unique(found.margin.round(9), return_counts=True)
    assert len(margins) == 2
    assert (counts == 8).all()


def test_slant_of_the_clamp() -> None:
    """A plunger that may only push square on an edge, and one that may push aslant."""
    part = SPECIAL["parallelogram"]
    square, aslant = (enumerate_fixtures(part, Plate(1.0, 4, 4, 0.2, Clamp(0.2, slant=angle))) for angle in (0.1, 1.2))
    pushes = -np.einsum("ki,ki->k", square.clamp_directions, square.normals[:, 3])
    assert (pushes > np.cos(0.1) - 1e-8).all()
    assert len(square) < len(aslant)


def test_reach_of_the_clamp() -> None:
    """From one hole or another, a plunger with a pitch of travel always has one; with half of it, sometimes."""
    part = SPECIAL["parallelogram"]
    counts = [
        len(enumerate_fixtures(part, Plate(1.0, 4, 4, 0.2, Clamp(0.2, 0.3, end)))) for end in (0.3, 0.8, 1.3, 9.0)
    ]
    assert counts[0] < counts[1] < counts[2] == counts[3]


@pytest.mark.parametrize(
    ("polygon", "says"),
    [
        ([[0, 0], [1, 0]], "three or more"),
        ([[0, 0], [1, 0], [1]], "list of vertices"),
        ([[0, 0], [1, 0], ["a", "b"]], "list of vertices"),
        ([[0, 0], [1, 0], [1, np.nan]], "not finite"),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], "twice"),
        ([[0, 0], [0, 1], [1, 0]], "clockwise"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "not simple"),
        ([[0, 0], [1, 0], [2, 1e-12]], "no area"),
    ],
)
def test_polygons_that_are_none(polygon: list, says: str) -> None:
    with pytest.raises(GeometryError, match=says):
        enumerate_fixtures(polygon, Plate(1.0, 3, 3, 0.1))


def test_plates_that_are_none() -> None:
    for wrong in ((0.0, 3, 3, 0.0), (1.0, 0, 3, 0.1), (1.0, 3, 3, 0.5), (1.0, 3, 3, -0.1), (np.nan, 3, 3, 0.1)):
        with pytest.raises(InputError):
            Plate(*wrong)
    for limits in ((-0.1,), (0.1, 2.0, 1.0), (0.1, 0.0, 1.0, np.pi / 2), (0.1, -1.0), (0.1, 0.0, np.nan)):
        with pytest.raises(InputError):
            Clamp(*limits)
    with pytest.raises(InputError, match="margin"):
        enumerate_fixtures(SQUARE, Plate(1.0, 3, 3, 0.1), edge_margin=-1.0)


def test_choices_that_are_none() -> None:
    none = enumerate_fixtures(SQUARE, Plate(1.0, 2, 2, 0.1))
    with pytest.raises(InputError, match="no fixture"):
        best_fixture(none)
    with pytest.raises(UnknownNameError, match="margin"):
        best_fixture(none, by="beauty")
    with pytest.raises(InputError, match="no such fixture"):
        fixture_layout(none, 0)
