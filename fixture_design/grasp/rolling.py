"""Two fingertips leave the hand free to roll about the line between them: the ways round that are tried."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.library import Seed, Spots
from fixture_design.layout import Pose

#: So many angles.
_ROLLS = 8


def rolled(seed: Seed, spots: Spots, rng: np.random.Generator) -> Iterator[Seed]:
    """The seed turned about the line between two spots, in steps that begin at random."""
    axis = spots.points[1] - spots.points[0]
    axis = axis / np.linalg.norm(axis)
    middle = spots.points.mean(axis=0)
    start = rng.random() * 2 * np.pi
    for step in range(_ROLLS):
        # halves first, then quarters: what is in the way on one side is often not on the other
        angle = start + 2 * np.pi * ((step * 3) % _ROLLS) / _ROLLS
        turn = _about(axis, angle)
        yield Seed(seed.tips, seed.q, composed(Pose(turn, middle - turn @ middle), seed.X_PH), seed.off)


def _about(axis: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about a unit axis (Rodrigues)."""
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
