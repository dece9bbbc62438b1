"""Small planar assemblies."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fixture_design.assembly import Assembly, AssemblyBody, Region
from fixture_design.io import assembly_from_data

FIGURE_14 = Path(__file__).resolve().parents[2] / "urdf" / "figure14" / "peg_in_hole.assembly.yaml"


def planar(moving: list, *fixed: list, region: dict | None = None, units: str = "m") -> Assembly:
    """Polygons without names."""
    data: dict = {"schema": "fixture_design/assembly/1", "space": "planar", "name": "test", "units": units}
    data |= {"moving": {"polygon": moving}, "fixed": [{"polygon": polygon} for polygon in fixed]}
    return assembly_from_data(data | ({"region": region} if region else {}), "test.yaml")


def box(x: float, y: float, width: float, height: float) -> list[list[float]]:
    """A rectangle with its lower left corner at (x, y)."""
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def random_polygon(rng: np.random.Generator, count: int, size: float = 1.0) -> np.ndarray:
    """A star-shaped polygon, often not convex, counter-clockwise about the origin."""
    angles = (np.arange(count) + rng.uniform(0.1, 0.6, count)) * 2 * np.pi / count
    return rng.uniform(0.45, 1.0, count)[:, None] * size * np.column_stack([np.cos(angles), np.sin(angles)])


def of_polygons(moving: np.ndarray, fixed: np.ndarray, region: Region) -> Assembly:
    data = {
        "schema": "fixture_design/assembly/1",
        "space": "planar",
        "moving": {"polygon": moving.tolist()},
        "fixed": [{"polygon": fixed.tolist()}],
        "region": {"x": [region.low[0], region.high[0]], "y": [region.low[1], region.high[1]]},
    }
    return Assembly(
        "random", "planar", AssemblyBody("polygon", moving), (AssemblyBody("polygon", fixed),), region, data=data
    )
