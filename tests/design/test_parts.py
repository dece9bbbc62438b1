"""Real parts: files to layouts that verify."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from shapely.geometry import Polygon

from fixture_design.design import DesignResult, Task, design
from fixture_design.layout import Answer, Part, Pose
from fixture_design.verification import check
from tests.geometry.parts import shared

MM, INCH = 0.001, 0.0254


def designed(file: Path, scale: float, pose: Pose | None = None) -> DesignResult:
    return design(Task(file.stem, Part(file.stem, "mesh", file, None, scale, pose or Pose.identity(3))))


def counts(result: DesignResult) -> tuple[int, int]:
    assert result.satisfied is Answer.YES, result.reason
    assert result.verdict is not None
    assert result.layout is not None
    assert check(result.verdict) == []
    roles = [element.role for element in result.layout.elements]
    return roles.count("locator"), roles.count("clamp")


@pytest.mark.parametrize(
    ("file", "scale", "clamps"),
    [("featuretype.STL", INCH, {2}), ("angle_block.STL", INCH, {1, 2, 3}), ("plate_holes.STL", MM, {1, 2, 3})],
)
def test_public_parts_get_a_layout(file: str, scale: float, clamps: set[int]) -> None:
    result = designed(shared(f"trimesh/models/{file}"), scale)
    locators, found = counts(result)
    assert locators == 6
    assert found in clamps
    assert result.bound is not None
    assert result.bound.gap == 0


def solid(tmp_path: Path, mesh: object, name: str) -> Path:
    mesh.export(tmp_path / name)  # type: ignore[attr-defined]
    return tmp_path / name


def test_a_shaft_is_held_by_friction_and_its_spin_is_told(tmp_path: Path) -> None:
    result = designed(solid(tmp_path, trimesh.creation.cylinder(0.02, 0.1, sections=64), "shaft.stl"), 1.0)
    assert counts(result)[0] == 5
    assert "without friction" in (result.reason or "")
    assert result.free is not None
    assert np.abs(result.free / result.free[5]).round(6).tolist() == [0, 0, 0, 0, 0, 1]


def test_that_a_shaft_cannot_be_closed_is_certain(tmp_path: Path) -> None:
    file = solid(tmp_path, trimesh.creation.cylinder(0.02, 0.1, sections=48), "shaft.stl")
    part = Part("shaft", "mesh", file, None, 1.0, Pose.identity(3))
    result = design(Task("shaft", part, require={"locators": ("strongly_accessible",), "all": ("form_closure",)}))
    assert result.satisfied is Answer.NO
    assert result.layout is None
    assert result.free is not None


def test_a_moved_part_has_as_many_elements(tmp_path: Path) -> None:
    file = solid(tmp_path, trimesh.creation.box((0.1, 0.06, 0.04)), "box.stl")
    pose = Pose.from_xyz_rpy(np.array([0.3, -0.2, 0.1]), np.array([0.4, -0.3, 1.1]))
    assert counts(designed(file, 1.0, pose)) == (6, 3)


def test_a_chamfer_of_few_digits_takes_a_clamp(tmp_path: Path) -> None:
    """Single precision leaves its normal off by 1e-6: known well enough for a clamp, which then stands for two."""
    outline = [(0, 0), (60, 0), (60, 25), (45, 40), (0, 40)]
    mesh = trimesh.creation.extrude_polygon(Polygon(outline), 30)
    result = designed(solid(tmp_path, mesh, "chamfer.stl"), MM)
    assert counts(result) == (6, 2)
    assert result.bound is not None
    assert result.bound.proven
    assert not any("left out" in note for note in result.notes if "uncertain" in note)
