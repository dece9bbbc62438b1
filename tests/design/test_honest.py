"""No is said where it is proven: near ties, open normals and roles that are not what the search deals out first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.design import Limits, design
from fixture_design.design.hitting import free_motion
from fixture_design.design.near_tie import least_stopped
from fixture_design.layout import Answer, Layout
from fixture_design.tolerances import DEFAULT
from fixture_design.verification import verify
from tests.design.fakes import Fake, Spots, box, shaft, task


def edge_middles(off: float) -> Spots:
    """Two points on each edge of a square, off its middle by so much: they close by about as much."""
    normals = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], dtype=float)
    points = [n + sign * off * np.array([-n[1], n[0]]) for n in normals for sign in (-1, 1)]
    return Spots(np.array(points), np.repeat(normals, 2, axis=0), tuple(f"facet {1 + k // 2}" for k in range(8)))


@pytest.mark.parametrize("off", [1e-9, 1e-8, 1e-7, 1e-6])
def test_near_ties_are_answered_as_verify_does(off: float) -> None:
    spots = edge_middles(off)
    result = design(task(spots, require={"all": ("form_closure",)}), Fake(spots))
    everywhere = tuple(
        Contact(f"C{k}", "clamp", x, ((n,),)) for k, (x, n) in enumerate(zip(spots.points, spots.normals, strict=True))
    )
    sure = verify(Layout("all", "planar", contacts=everywhere, require={"all": ("form_closure",)})).satisfied
    assert sure is not Answer.NO
    assert result.satisfied is sure


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("count", [60, 200])  # by the hull, by programs
def test_the_motion_of_a_tie_is_stopped_by_no_row(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(count, 6))
    rows[:, 0] = np.where(np.arange(count) % 2, 1, -1) * DEFAULT.tie * rng.random(count)
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    motion = free_motion(rows)
    assert motion is not None
    assert (rows @ motion).max() <= DEFAULT.near
    least, closes = least_stopped(rows, DEFAULT)
    assert not closes
    assert (rows @ least).max() <= np.sqrt(6) * (rows @ motion).max() + DEFAULT.zero


def test_a_contact_with_alternatives_may_notice_what_no_candidate_does() -> None:
    spots = shaft(30)
    choice = (np.array([0.6, 0.8, 0.0]), np.array([0.8, 0.6, 0.0]))
    start = Layout("start", contacts=(Contact("G", "locator", np.array([0.3, 0.0, 0.0]), (choice,)),))
    asked = task(spots, require={"locators": ("deterministic",)})
    assert design(asked, Fake(spots)).satisfied is Answer.NO
    assert design(replace(asked, start=start), Fake(spots)).satisfied is Answer.UNDECIDED


@pytest.mark.parametrize(
    ("limits", "answer"),
    [
        ({"locators": 4, "clamps": 3}, Answer.YES),
        ({"locators": 6}, Answer.YES),
        ({"locators": 3, "clamps": 3}, Answer.NO),
    ],
)
def test_roles_are_dealt_out_within_the_limits(limits: Mapping[str, int], answer: Answer) -> None:
    spots = box(8)
    result = design(task(spots, require={"all": ("form_closure",)}, limits=Limits(**limits)), Fake(spots))
    assert result.satisfied is answer
    if result.layout is None:
        assert result.bound is not None
        assert result.bound.found is None
    else:
        roles = [element.role for element in result.layout.elements]
        assert roles.count("locator") <= limits["locators"]
