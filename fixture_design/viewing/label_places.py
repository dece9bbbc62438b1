"""Where labels stand so that none covers another: beside what they name, or a little off with a line to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

#: Free space around a label, and how far off it may be put, in steps of its own height [pixels, -].
_MARGIN, _STEPS = 3.0, 7
#: Directions to try, nearest first: right, left, above, below and between.
_WAYS = np.array([(1, 0), (-1, 0), (0, -1), (0, 1), (1, -1), (-1, -1), (1, 1), (-1, 1)], dtype=np.float64)


@dataclass(frozen=True)
class Place:
    """A label's rectangle [pixels]; ``led``: it is so far off that it needs a line."""

    left: float
    top: float
    right: float
    bottom: float
    led: bool

    def nearest(self, point: np.ndarray) -> tuple[float, float]:
        """The point of the rectangle nearest to another."""
        return min(max(float(point[0]), self.left), self.right), min(max(float(point[1]), self.top), self.bottom)


def placed_labels(anchors: np.ndarray, sizes: np.ndarray, width: int, height: int) -> Sequence[Place]:
    """Places in the order of the labels; where there is no room at all, they stand where they belong.

    Args:
        anchors: shape (n, 2), what they name.  sizes: shape (n, 2), their widths and heights.  width, height: of the
            picture, all in pixels.
    """
    taken: list[Place] = []
    for anchor, size in zip(anchors, sizes, strict=True):
        tried = list(_candidates(anchor, size, width, height))
        free = (place for place in tried if not any(_overlap(place, other) for other in taken))
        taken.append(next(free, tried[0]))
    return taken


def _candidates(anchor: np.ndarray, size: np.ndarray, width: int, height: int) -> Sequence[Place]:
    """Centred on the anchor, then further and further off."""
    found = []
    offsets = [np.zeros(2)] + [
        way * (size / 2 + (step - 0.4) * size[1] * 0.8) for step in range(1, _STEPS) for way in _WAYS
    ]
    for number, offset in enumerate(offsets):
        corner = anchor + offset - size / 2
        left, top = np.clip(
            corner, _MARGIN, [max(width - size[0] - _MARGIN, _MARGIN), max(height - size[1] - _MARGIN, _MARGIN)]
        )
        found.append(Place(float(left), float(top), float(left + size[0]), float(top + size[1]), number > len(_WAYS)))
    return found


def _overlap(first: Place, second: Place) -> bool:
    return not (
        first.right + _MARGIN < second.left
        or second.right + _MARGIN < first.left
        or first.bottom + _MARGIN < second.top
        or second.bottom + _MARGIN < first.top
    )
