"""Vectors in space with their components first, shape (3, ...): numpy is fast along many, slow along three numbers."""

from __future__ import annotations

import numpy as np


def dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The products of vectors (3, ...)."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def cross(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """a X b of vectors (3, ...)."""
    (a, b, c), (x, y, z) = first, second
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x])


def turned(R: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (3, ...) by matrices (3, 3, ...)."""
    return np.stack([dot(row, vectors) for row in R])


def turned_back(R: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (3, ...) by the transposed matrices (3, 3, ...)."""
    return turned(np.swapaxes(R, 0, 1), vectors)


def components_first(table: np.ndarray) -> np.ndarray:
    """From (n, ...) to (..., n), in this order in memory."""
    return np.ascontiguousarray(np.moveaxis(table, 0, -1))


def rate(direction: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """[n; arm X n], shape (6, ...): how fast a point at an arm (3, ...) moves along n, by displacements."""
    return np.concatenate([direction, cross(arm, direction)])
