"""Elements with stem and body beside parts: what has room, judged by volumes of intersection."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from fixture_design.geometry import PartGeometry, Places, load_part, sample_surface, with_room, with_way
from fixture_design.layout import PointTip, Pose, SphereTip, Stem, StemSizes, stem_of
from tests.geometry.parts import circle, loaded, part, prism, shared, unit

#: Volumes above this part of a column's are cut; below are touching facets [-].
CUT = 1e-9


def columns(stem: Stem, point: np.ndarray, normal: np.ndarray) -> list[trimesh.Trimesh]:
    made = []
    for column in stem.columns:
        ends = [point + height * normal for height in (column.low, column.high)]
        made.append(trimesh.creation.cylinder(column.radius, segment=ends, sections=64))
    return made


def cuts(solid: trimesh.Trimesh, stem: Stem, point: np.ndarray, normal: np.ndarray) -> bool:
    """By the volume that stem or body and part have in common."""
    for column in columns(stem, point, normal):
        common = trimesh.boolean.intersection([solid, column], engine="manifold")
        if abs(common.volume) > CUT * column.volume:
            return True
    return False


def agree(geometry: PartGeometry, stem: Stem, count: int) -> tuple[int, int]:
    """Elements with room and without, all as volumes have it; stems a hundredth thicker or thinner may be either."""
    area = geometry_area(geometry)
    spots = sample_surface(geometry, Pose.identity(3), float(np.sqrt(area / count)), seed=1)
    solid = trimesh.Trimesh(geometry.vertices, geometry.triangles)
    places = Places(np.array(spots.points), np.array(spots.normals))
    free = with_room(geometry, places, stem)
    slimmer, thicker = scaled(stem, 0.98), scaled(stem, 1.02)
    for index in range(len(places)):
        where = places.points[index], places.normals[index]
        if free[index]:
            assert not cuts(solid, slimmer, *where), f"{where} cuts the part"
        else:
            ball = trimesh.proximity.closest_point(solid, [where[0] + stem.tip * where[1]])[1][0]
            assert cuts(solid, thicker, *where) or ball < 0.95 * stem.tip, f"{where} has room"
    return int(free.sum()), int((~free).sum())


def scaled(stem: Stem, factor: float) -> Stem:
    return Stem(stem.tip, stem.radius * factor, stem.length, stem.body_radius * factor, stem.body_length)


def geometry_area(geometry: PartGeometry) -> float:
    return float(trimesh.Trimesh(geometry.vertices, geometry.triangles).area)


def pocket() -> tuple[np.ndarray, np.ndarray]:
    """A U with a hole through its floor."""
    outline = [[0, 0], [0.1, 0], [0.1, 0.06], [0.07, 0.06], [0.07, 0.02], [0.03, 0.02], [0.03, 0.06], [0, 0.06]]
    return prism(outline, 0.05, [circle(0.006, 24, (0.015, 0.03))])  # type: ignore[arg-type]


@pytest.mark.parametrize("sizes", [StemSizes(), StemSizes(0.002, 0.05, 0.004, 0.02), StemSizes(0.008, 0.01)])
def test_a_slot_and_a_bore_leave_as_much_room_as_volumes_say(tmp_path: object, sizes: StemSizes) -> None:
    geometry = loaded(tmp_path, pocket())  # type: ignore[arg-type]
    free, cut = agree(geometry, stem_of(PointTip(), geometry.half_diagonal, sizes), 120)
    assert free > 20
    assert cut > 3


@pytest.mark.parametrize(("file", "scale"), [("featuretype.STL", 0.0254), ("plate_holes.STL", 0.001)])
def test_real_parts_leave_as_much_room_as_volumes_say(file: str, scale: float) -> None:
    geometry = load_part(part(shared(f"trimesh/models/{file}"), scale))
    free, _ = agree(geometry, stem_of(PointTip(), geometry.half_diagonal), 100)
    assert free > 20


@pytest.mark.parametrize(
    ("out", "passes"), [([0, -1, 0], True), ([1, 0, 0], False), ([0, -1, -1], True), ([0, 0, 1], True)]
)
def test_the_part_passes_an_element_in_its_slot_or_runs_into_it(
    tmp_path: object, out: list[float], passes: bool
) -> None:
    geometry = loaded(tmp_path, pocket())  # type: ignore[arg-type]
    stem = stem_of(SphereTip(0.002), geometry.half_diagonal, StemSizes(length=0.02, body_radius=0.006))
    places = Places(np.array([[0.05, 0.02, 0.025]]), np.array([[0.0, 1, 0]]))
    assert with_room(geometry, places, stem).all()
    assert with_way(geometry, places, stem, unit(out)).tolist() == [passes]
    solid = trimesh.Trimesh(geometry.vertices, geometry.triangles)
    hit = [cuts(solid, stem, places.points[0] - way * unit(out), places.normals[0]) for way in np.arange(40) * 0.003]
    assert any(hit) is not passes


def test_a_ball_that_is_too_large_for_its_corner_has_no_room(tmp_path: object) -> None:
    geometry = loaded(tmp_path, pocket())  # type: ignore[arg-type]
    places = Places(np.array([[0.031, 0.02, 0.025], [0.034, 0.02, 0.025]]), np.array([[0.0, 1, 0]] * 2))
    stem = stem_of(SphereTip(0.003), geometry.half_diagonal, StemSizes(radius=0.0005, body_radius=0.0005))
    assert with_room(geometry, places, stem).tolist() == [False, True]
