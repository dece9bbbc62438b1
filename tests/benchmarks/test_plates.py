"""All fixtures of a polygon of twenty edges on ten by ten holes."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fixture_design.design.plates import Plate, enumerate_fixtures

Benchmark = Callable[..., Any]
PITCH = 0.025


def twenty_edges(width: float, convex: bool) -> np.ndarray:
    """Corners on a circle of so many pitches across, or at least half as far out."""
    rng = np.random.default_rng(5)
    angles = (np.arange(20) + rng.uniform(-0.3, 0.3, 20)) * 2 * np.pi / 20
    out = np.ones(20) if convex else rng.uniform(0.5, 1.0, 20)
    return PITCH * width / 2 * np.column_stack([out * np.cos(angles), out * np.sin(angles)])


@pytest.mark.parametrize("width", [5, 7])
@pytest.mark.parametrize("shape", ["convex", "not convex"])
@pytest.mark.benchmark(group="fixtures on a plate")
def test_twenty_edges(benchmark: Benchmark, width: float, shape: str) -> None:
    polygon, plate = twenty_edges(width, shape == "convex"), Plate(PITCH, 10, 10, 0.006)
    assert len(benchmark(enumerate_fixtures, polygon, plate)) > 100
