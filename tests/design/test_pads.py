"""Pads and lines as new elements: with the rows of the contacts that they have, few, and nothing said twice."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yourdfpy

from fixture_design.design import CandidateRules, DesignResult, Task, design
from fixture_design.design.touching import candidates_of
from fixture_design.errors import GeometryError
from fixture_design.io import write_urdf
from fixture_design.layout import Answer, LineTip, PadTip, Part, PointTip, Pose, SoftTip, SphereTip, Tip, element_name
from fixture_design.verification import check
from fixture_design.verification.surface import PartSurface
from tests.geometry.parts import part, polygon_part, shared

X = np.array([1.0, 0, 0])
SIDES = np.array([0.1, 0.06, 0.04])
PAD, LINE = PadTip(0.012, 0.008, X), LineTip(0.015, X)


@pytest.fixture
def solid(tmp_path: Path) -> Part:
    trimesh.creation.box(SIDES).export(tmp_path / "box.stl")
    return part(tmp_path / "box.stl")


def designed(solid: Part, *tips: Tip, **keys: object) -> DesignResult:
    rules = CandidateRules(tip=tips[0], more_tips=tips[1:])
    space = "planar" if solid.kind == "polygon" else "spatial"
    return design(Task("pads", solid, space, candidates=rules, **keys))  # type: ignore[arg-type]


def kinds(result: DesignResult, role: str) -> list[str]:
    assert result.satisfied is Answer.YES, result.reason
    assert result.verdict is not None
    assert result.layout is not None
    assert check(result.verdict) == []
    return sorted(type(e.tip).__name__ for e in result.layout.elements if e.role == role)


def ranks(result: DesignResult) -> tuple[int, int]:
    """Of all locators' contacts together, and the sum of those of each alone."""
    assert result.verdict is not None
    rows: dict[str, list[np.ndarray]] = {}
    for contact in result.verdict.contacts:
        if contact.role == "locator":
            n = contact.normals[0] / np.linalg.norm(contact.normals[0])
            x = contact.point
            turn = np.array([x[0] * n[1] - x[1] * n[0]]) if len(n) == 2 else np.cross(x, n)
            rows.setdefault(element_name(contact.name), []).append(np.concatenate([n, turn / 0.05]))
    each = [int(np.linalg.matrix_rank(np.array(own), 1e-6)) for own in rows.values()]
    return int(np.linalg.matrix_rank(np.vstack([np.array(own) for own in rows.values()]), 1e-6)), sum(each)


def test_a_plane_a_line_and_a_point_locate_a_box(solid: Part) -> None:
    result = designed(solid, PAD, LINE, PointTip())
    assert kinds(result, "locator") == ["LineTip", "PadTip", "PointTip"]
    assert ranks(result) == (6, 6)
    assert result.bound is not None
    assert (result.bound.locators, result.bound.proven) == (3, True)


def test_one_pad_takes_the_place_of_three_points(solid: Part) -> None:
    result = designed(solid, PAD, PointTip())
    assert kinds(result, "locator") == ["PadTip", "PointTip", "PointTip", "PointTip"]
    assert ranks(result) == (6, 6)


def test_where_there_are_only_pads_three_do_and_what_they_say_twice_is_told(solid: Part) -> None:
    result = designed(solid, PAD)
    assert kinds(result, "locator") == ["PadTip"] * 3
    assert ranks(result) == (6, 9)
    assert any("say what others say" in note for note in result.notes)
    assert result.bound is not None
    assert result.bound.proven


@pytest.mark.parametrize("tip", [SphereTip(0.003), SoftTip(0.002)])
def test_balls_and_soft_tips_stay_six(solid: Part, tip: Tip) -> None:
    result = designed(solid, tip)
    assert kinds(result, "locator") == [type(tip).__name__] * 6
    assert ranks(result) == (6, 6)


def test_in_the_plane_a_line_and_a_point_locate() -> None:
    polygon = polygon_part([[0, 0], [0.04, 0], [0.04, 0.02], [0, 0.02]])
    tip = PadTip(0.004, 0.004, np.array([1.0, 0.0]))
    wanted = {"locators": ("deterministic", "strongly_accessible"), "all": ("form_closure",)}
    result = designed(polygon, tip, PointTip(), require=wanted)
    assert kinds(result, "locator") == ["PadTip", "PointTip"]
    assert ranks(result) == (3, 3)


