"""`scale`, which makes a mesh file's numbers metres, must leave a part of a size that can be computed with."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fixture_design.errors import GeometryError
from fixture_design.geometry.shapes import Vertices
from fixture_design.tolerances import FARTHEST, SMALLEST_PART


def check_scale(vertices: Vertices, scale: float, source: Path, place: str | None = None) -> None:
    """Refuses a scale that takes vertices beyond ``FARTHEST``, or shrinks the part below ``SMALLEST_PART``.

    Args:
        vertices: as read, before ``scale``, shape (v, 3). Of meshes without any, or with numbers that are not finite,
            nothing is said here: `sound` refuses them.
        scale: the largest factor, > 0 [m].
        source, place: for messages.

    Raises:
        GeometryError: the part is too large or too small.
    """
    if not len(vertices) or not np.isfinite(vertices).all():
        return
    with np.errstate(over="ignore", under="ignore"):
        # halves, for differences of numbers near the largest there are
        longest = 2 * float(np.ptp(vertices / 2, axis=0).max()) * scale
        farthest = float(np.abs(vertices).max()) * scale
    if farthest > FARTHEST:
        problem, limit = f"`scale` {scale:g} takes the mesh to {farthest:g} m", f"at most {FARTHEST:g} m"
    elif longest < SMALLEST_PART and np.ptp(vertices, axis=0).any():
        problem, limit = f"`scale` {scale:g} makes the part {longest:g} m long", f"at least {SMALLEST_PART:g} m"
    else:
        return
    expected = f"{limit}: 0.001 for a file in millimetres, 1 in metres"
    raise GeometryError(problem, source=source, place=place, expected=expected)
