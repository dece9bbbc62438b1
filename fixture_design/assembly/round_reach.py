"""Where the circles of a turned body can be in a region, and what of a drilled block they reach there."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Points
from fixture_design.assembly.assembly import Region
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.turned_body import TurnedBody
from fixture_design.errors import UnsupportedError

#: Slices of the turned body by which it is told whether an edge is in reach.
_SLICES = 24


def boxes_of(moving: TurnedBody, region: Region) -> np.ndarray:
    """Boxes in W that the points of each circle cannot leave, shape (k, 2, 3): low and high corners."""
    return np.array(
        [_box(center, radius, moving, region) for center, radius in zip(moving.centers, moving.radii, strict=True)]
    )


def _box(center: np.ndarray, radius: float, moving: TurnedBody, region: Region) -> np.ndarray:
    around = radius * np.sqrt(np.maximum(1 - moving.axis**2, 0.0))
    low, high = center - around, center + around
    farthest = float(np.linalg.norm(center)) + radius
    angle = np.pi if region.turns is None else min(region.turns[1], np.pi)
    turning = 2 * np.sin(angle / 2) * farthest
    return np.array([low - turning + region.low, high + turning + region.high])


def meeting(boxes: np.ndarray, corners: np.ndarray) -> np.ndarray:
    low, high = corners.min(axis=0), corners.max(axis=0)
    return ((boxes[:, 0] <= high) & (boxes[:, 1] >= low)).all(axis=1)


def reaching(boxes: np.ndarray, ring: Points, normal: np.ndarray, offset: float) -> np.ndarray:
    """Which boxes meet a facet's bounding box and have a corner on its plane or below."""
    lowest = np.where(normal > 0, boxes[:, 0], boxes[:, 1]) @ normal
    return meeting(boxes, ring) & (lowest <= offset)


def bounds_of(centers: Points, hole: Hole) -> np.ndarray:
    around = hole.radius * np.sqrt(np.maximum(1 - hole.axis**2, 0.0))
    return np.vstack([centers - around, centers + around])


def refuse_edges(moving: TurnedBody, block: DrilledBlock, region: Region) -> None:
    shares = np.linspace(moving.heights[0], moving.heights[-1], _SLICES + 1)
    radii = np.interp(shares, moving.heights, moving.radii)
    ends = np.array(
        [_box(moving.foot + s * moving.axis, float(r), moving, region) for s, r in zip(shares, radii, strict=True)]
    )
    slices = np.stack([np.minimum(ends[:-1, 0], ends[1:, 0]), np.maximum(ends[:-1, 1], ends[1:, 1])], axis=1)
    for edge in block.edges:
        if meeting(slices, edge).any():
            raise UnsupportedError(
                "in this region the turned body reaches the straight edge of a block from "
                f"{np.round(edge[0], 6).tolist()} to {np.round(edge[1], 6).tolist()}, and round surfaces form no "
                "contact pairs with straight edges",
                expected="a region with smaller positions or a smaller rotation",
            )
