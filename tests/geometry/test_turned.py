"""Surfaces of revolution by their rings: the axis, the pieces of the profile, and what is said of the errors."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixture_design.geometry import PartGeometry
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.geometry.turned_axes import axes_of
from tests.geometry.parts import Mesh, loaded
from tests.verification.test_turned_parts import FOLDS, turned

Profile = Sequence[Sequence[float]]

TURN = Rotation.from_euler("xyz", [0.9, -0.3, 1.4]).as_matrix()
PLACE = np.array([0.1, -0.2, 0.05])
#: Rings where a vase's profile is known by nothing but its vertices.
HEIGHTS = np.linspace(0, 3, 16)


def vase(heights: np.ndarray) -> np.ndarray:
    return 0.02 + 0.006 * np.sin(2 * heights)


VASE = [[0.0, 0.0], *np.column_stack([vase(HEIGHTS), 0.02 * HEIGHTS]).tolist(), [0.0, 0.06]]


def placed(mesh: Mesh) -> Mesh:
    return mesh[0] @ TURN.T + PLACE, mesh[1]


def body(folder: Path, profile: Profile, sections: int, fold: str = "alternating") -> PartGeometry:
    return loaded(folder, placed(turned([list(place) for place in profile], sections, fold)))


def arc(center: float, height: float, radius: float, first: float, last: float, count: int) -> list[list[float]]:
    angles = np.linspace(first, last, count)
    return np.column_stack([center + radius * np.cos(angles), height + radius * np.sin(angles)]).tolist()


def off_axis(surface: SmoothSurface) -> float:
    """How far a surface's axis is off the one that the body was turned about, at its place and by angle."""
    away = surface.point - PLACE
    return float(np.linalg.norm(np.cross(away, TURN[:, 2])) / 0.02 + np.linalg.norm(np.cross(surface.axis, TURN[:, 2])))


@pytest.mark.parametrize("fold", FOLDS)
@pytest.mark.parametrize("sections", [24, 48])
def test_what_is_in_one_line_or_on_one_arc_is_one_surface(tmp_path: Path, sections: int, fold: str) -> None:
    """A cylinder in three bands, a cone in two, and a fillet that is neither: a torus."""
    fillet = arc(0.012, 0.03, 0.008, 0, np.pi / 2, 9)
    geometry = body(
        tmp_path,
        [[0, 0], [0.014, 0], [0.017, 0.005], [0.02, 0.01], [0.02, 0.018], [0.02, 0.024], *fillet, [0, 0.038]],
        sections,
        fold,
    )
    found = {surface.kind: surface for surface in geometry.smooth_surfaces}
    assert sorted(surface.kind for surface in geometry.smooth_surfaces) == ["cone", "cylinder", "torus"]
    assert found["cylinder"].radius == pytest.approx(0.02, abs=1e-9)
    assert found["cone"].radius == pytest.approx(np.arctan2(0.006, 0.01), abs=1e-7)
    assert (found["torus"].radius, found["torus"].ring) == pytest.approx((0.008, 0.012), abs=1e-8)
    for surface in found.values():
        assert off_axis(surface) <= surface.normal_error <= 1e-6
        assert not surface.hollow
        assert not surface.is_band


@pytest.mark.parametrize("fold", FOLDS)
@pytest.mark.parametrize("sections", [18, 36])
def test_bands_of_an_unknown_profile_say_how_far_off_their_normals_are(
    tmp_path: Path, sections: int, fold: str
) -> None:
    """In the half plane as far as the bands turn against each other; across it not at all."""
    geometry = body(tmp_path, VASE, sections, fold)
    bands = [surface for surface in geometry.smooth_surfaces if surface.is_band]
    # but for the first and the last, which may be chamfers for all that one can tell
    assert len(bands) >= len(HEIGHTS) - 3
    assert {band.name for band in bands} == {"turned 1"}
    heights = np.linspace(0.2, 2.8, 60)
    judged = 0
    for azimuth in np.linspace(0, 6, 5):
        outward = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        for height in heights:
            point = vase(height) * outward + [0, 0, 0.02 * height]
            slope = 0.012 * np.cos(2 * height) / 0.02
            true = (outward - [0, 0, slope]) / np.hypot(1, slope)
            low = np.searchsorted(HEIGHTS, height) - 1
            ring = [vase(HEIGHTS[low]), vase(HEIGHTS[low + 1])]
            cone = np.arctan2(abs(ring[1] - ring[0]), 0.02 * (HEIGHTS[1] - HEIGHTS[0]))
            mine = [
                b for b in bands if abs(b.distance(TURN @ point + PLACE)) < 3e-4 and _angle(b) == pytest.approx(cone)
            ]
            for band in mine:
                judged += 1
                normal = TURN.T @ band.normal(TURN @ point + PLACE)
                assert np.linalg.norm(normal - true) <= band.normal_error
                assert abs(normal @ np.cross(outward, [0, 0, 1])) <= band.axis_error <= 1e-6
    assert judged > 150


def _angle(band: SmoothSurface) -> float:
    return band.radius if band.kind == "cone" else 0.0


@pytest.mark.parametrize("noise", [1e-9, 1e-8, 1e-7])
def test_the_axis_is_as_good_as_is_said(tmp_path: Path, noise: float) -> None:
    """What is said of the axis covers where it is, when vertices are shaken."""
    rng = np.random.default_rng(3)
    for _ in range(3):
        mesh = placed(turned(VASE, 24, "random"))
        shaken = mesh[0] + noise * rng.uniform(-1, 1, mesh[0].shape)
        bands = [surface for surface in loaded(tmp_path, (shaken, mesh[1])).smooth_surfaces if surface.is_band]
        assert bands
        for band in bands:
            assert off_axis(band) <= band.axis_error <= 2e4 * noise


