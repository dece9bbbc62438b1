"""Thin plates are located by their narrow sides; the way out that is told is one that bodies leave free."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh
from shapely.geometry import Polygon

from fixture_design.design import CandidateRules, DesignResult, Task, design
from fixture_design.layout import Part, Pose
from fixture_design.layout.stem import stem_of
from fixture_design.verification.surface import PartSurface
from tests.design.test_parts import counts, designed

MM = 0.001


def written(tmp_path: Path, mesh: trimesh.Trimesh) -> Path:
    mesh.export(tmp_path / "part.stl")
    return tmp_path / "part.stl"


@pytest.mark.parametrize("thickness", [0.5, 2.0, 4.0])
def test_a_thin_plate_is_located_by_its_sides(tmp_path: Path, thickness: float) -> None:
    result = designed(written(tmp_path, trimesh.creation.box((120, 80, thickness))), MM)
    assert counts(result) == (6, 3)
    assert result.bound is not None
    assert result.bound.proven


def test_sides_that_margins_leave_bare_get_candidates_nearer_to_their_edges(tmp_path: Path) -> None:
    file = written(tmp_path, trimesh.creation.box((120, 80, 2)))
    surface = PartSurface(Part("plate", "mesh", file, None, MM, Pose.identity(3)), 1e-6)
    spots = surface.spots(CandidateRules(), 0)
    axes, faces = np.unique(np.round(spots.normals, 9), axis=0, return_counts=True)
    assert len(axes) == 6
    assert faces.min() >= 4
    on_sides = spots.points[np.abs(spots.normals[:, 2]) < 0.5]
    assert np.abs(on_sides[:, 2]).max() < 0.001
    only = surface.spots(CandidateRules(edge_margin=0.00144), 0)  # as it is asked for, and no nearer
    assert np.unique(np.round(only.normals, 9), axis=0).shape == (2, 3)


#: A channel, and one with undercut walls, as (outline, height) [mm].
CHANNELS = {
    "U": ([(0, 0), (60, 0), (60, 50), (40, 50), (40, 15), (20, 15), (20, 50), (0, 50)], 25),
    "dovetail": ([(0, 0), (60, 0), (60, 30), (40, 30), (45, 15), (15, 15), (20, 30), (0, 30)], 40),
}


@pytest.mark.parametrize("name", list(CHANNELS))
@pytest.mark.parametrize("seed", range(3))
def test_the_way_out_that_is_told_is_clear_of_stems_and_bodies(tmp_path: Path, name: str, seed: int) -> None:
    """Points of the locators' stems and bodies against the outline, as the part moves out by more than its length."""
    outline, height = CHANNELS[name]
    area = Polygon(np.array(outline) * MM)
    file = written(tmp_path, trimesh.creation.extrude_polygon(area, height * MM))
    result = design(Task("channel", Part("channel", "mesh", file, None, 1.0, Pose.identity(3))), seed=seed)
    assert counts(result)[0] == 6
    assert result.out is not None
    points = _of_locators(result, float(np.linalg.norm([*np.ptp(np.array(outline), axis=0), height])) * MM / 2)
    for step in np.linspace(0, 0.15, 301):
        moved = points - step * result.out  # the part's frame as it leaves
        deep = shapely.contains_xy(area.buffer(-1e-4), moved[:, 0], moved[:, 1])
        assert not (deep & (moved[:, 2] > 1e-4) & (moved[:, 2] < height * MM - 1e-4)).any()


def _of_locators(result: DesignResult, size: float) -> np.ndarray:
    """Points on the stems and bodies of locators, from a little above the tip."""
    assert result.layout is not None
    assert result.verdict is not None
    points = []
    for element in result.layout.elements:
        if element.role != "locator":
            continue
        stem = stem_of(element.tip, size)  # type: ignore[arg-type]
        contact = next(c for c in result.verdict.contacts if c.name.split("#")[0] == element.name)
        normal = np.asarray(contact.normals[0])  # out of the part, into the element
        across = np.linalg.svd(normal[None])[2][1:]
        for radius, low, high in (
            (stem.radius, 2 * stem.tip, stem.length),
            (stem.body_radius, stem.length, stem.length + stem.body_length),
        ):
            for along in np.linspace(low, high, 9):
                for angle in np.linspace(0, 2 * np.pi, 16, endpoint=False):
                    out = radius * (np.cos(angle) * across[0] + np.sin(angle) * across[1])
                    points.append(contact.point + along * normal + out)
    return np.array(points)