def test_plates_leave_room_for_each_other(tmp_path: Path) -> None:
    """Large pads on a flat box: no point of one plate is in another."""
    trimesh.creation.box((0.1, 0.05, 0.02)).export(tmp_path / "flat.stl")
    result = designed(part(tmp_path / "flat.stl"), PadTip(0.06, 0.03, X))
    assert result.satisfied is Answer.YES
    assert result.layout is not None
    assert result.verdict is not None
    write_urdf(result.layout, result.verdict, tmp_path / "pads.urdf")
    plates = {}
    for link in yourdfpy.URDF.load(str(tmp_path / "pads.urdf")).robot.links[1:]:
        solid = link.collisions[0]
        plates[link.name] = np.array(solid.geometry.box.size), solid.origin
    model = yourdfpy.URDF.load(str(tmp_path / "pads.urdf"))
    assert len(plates) == len(result.layout.elements)
    grid = np.stack(np.meshgrid(*[np.linspace(-0.499, 0.499, count) for count in (61, 31, 5)]), axis=-1).reshape(-1, 3)
    for name, other in combinations(plates, 2):
        for mine, theirs in ((name, other), (other, name)):
            X_WM, X_WT = (model.get_transform(link) @ plates[link][1] for link in (mine, theirs))
            points = (grid * plates[mine][0]) @ X_WM[:3, :3].T + X_WM[:3, 3]
            local = (points - X_WT[:3, 3]) @ X_WT[:3, :3]
            assert not (np.abs(local) < plates[theirs][0] / 2 * 0.999).all(axis=1).any(), (mine, theirs)


def test_no_two_elements_would_do(solid: Part) -> None:
    task = Task("pads", solid, candidates=CandidateRules(tip=PAD, more_tips=(LINE,), spacing=0.015))
    ways = PartSurface(solid, task.surface_gap)
    found, _ = candidates_of(task, ways, ways.spots(task.candidates, 0))
    rows = found.rows
    assert np.linalg.matrix_rank(rows.reshape(-1, 6), 1e-6) == 6
    assert all(
        np.linalg.matrix_rank(rows[list(pair)].reshape(-1, 6), 1e-6) < 6 for pair in combinations(range(len(found)), 2)
    )


def test_pads_have_the_corners_of_where_they_lie_on_their_face(solid: Part) -> None:
    at = np.array([[0.0, 0.0, 0.02], [0.047, 0.0, 0.02], [0.05, 0.0, 0.0]])
    task = Task("pads", solid, candidates=CandidateRules(tip=PAD, points=at))
    ways = PartSurface(solid, task.surface_gap)
    found, notes = candidates_of(task, ways, ways.spots(task.candidates, 0))
    assert notes == ()
    whole, clipped, turned = found.points
    assert sorted(map(tuple, whole.round(9).tolist())) == [
        (x, y, 0.02) for x in (-0.006, 0.006) for y in (-0.004, 0.004)
    ]
    assert clipped[:, 0].max() == pytest.approx(0.05)
    assert clipped[:, 0].min() == pytest.approx(0.041)
    assert np.ptp(turned, axis=0).round(9).tolist() == [0, 0.012, 0.008]  # along y, where x is the normal
    assert (np.any(found.locating, axis=2).sum(axis=1) == 3).all()
    assert np.array(found.places) == pytest.approx(at)


def test_tips_that_fit_nowhere_are_an_error(tmp_path: Path) -> None:
    trimesh.creation.icosphere(subdivisions=3, radius=0.02).export(tmp_path / "ball.stl")
    with pytest.raises(GeometryError, match="no tip lies flat"):
        designed(part(tmp_path / "ball.stl"), PAD)


def test_a_real_part_on_a_plane_a_line_and_a_point() -> None:
    size = 0.006
    solid = part(shared("trimesh/models/featuretype.STL"), 0.0254)
    result = designed(solid, PadTip(size, size, X), LineTip(size, X), PointTip())
    assert kinds(result, "locator") == ["LineTip", "PadTip", "PointTip"]
    assert ranks(result) == (6, 6)


def test_flat_tips_close_a_plate_whose_chamfers_nearly_close_it() -> None:
    """A cut there was once made empty by a motion that is free up to rounding only."""
    size = 0.018
    solid = part(shared("trimesh/models/plate_holes.STL"), 0.001)
    result = designed(solid, PadTip(size, size, X), LineTip(size, X), PointTip())
    assert kinds(result, "locator") == ["LineTip", "PadTip", "PointTip"]
    assert result.reason is None  # without friction


def test_a_moved_box_keeps_its_plane_line_and_point(solid: Part) -> None:
    pose = Pose.from_xyz_rpy(np.array([0.3, -0.2, 0.1]), np.array([0.4, -0.3, 1.1]))
    moved = Part(solid.name, "mesh", solid.file, None, 1.0, pose)
    along = pose.vectors(X[None])[0]
    result = designed(moved, PadTip(0.012, 0.008, along), LineTip(0.015, along), PointTip())
    assert kinds(result, "locator") == ["LineTip", "PadTip", "PointTip"]
