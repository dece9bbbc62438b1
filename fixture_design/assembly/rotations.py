"""Rotations of many configurations at once: unit quaternions [w, x, y, z]."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import cross_products


def matrices(quaternions: np.ndarray) -> np.ndarray:
    """R, shape (n, 3, 3)."""
    w, x, y, z = quaternions.T
    return np.moveaxis(
        np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        ),
        -1,
        0,
    )


def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The rotation by ``second``, then by ``first``."""
    a, b = first[:, :1], second[:, :1]
    u, v = first[:, 1:], second[:, 1:]
    scalar = a * b - np.einsum("ni,ni->n", u, v)[:, None]
    return np.concatenate([scalar, a * v + b * u + cross_products(u, v)], axis=1)


def from_vectors(turns: np.ndarray) -> np.ndarray:
    """Rotations about axes by angles, the vectors' directions and lengths [rad]."""
    angles = np.linalg.norm(turns, axis=1, keepdims=True)
    # sin(a / 2) / a, also where a is zero
    return np.concatenate([np.cos(angles / 2), turns * np.sinc(angles / (2 * np.pi)) / 2], axis=1)


def vectors(quaternions: np.ndarray) -> np.ndarray:
    """The inverse of `from_vectors`: angles up to pi."""
    q = np.where(quaternions[:, :1] < 0, -quaternions, quaternions)
    sines = np.linalg.norm(q[:, 1:], axis=1, keepdims=True)
    angles = 2 * np.arctan2(sines, q[:, :1])
    return q[:, 1:] * np.where(sines > 0, angles / np.where(sines > 0, sines, 1.0), 2.0)


def inverse(quaternions: np.ndarray) -> np.ndarray:
    return quaternions * np.array([1.0, -1.0, -1.0, -1.0])


def from_matrices(matrices: np.ndarray) -> np.ndarray:
    """Unit quaternions of rotation matrices (n, 3, 3)."""
    from scipy.spatial.transform import Rotation  # noqa: PLC0415 - 30 ms of any start

    found = np.roll(Rotation.from_matrix(matrices).as_quat(), 1, axis=1)
    return found / np.linalg.norm(found, axis=1, keepdims=True)  # the identity is exactly [1, 0, 0, 0]
