"""Holes and slots that pins could be in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from fixture_design.geometry import PartGeometry, contacts_of_element, holes_of, load_part
from fixture_design.layout import Element, PinTip, Pose
from tests.geometry.parts import part


def drilled(folder: Path, pose: Pose | None = None) -> PartGeometry:
    """A plate with two through holes, a slot with round ends, a hole in its side that ends, and a rounded corner."""
    outline = shapely.box(0, 0, 0.1, 0.06).difference(shapely.Point(0, 0).buffer(0.01, quad_segs=16))
    for at in ((0.02, 0.03), (0.05, 0.03)):
        outline = outline.difference(shapely.Point(at).buffer(0.004, quad_segs=16))
    slot = shapely.LineString([(0.075, 0.03), (0.087, 0.03)]).buffer(0.003, quad_segs=16)
    mesh = trimesh.creation.extrude_polygon(outline.difference(slot), 0.012)
    mesh.export(folder / "plate.stl")
    return load_part(part(folder / "plate.stl"))


def test_through_holes_and_slots_are_found_and_corners_are_not(tmp_path: Path) -> None:
    found = holes_of(drilled(tmp_path), Pose.identity(3))
    round_ones = [hole for hole in found if hole.across is None]
    slots = [hole for hole in found if hole.across is not None]
    assert sorted(round(float(hole.low[0]), 6) for hole in round_ones) == [0.02, 0.05]
    assert [round(hole.diameter, 6) for hole in round_ones] == [0.008, 0.008]
    for hole in round_ones:
        assert sorted([round(float(hole.low[2]), 6), round(float(hole.high[2]), 6)]) == [0.0, 0.012]
    assert len(slots) == 2  # once for each end
    for slot in slots:
        assert slot.diameter == pytest.approx(0.006, abs=1e-5)
        assert np.abs(slot.across).round(6).tolist() == [0, 1, 0]  # type: ignore[arg-type]
        assert 0.075 <= slot.low[0] <= 0.087
        assert slot.low[1] == pytest.approx(0.03, abs=1e-6)


def test_pins_fit_the_holes_that_are_found(tmp_path: Path) -> None:
    geometry = drilled(tmp_path)
    pose = Pose.from_xyz_rpy(np.array([0.3, -0.2, 0.1]), np.array([0.4, -0.3, 1.1]))
    for hole in holes_of(geometry, pose):
        axis = hole.high - hole.low
        pin = Element(
            "P", "locator", (hole.low + hole.high) / 2, PinTip(hole.diameter - 2e-5, 2e-5, "round"), axis=axis
        )
        contacts = contacts_of_element(pin, geometry, pose, 0.0, 1e-5)
        assert len(contacts) == (4 if hole.across is None else 2)
        for contact in contacts:
            across = contact.normals[0] / np.linalg.norm(contact.normals[0])
            assert abs(across @ axis) < 1e-6 * np.linalg.norm(axis)
            if hole.across is not None:
                assert abs(across @ hole.across) == pytest.approx(1, abs=1e-6)