@pytest.mark.parametrize("fold", ["alternating", "half turned"])
@pytest.mark.parametrize("sections", [13, 24])
def test_a_badly_measured_shaft_is_a_cylinder(tmp_path: Path, sections: int, fold: str) -> None:
    """Two rings that are not quite equal are no cone with its apex far away."""
    rng = np.random.default_rng(sections)
    for _ in range(4):
        vertices, triangles = placed(turned([[0, 0], [0.01, 0], [0.01, 0.012], [0, 0.012]], sections, fold))
        shaken = vertices + 3e-7 * rng.uniform(-1, 1, vertices.shape)
        (surface,) = loaded(tmp_path, (shaken, triangles)).smooth_surfaces
        assert surface.kind == "cylinder"
        assert off_axis(surface) <= surface.axis_error <= surface.normal_error <= 2e-3


@pytest.mark.parametrize("sections", [24, 48, 96])
def test_a_crowned_land_says_how_far_off_its_normals_are(tmp_path: Path, sections: int) -> None:
    """A crown of 2 or 3 um, in a file that rounds to 1 um: a cylinder within its error, or no cylinder."""
    for crown in (2e-6, 3e-6):
        heights = np.linspace(-0.005, 0.005, 6)
        lands = np.column_stack([0.02 + crown * (1 - (heights / 0.005) ** 2), 0.02 + heights])
        profile = [[0, 0], [0.02, 0], *lands.tolist(), [0.015, 0.03], [0.015, 0.1], [0, 0.1]]
        vertices, triangles = turned(profile, sections, "short")
        part = PartGeometry("part", np.round(vertices, 6), triangles, np.full(len(vertices), 5e-7))
        judged = 0
        for low, high in pairwise(lands):
            middle, slope = (low + high) / 2, (low[0] - high[0]) / (high[1] - low[1])
            for surface in part.smooth_surfaces:
                on = vertices[triangles[np.isin(part.facet_of_triangle, surface.facets)]].mean(axis=1)[:, 2]
                if np.abs(on - middle[1]).min() < 5e-4 and surface.kind == "cylinder":
                    given = surface.normal(np.array([middle[0], 0.0, middle[1]]))
                    assert abs(np.arctan2(given[2], given[0]) - slope) <= surface.normal_error
                    judged += 1
        assert judged


def test_a_band_of_an_unknown_profile_moves_along_itself_by_turning_only(tmp_path: Path) -> None:
    """Also the one around a barrel's belly, whose two rings are equal: the cylinder through them is a chord."""
    heights = np.linspace(-1, 1, 8)
    profile = np.column_stack([0.006 + 0.004 * np.sqrt(1 - 0.7 * heights**2), 0.01 * heights]).tolist()
    bands = [
        surface for surface in body(tmp_path, [[0, -0.01], *profile, [0, 0.01]], 24).smooth_surfaces if surface.is_band
    ]
    assert "cylinder" in {band.kind for band in bands}
    for band in bands:
        (slip,) = band.slips()
        assert np.linalg.norm(np.cross(slip[3:], TURN[:, 2])) < 1e-9


def test_axes_of_two_turned_bodies_are_told_apart() -> None:
    """Rings on one line are one axis, those beside it another; the one with more vertices is first."""
    rings = []
    for place, radius, count in (([0, 0, 0], 1.0, 24), ([0, 0, 2], 0.7, 24), ([3, 0, 1], 0.5, 16)):
        angles = 2 * np.pi * np.arange(count) / count
        rings.append(np.column_stack([radius * np.cos(angles), radius * np.sin(angles), 0 * angles]) + place)
    vertices = np.vstack(rings)
    starts = np.cumsum([0, *(len(ring) for ring in rings)])
    edges = np.vstack(
        [
            start + np.column_stack([np.arange(len(ring)), np.roll(np.arange(len(ring)), -1)])
            for start, ring in zip(starts, rings, strict=False)
        ]
    )
    first, second = axes_of(vertices, edges, 1e-9, 5.0)
    assert (len(first.vertices), len(second.vertices)) == (48, 16)
    np.testing.assert_allclose(first.places(np.array([[0.0, 0, 5]]))[0], 0, atol=1e-12)
    np.testing.assert_allclose(second.places(np.array([[3.0, 0, 5]]))[0], 0, atol=1e-12)


@pytest.mark.parametrize("sections", [5, 6, 8])
def test_a_bar_of_few_flats_may_be_a_coarse_shaft(tmp_path: Path, sections: int) -> None:
    """Nobody can tell: its flats are given as such, with an error that reaches to the normals of the shaft."""
    geometry = body(tmp_path, [[0, 0], [0.02, 0], [0.02, 0.09], [0, 0.09]], sections)
    assert geometry.smooth_surfaces == ()
    across = [abs(facet.normal @ TURN[:, 2]) / np.linalg.norm(facet.normal) for facet in geometry.facets]
    assert sorted(np.round(across).tolist()) == [0.0] * sections + [1.0, 1.0]
    for facet, along in enumerate(across):
        provenance = geometry.provenance_of(facet)
        assert provenance.kind == ("exact" if along > 0.5 else "approximate")
        if along < 0.5:
            assert provenance.normal_error >= np.pi / sections
