"""Round pegs and plates with round holes, as meshes of any resolution with their corners on the true circles."""

from pathlib import Path

import numpy as np

from tests.assembly.solids import hull, prism


def ring(radius: float, facets: int, height: float | None = None) -> np.ndarray:
    angles = np.arange(facets) * 2 * np.pi / facets
    flat = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return flat if height is None else np.column_stack([flat, np.full(facets, height)])


def peg(path: Path, circles: list[tuple[float, float]], facets: int) -> dict:
    """The hull of circles about z, each (height, radius)."""
    return hull(path, np.vstack([ring(radius, facets, height) for height, radius in circles]))


def plate(path: Path, half: float, thick: float, radius: float, facets: int) -> dict:
    """A square plate under z = 0 with a hole about z."""
    square = [[-half, -half], [half, -half], [half, half], [-half, half]]
    return prism(path, square, -thick, 0, [ring(radius, facets).tolist()])
