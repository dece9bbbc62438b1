"""Pins in holes and slots: where they touch, what does not fit, and the plate on two dowels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design.contacts import Contact, face_vectors
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry import PartGeometry, contacts_of_element, polygon_contacts
from fixture_design.layout import Answer, Element, Layout, PinTip, PointTip, Pose
from fixture_design.verification import check, verify
from tests.geometry.parts import circle, loaded, part, polygon_part, prism, unit, write

IDENTITY = Pose.identity(3)
GAP = 1e-5
OUTLINE = [[0, 0], [0.1, 0], [0.1, 0.06], [0, 0.06]]
RADIUS = 0.004
LEFT, RIGHT = (0.02, 0.03), (0.08, 0.03)


def slot(center: tuple[float, float], length: float, radius: float, count: int = 32) -> list[list[float]]:
    """A slot along x with round ends."""
    half = np.linspace(-np.pi / 2, np.pi / 2, count + 1)
    right = np.column_stack([length / 2 + radius * np.cos(half), radius * np.sin(half)])
    return (np.vstack([right, -right]) + center).tolist()


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    """10 mm thick, with two bores of 8 mm and a slot 6 mm wide in between."""
    holes = [circle(RADIUS, 64, LEFT), circle(RADIUS, 64, RIGHT), slot((0.05, 0.03), 0.012, 0.003)]
    return loaded(tmp_path_factory.mktemp("plate"), prism(OUTLINE, 0.01, holes))


def pin(
    geometry: PartGeometry,
    at: object,
    diameter: float = 0.00798,
    shape: str = "round",
    along: object = None,
    axis: object = (0, 0, 1),
    clearance: float = 2e-5,
) -> tuple[Contact, ...]:
    tip = PinTip(diameter, clearance, shape, None if along is None else np.array(along, dtype=float))  # type: ignore[arg-type]
    element = Element("P1", "locator", np.array(at, dtype=float), tip, np.array(axis, dtype=float))
    return contacts_of_element(element, geometry, IDENTITY, 0.0, GAP)


def test_round_pin_touches_at_the_ends_of_two_diameters(plate: PartGeometry) -> None:
    contacts = pin(plate, [*LEFT, 0.004])
    assert [contact.name for contact in contacts] == [f"P1#{k}" for k in (1, 2, 3, 4)]
    for contact in contacts:
        away = contact.point - np.array([*LEFT, 0.004])
        assert np.linalg.norm(away) == pytest.approx(RADIUS, abs=1e-8)
        np.testing.assert_allclose(contact.normals[0], -unit(away), atol=1e-7)
        assert contact.clearance == 2e-5
        assert contact.feature == contacts[0].feature
        assert contact.feature is not None
        assert "cylinder" in contact.feature
    assert abs(np.sum([contact.normals[0] for contact in contacts], axis=0)).max() < 1e-12


def test_four_contacts_span_the_rows_of_all_places_around(plate: PartGeometry) -> None:
    """Every contact around the circle, whatever the radius, is a nonnegative combination of the four."""
    from scipy.optimize import nnls

    contacts = pin(plate, [*LEFT, 0.004])
    rows = face_vectors(np.array([c.point for c in contacts]), np.array([c.normals[0] for c in contacts]))
    for angle in np.linspace(0, 2 * np.pi, 37):
        outward = np.array([np.cos(angle), np.sin(angle), 0])
        point = np.array([*LEFT, 0.004]) + RADIUS * outward
        row = face_vectors(point[None], -outward[None])[0]
        assert nnls(rows.T, row)[1] < 1e-6


def test_diamond_pin_touches_along_its_direction(plate: PartGeometry) -> None:
    contacts = pin(plate, [*RIGHT, 0.004], shape="diamond", along=[0, 1, 0.3])
    assert len(contacts) == 2
    np.testing.assert_allclose([c.point for c in contacts], [[0.08, 0.026, 0.004], [0.08, 0.034, 0.004]], atol=1e-8)
    np.testing.assert_allclose([c.normals[0] for c in contacts], [[0, 1, 0], [0, -1, 0]], atol=1e-6)


def test_round_pin_in_a_slot_touches_its_two_walls(plate: PartGeometry) -> None:
    contacts = pin(plate, [0.052, 0.03, 0.004], diameter=0.006, clearance=0.0)
    np.testing.assert_allclose([c.point for c in contacts], [[0.052, 0.027, 0.004], [0.052, 0.033, 0.004]], atol=1e-12)
    np.testing.assert_allclose([unit(c.normals[0]) for c in contacts], [[0, 1, 0], [0, -1, 0]], atol=1e-12)
    diamond = pin(plate, [0.052, 0.03, 0.004], 0.006, "diamond", [0, 1, 0], clearance=0.0)
    np.testing.assert_allclose([c.point for c in diamond], [c.point for c in contacts])


def test_round_pin_at_the_end_of_a_slot_touches_half_around(plate: PartGeometry) -> None:
    contacts = pin(plate, [0.056, 0.03, 0.004], diameter=0.006, clearance=0.0)
    normals = np.array([contact.normals[0] for contact in contacts])
    assert len(contacts) == 3
    expected = [[0, 1, 0], [0, -1, 0], [-1, 0, 0]]
    np.testing.assert_allclose(sorted(normals.tolist()), sorted(expected), atol=1e-6)


def test_what_does_not_fit(plate: PartGeometry) -> None:
    with pytest.raises(GeometryError, match=r"P1.*diameter 7\.9 mm.*clearance 20 um.*fit cylinder.*8 mm"):
        pin(plate, [*LEFT, 0.004], diameter=0.0079)
    with pytest.raises(GeometryError, match=r"P1.*diameter 5 mm.*slot.*6 mm"):
        pin(plate, [0.05, 0.03, 0.004], diameter=0.005)
    with pytest.raises(GeometryError, match=r"P1.*500 um off the middle of the slot"):
        pin(plate, [0.05, 0.0305, 0.004], diameter=0.006, clearance=0.0)
    for at, axis in (([0.03, 0.03, 0.004], (0, 0, 1)), ([*LEFT, 0.02], (0, 0, 1)), ([*LEFT, 0.004], (0, 1, 0.2))):
        with pytest.raises(GeometryError, match=r"P1.*no hole or slot"):
            pin(plate, at, axis=axis)
    with pytest.raises(GeometryError, match=r"P1.*no wall at both ends"):
        pin(plate, [0.052, 0.03, 0.004], 0.006, "diamond", [1, 0, 0], clearance=0.0)
    with pytest.raises(GeometryError, match=r"P1.*its own axis"):
        pin(plate, [*LEFT, 0.004], shape="diamond", along=[0, 0, 1])
    with pytest.raises(GeometryError, match="clearance >= 0"):
        pin(plate, [*LEFT, 0.004], clearance=-1e-5)
    flat = Element("P1", "locator", np.array([1.0, 0]), PinTip(0.1, 0.0, "round"))
    with pytest.raises(UnsupportedError, match=r"P1.*planar"):
        polygon_contacts(flat, polygon_part([[0, 0], [2, 0], [2, 2], [0, 2]]), 0.0, GAP)


def dowels(folder: Path, second: str, clearance: float, rests: int = 3) -> Layout:
    """A plate lying on rests, on a round dowel at the left and another one at the right."""
    mesh = prism(OUTLINE, 0.01, [circle(RADIUS, 64, LEFT), circle(RADIUS, 64, RIGHT)])
    z = np.array([0.0, 0, 1])
    diameter = 2 * RADIUS - clearance
    along = np.array([0.0, 1, 0]) if second == "diamond" else None
    places = [[0.01, 0.01, 0], [0.09, 0.01, 0], [0.05, 0.05, 0]][:rests]
    elements = (
        Element("P1", "locator", np.array([*LEFT, 0.005]), PinTip(diameter, clearance, "round"), z),
        Element("P2", "locator", np.array([*RIGHT, 0.005]), PinTip(diameter, clearance, second, along), z),  # type: ignore[arg-type]
        *(Element(f"L{k}", "locator", np.array(place, dtype=float), PointTip()) for k, place in enumerate(places, 1)),
    )
    return Layout("plate", part=part(write(folder, mesh)), elements=elements)


@pytest.mark.parametrize("second", ["diamond", "round"])
def test_plate_on_two_dowels_is_located_and_lifts_off(tmp_path: Path, second: str) -> None:
    verdict = verify(dowels(tmp_path, second, 2e-5))
    findings = verdict.groups["locators"].findings
    assert findings["deterministic"].answer is Answer.YES
    assert findings["accessible"].answer is Answer.YES
    assert findings["strongly_accessible"].answer is Answer.YES
    # the rests alone push it up
    assert findings["form_closure"].answer is not Answer.YES
    assert check(verdict) == []


def test_without_clearance_a_pin_keeps_the_part_on(tmp_path: Path) -> None:
    verdict = verify(dowels(tmp_path, "diamond", 0.0))
    findings = verdict.groups["locators"].findings
    assert findings["deterministic"].answer is Answer.YES
    assert findings["strongly_accessible"].answer is not Answer.YES
    assert check(verdict) == []


def test_pins_alone_leave_the_part_free_to_lift_and_are_confirmed(tmp_path: Path) -> None:
    verdict = verify(dowels(tmp_path, "diamond", 2e-5, rests=0))
    findings = verdict.groups["locators"].findings
    assert findings["strongly_accessible"].answer is Answer.YES
    assert findings["accessible"].answer is Answer.YES
    assert findings["deterministic"].answer is not Answer.YES
    assert check(verdict) == []


def test_checker_refuses_accessibility_that_rests_on_closed_clearances(tmp_path: Path) -> None:
    verdict = verify(dowels(tmp_path, "diamond", 2e-5))
    closed = replace(verdict, contacts=tuple(replace(contact, clearance=0.0) for contact in verdict.contacts))
    assert any("strongly_accessible" in problem for problem in check(closed))


def test_a_plate_turns_about_a_single_pin(tmp_path: Path) -> None:
    """Certain, though the hole was fitted to a mesh in float32: bore and rests both slip along that turn."""
    layout = dowels(tmp_path, "round", 0.0)
    vertices, triangles = prism(OUTLINE, 0.01, [circle(RADIUS, 64, LEFT)])
    file = write(tmp_path, (vertices.astype(np.float32).astype(float), triangles), "one.obj")
    layout = replace(layout, part=part(file), elements=tuple(e for e in layout.elements if e.name != "P2"))
    verdict = verify(layout)
    findings = verdict.groups["locators"].findings
    assert findings["deterministic"].answer is Answer.NO
    assert findings["form_closure"].answer is Answer.NO
    assert check(verdict) == []


def test_a_pin_between_the_walls_of_its_hole_is_refused(tmp_path: Path) -> None:
    """Two plates with one bore each, in line: in the gap between them there is nothing to touch."""
    lower, triangles = prism(OUTLINE, 0.004, [circle(RADIUS, 64, LEFT)])
    count = len(lower)
    stacked = np.vstack([lower, lower + np.array([0, 0, 0.008])]), np.vstack([triangles, triangles + count])
    geometry = loaded(tmp_path, stacked)
    at = np.array([*LEFT, 0.006])
    element = Element("P1", "locator", at, PinTip(2 * RADIUS, 0.0, "round"), axis=np.array([0.0, 0, 1]))
    with pytest.raises(GeometryError, match="no wall at the height"):
        contacts_of_element(element, geometry, IDENTITY, 0.2, GAP)
