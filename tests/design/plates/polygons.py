"""Random and special polygons, and plates for them, in units of about the pitch."""

from __future__ import annotations

from math import pi

import numpy as np
import shapely

from fixture_design.design.plates import Clamp, Plate

SPECIAL = {
    "square": [[0, 0], [2, 0], [2, 2], [0, 2]],
    "square with room for tips": [[0, 0], [1.5, 0], [1.5, 1.5], [0, 1.5]],
    "rectangle": [[0, 0], [2.5, 0], [2.5, 1.5], [0, 1.5]],
    "parallelogram": [[0, 0], [2, 0], [2.75, 1.5], [0.75, 1.5]],
    "isosceles triangle": [[0, 0], [2, 0], [1, 2]],
    "L": [[0, 0], [2.5, 0], [2.5, 1], [1, 1], [1, 2.5], [0, 2.5]],
    "U": [[0, 0], [2.6, 0], [2.6, 2], [1.8, 2], [1.8, 0.7], [0.8, 0.7], [0.8, 2], [0, 2]],
    "edge in two halves": [[0, 0], [1, 0], [2, 0], [1.7, 1.6], [0.2, 1.4]],
    "hexagon": [[np.cos(k * pi / 3) * 1.3, np.sin(k * pi / 3) * 1.3] for k in range(6)],
    "needle": [[0, 0], [3, 0.01], [0.1, 0.3]],
}


def random_case(seed: int, columns: int = 4, rows: int = 4) -> tuple[np.ndarray, Plate, float]:
    """A polygon of 3 to 8 edges, convex or not, a plate, and an edge margin."""
    rng = np.random.default_rng(seed)
    polygon = _convex(rng) if seed % 2 else _star(rng)
    polygon = polygon @ rotation(rng.uniform(0, 2 * pi)).T + rng.normal(size=2)
    radius = float(rng.choice([0.0, 0.15, 0.3]))
    clamp = None
    if rng.random() < 0.5:
        shortest = float(rng.choice([0.0, 0.4]))
        clamp = Clamp(
            float(rng.choice([0.0, 0.2])), shortest, shortest + float(rng.uniform(0.5, 2)), rng.uniform(0.3, 1.5)
        )
    return polygon, Plate(1.0, columns, rows, radius, clamp), float(rng.choice([0.0, 0.1]))


def rotation(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _convex(rng: np.random.Generator) -> np.ndarray:
    while True:
        angles = np.sort(rng.uniform(0, 2 * pi, rng.integers(3, 9)))
        axes = rng.uniform(0.6, 2.0, 2)
        polygon = np.column_stack([np.cos(angles), np.sin(angles)]) * axes
        if shapely.Polygon(polygon).area > 0.3:
            return polygon


def _star(rng: np.random.Generator) -> np.ndarray:
    while True:
        count = rng.integers(4, 9)
        angles = np.sort(rng.uniform(0, 2 * pi, count))
        polygon = np.column_stack([np.cos(angles), np.sin(angles)]) * rng.uniform(0.4, 2.0, count)[:, None]
        shape = shapely.Polygon(polygon)
        if shape.is_valid and shape.exterior.is_ccw and 0.3 < shape.area < 0.98 * shape.convex_hull.area:
            return polygon
