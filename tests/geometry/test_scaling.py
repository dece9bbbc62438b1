"""Scales that leave no part to compute with are refused by name; others are not, whatever the file's unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import GeometryError
from fixture_design.geometry import load_part
from fixture_design.geometry.scaling import check_scale
from tests.geometry.parts import box, part, write

URDF = """<robot name="r"><link name="base"><collision><geometry>
<mesh filename="part.obj" scale="{0} {0} {0}"/></geometry></collision></link></robot>"""


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        (1e300, ["`scale` 1e+300", "to 5e+299 m", "at most 1e+09 m"]),
        (1e20, ["`scale` 1e+20", "to 5e+19 m", "0.001 for a file in millimetres"]),
        (1e-300, ["`scale` 1e-300", "1e-300 m long", "at least 1e-09 m"]),
        (1e-12, ["`scale` 1e-12", "1e-12 m long"]),
    ],
)
@pytest.mark.parametrize("kind", ["mesh", "urdf"])
def test_extreme_scales(tmp_path: Path, kind: str, scale: float, words: list[str]) -> None:
    file = write(tmp_path, box(1, 1, 1))
    if kind == "urdf":
        file = tmp_path / "part.urdf"
        file.write_text(URDF.format(scale))
        scale = 1.0
    with pytest.raises(GeometryError) as caught:
        load_part(part(file, scale))
    for word in [file.name, *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize("unit", [1e-300, 1e-3, 1.0, 1e12, 1e300])
def test_what_counts_is_the_size_after_scaling(unit: float) -> None:
    vertices, _ = box(0.05, 0.03, 0.02)
    check_scale(vertices * unit, 1 / unit, Path("part.obj"))


def test_numbers_near_the_largest_there_are() -> None:
    vertices, _ = box(2, 2, 2)
    with pytest.raises(GeometryError, match=r"`scale` 1 takes the mesh to 1\.7e\+308 m"):
        check_scale(vertices * 1.7e308, 1.0, Path("part.obj"))


@pytest.mark.parametrize(
    ("shape", "origin", "words"),
    [
        ('<box size="1e300 1 1"/>', "0 0 0", ["reaches too far", "found 5e+299 m", "at most 1e+09 m"]),
        ('<box size="1e-300 1e-300 1e-300"/>', "0 0 0", ["too small", "found 1e-300 m", "at least 1e-09 m"]),
        ('<sphere radius="1e300"/>', "0 0 0", ["reaches too far"]),
        ('<cylinder radius="1" length="1e12"/>', "0 0 0", ["reaches too far"]),
        ('<box size="1 1 1"/>', "1e300 0 0", ["reaches too far", "1e+300 m"]),
    ],
)
def test_shapes_have_bounds_too(tmp_path: Path, shape: str, origin: str, words: list[str]) -> None:
    file = tmp_path / "part.urdf"
    inside = f'<origin xyz="{origin}"/><geometry>{shape}</geometry>'
    file.write_text(f'<robot name="r"><link name="base"><collision>{inside}</collision></link></robot>')
    with pytest.raises(GeometryError) as caught:
        load_part(part(file))
    for word in ["part.urdf: link 'base', collision: ", *words]:
        assert word in str(caught.value)


def test_other_faults_are_left_to_their_own_messages() -> None:
    for vertices in (np.zeros((0, 3)), np.zeros((4, 3)), np.full((4, 3), np.nan)):
        check_scale(vertices, 1e300, Path("part.obj"))
