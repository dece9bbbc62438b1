"""Soft contacts: the limit surface, its brackets, and known answers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from fixture_design.analysis import Restraint, force_closure, form_closure
from fixture_design.contacts import Contact, contact_edges, friction_edges, torsion_of_patch
from fixture_design.errors import ContactError
from fixture_design.layout import Answer, Group, Motion
from fixture_design.verification.checker import check_group
from fixture_design.verification.verify import group_verdict

C = torsion_of_patch(0.006)


def soft(name: str, point: object, normal: object, friction: float = 0.3, torsion: float = C) -> Contact:
    return replace(Contact.on_facet(name, "finger", point, normal, friction), torsion=torsion)


def test_uniform_pressure_by_the_integral() -> None:
    radii = (np.arange(20000) + 0.5) / 20000 * 0.006
    pressure = 1.0 / (np.pi * 0.006**2)
    moment = (pressure * radii * 2 * np.pi * radii).sum() * (radii[1] - radii[0])
    assert torsion_of_patch(0.006) == pytest.approx(moment, rel=1e-6)


@pytest.mark.parametrize("edges", [8, 16, 32])
def test_brackets_lie_inside_and_outside_of_the_ellipsoid(edges: int) -> None:
    normal = np.array([1.0, -2, 0.5])
    unit = normal / np.linalg.norm(normal)
    scaled = {}
    for side in ("inner", "outer"):
        forces, moments = contact_edges(normal, 0.3, C, edges, side)
        np.testing.assert_allclose(forces @ unit, 1)
        np.testing.assert_allclose(np.cross(moments, unit), 0, atol=1e-15)
        tangential = forces - unit
        first = np.cross(unit, [0, 0, 1.0]) / np.linalg.norm(np.cross(unit, [0, 0, 1.0]))
        flat = np.column_stack([tangential @ first, tangential @ np.cross(unit, first)]) / 0.3
        scaled[side] = np.column_stack([flat, moments @ unit / (0.3 * C)])
    np.testing.assert_allclose(np.linalg.norm(scaled["inner"], axis=1), 1)
    # every face of the outer hull keeps the unit ball inside, and one touches it
    assert -ConvexHull(scaled["outer"]).equations[:, 3].max() == pytest.approx(1.0)
    assert len(scaled["inner"]) == len(scaled["outer"]) < edges**2


def test_without_friction_or_torsion_it_is_a_point() -> None:
    normal = np.array([0.0, 0, 2])
    for friction, torsion in ((0.3, 0.0), (0.0, C)):
        forces, moments = contact_edges(normal, friction, torsion)
        np.testing.assert_array_equal(forces, friction_edges(normal, friction))
        assert not moments.any()
    assert contact_edges(np.array([0.0, 1]), 0.3, 0.0)[1].shape == (2, 1)


def test_two_soft_fingers_hold_a_box_and_two_hard_ones_do_not() -> None:
    fingers = [soft("A", [0.02, 0, 0], [1, 0, 0]), soft("B", [-0.02, 0, 0], [-1, 0, 0])]
    held = force_closure(Restraint.of(fingers))
    assert held.answer is Answer.YES
    assert held.margin is not None
    assert held.margin > 0
    hard = force_closure(Restraint.of([replace(finger, torsion=0.0) for finger in fingers]))
    assert hard.answer is Answer.NO
    assert isinstance(hard.evidence, Motion)
    # nothing stops turning about the line between them
    turn = hard.evidence.motion / np.linalg.norm(hard.evidence.motion)
    assert abs(turn[3]) == pytest.approx(1.0, abs=1e-6)
    smooth = force_closure(Restraint.of([replace(finger, friction=0.0) for finger in fingers]))
    assert smooth.answer is Answer.NO
    assert form_closure(Restraint.of(fingers)).answer is Answer.NO


@pytest.mark.parametrize(("friction", "answer"), [(0.36, Answer.NO), (0.40, Answer.YES)])
def test_tilted_soft_fingers_hold_from_the_angle_of_friction_on(friction: float, answer: Answer) -> None:
    """Two facets at 20 degrees to the line between the fingers: tan 20 = 0.364."""
    slope = np.tan(np.radians(20))
    fingers = [
        soft("A", [0.02, 0, 0], [1, 0, slope], friction),
        soft("B", [-0.02, 0, 0], [-1, 0, slope], friction),
    ]
    assert force_closure(Restraint.of(fingers)).answer is answer


@pytest.mark.parametrize("torsion", [C, 0.0])
def test_the_checker_confirms_both_answers(torsion: float) -> None:
    fingers = (
        soft("A", [0.02, 0, 0], [1, 0, 0], torsion=torsion),
        soft("B", [-0.02, 0, 0], [-1, 0, 0], torsion=torsion),
    )
    restraint = Restraint.of(fingers)
    found = group_verdict(Group("all", fingers, ()), restraint.report, [], restraint.tolerances)
    assert found.findings["force_closure"].answer is (Answer.YES if torsion else Answer.NO)
    assert check_group(found, fingers) == []
    # the same evidence proves nothing of contacts that are otherwise
    other = tuple(replace(finger, torsion=C - torsion) for finger in fingers)
    assert check_group(found, other) != []


def test_torsion_is_a_length_in_space() -> None:
    with pytest.raises(ContactError, match="torsion must be"):
        soft("A", [0, 0, 0], [1, 0, 0], torsion=-1.0)
    with pytest.raises(ContactError, match="in the plane"):
        replace(Contact.on_facet("A", "finger", [0, 0], [1, 0]), torsion=0.01)
