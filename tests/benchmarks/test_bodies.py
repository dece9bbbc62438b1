"""Contacts of one body with parts of 1,000 to 50,000 triangles: a nest of three walls, a block with a rough top."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fixture_design.geometry import PartGeometry
from fixture_design.geometry.bodies import contacts_of_body
from fixture_design.layout import Body, Part, Pose

Benchmark = Callable[..., Any]

WALLS = (
    ("0.08 0.08 0.01", "0.02 0.02 -0.005"),
    ("0.01 0.08 0.03", "-0.005 0.02 0.015"),
    ("0.07 0.01 0.03", "0.03 -0.005 0.015"),
)


@cache
def rough_block(triangles: int) -> PartGeometry:
    """A block on [0, 0.04]^2 whose top is a grid of random heights."""
    n = int(np.sqrt(triangles / 2))
    side = np.linspace(0, 0.04, n + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(side, side, indexing="ij"))
    height = 0.03 + 0.002 * np.random.default_rng(1).random(len(x))
    top = np.column_stack([x, y, height])
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    faces = [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    rim = np.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
    low = len(top) + np.arange(len(rim))
    after = np.roll(np.arange(len(rim)), -1)
    faces += [np.column_stack([low, low[after], rim[after]]), np.column_stack([low, rim[after], rim])]
    center = len(top) + len(rim)
    faces.append(np.column_stack([np.full(len(rim), center), low[after], low]))
    bottom = np.vstack([top[rim] * [1, 1, 0], [[0.02, 0.02, 0.0]]])
    vertices = np.vstack([top, bottom])
    return PartGeometry("block", vertices, np.vstack(faces), np.full(len(vertices), 1e-18), faceted=True)


@pytest.mark.parametrize("triangles", [1_000, 10_000, 50_000])
@pytest.mark.benchmark(group="contacts of a body, warm", min_rounds=3)
def test_contacts_of_a_nest(benchmark: Benchmark, tmp_path: Path, triangles: int) -> None:
    shapes = "".join(
        f'<collision><origin xyz="{xyz}"/><geometry><box size="{size}"/></geometry></collision>' for size, xyz in WALLS
    )
    file = tmp_path / "nest.urdf"
    file.write_text(f'<robot name="nest"><link name="nest">{shapes}</link></robot>')
    body = Body("nest", "locator", file, Pose.identity(3))
    geometry = rough_block(triangles)
    part = Part("block", "mesh", None, None, 1.0, Pose.identity(3))
    contacts, _ = contacts_of_body(body, part, geometry, 0.2, 1e-5)
    assert len(contacts) >= 7
    benchmark(contacts_of_body, body, part, geometry, 0.2, 1e-5)
