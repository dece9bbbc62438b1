"""Which contact pairs may be closed at once, by the distances between features of one part (3-17) to (3-20)."""

from __future__ import annotations

import numpy as np

#: Two features of one part that must keep the same distance as two of the other: [smallest, largest] of each.
Intervals = np.ndarray


def intervals(ends: np.ndarray) -> Intervals:
    """dist(e_i, e_j) of (3-19) for segments (or points, with both ends the same), shape (v, v, 2) [m].

    Args:
        ends: shape (v, 2, p).
    """
    start, end = ends[:, 0], ends[:, 1]
    corners = ends[:, None, :, None] - ends[None, :, None, :]
    largest = np.linalg.norm(corners, axis=-1).max(axis=(2, 3))
    nearest = np.minimum.reduce([_to_segments(point, start, end) for point in (start, end)])
    smallest = np.minimum(nearest, nearest.T)
    crossing = _cross(start, end) if ends.shape[-1] == 2 else np.zeros_like(smallest, dtype=bool)
    return np.stack([np.where(crossing, 0.0, smallest), largest], axis=-1)


def overlapping(first: Intervals, second: Intervals, rounding: float) -> np.ndarray:
    """Whether intervals have a common distance (3-18)."""
    return (first[..., 0] <= second[..., 1] + rounding) & (second[..., 0] <= first[..., 1] + rounding)


def _to_segments(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    along = end - start
    squared = np.maximum(np.einsum("ij,ij->i", along, along), np.finfo(float).tiny)
    away = points[:, None] - start[None]
    share = np.clip(np.einsum("ijk,jk->ij", away, along) / squared, 0.0, 1.0)
    return np.linalg.norm(away - share[..., None] * along, axis=-1)


def _cross(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    def side(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
        u, v = (b - a)[:, None], p[None] - a[:, None]
        return np.sign(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    apart = side(start, end, start) * side(start, end, end)
    return (apart < 0) & (apart.T < 0)
