"""An independent model of locating: a part with real faces and holes, moved rigidly until it touches.

No face vectors and no first order: the pose is a rotation vector w and a displacement t, x -> exp(w) x + t, and every
locator gives an equation of the moved geometry. A flat face n . x = h (in the part) goes through a tip at p + s n; the
axis of a hole along a through a point c meets a pin's point p + u; the middle plane of a slot does. Six equations, by
Newton's method with the derivatives of the moved geometry, for many samples at once.
"""

from dataclasses import dataclass

import numpy as np

#: Newton's steps: quadratic convergence from tolerances of 1e-3 needs four.
STEPS = 7


@dataclass(frozen=True)
class Plane:
    """A face, or the middle plane of a slot: the point p (nominal, on it) off by ``error`` lies on normal . x = h."""

    point: np.ndarray
    normal: np.ndarray


@dataclass(frozen=True)
class Axis:
    """A hole along ``across[0] X across[1]`` through ``point``, whose axis meets a pin that is off by a vector."""

    point: np.ndarray
    across: np.ndarray


def placements(constraints: list[Plane | Axis], errors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Poses R (n, 3, 3), t (n, 3) of the part, for the vectors by which tips are off (n, number of constraints, 3)."""
    count = len(errors)
    normals = np.concatenate([c.normal[None] if isinstance(c, Plane) else c.across for c in constraints])
    which = np.concatenate([[i] * (1 if isinstance(c, Plane) else 2) for i, c in enumerate(constraints)])
    points = np.array([c.point for c in constraints])[which]
    tips = points + errors[:, which]
    R, t = np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3))
    for _ in range(STEPS):
        # in the part the tip is R^T (tip - t); the moved geometry goes through it if its distance vanishes
        local = np.einsum("nji,nkj->nki", R, tips - t[:, None])
        gaps = np.einsum("ki,nki->nk", normals, local - points)
        # turning the part by dw (in part axes) and moving it by R dv changes local by -(dw X local) - dv
        slopes = np.concatenate([-np.broadcast_to(normals, local.shape), -np.cross(local, normals)], axis=2)
        step = np.linalg.solve(slopes, -gaps[..., None])[..., 0]
        t = t + np.einsum("nij,nj->ni", R, step[:, :3])
        R = R @ turns(step[:, 3:])
    assert np.abs(gaps).max() < 1e-9 * np.abs(points).max()
    return R, t


def turns(vectors: np.ndarray) -> np.ndarray:
    """Rotation matrices of rotation vectors (n, 3), by Rodrigues."""
    angles = np.linalg.norm(vectors, axis=1)
    axes = vectors / np.where(angles > 0, angles, 1.0)[:, None]
    K = np.zeros((len(vectors), 3, 3))
    K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = -axes[:, 2], axes[:, 1], -axes[:, 0]
    K = K - K.transpose(0, 2, 1)
    sines, versines = np.sin(angles)[:, None, None], (1 - np.cos(angles))[:, None, None]
    return np.eye(3) + sines * K + versines * K @ K


def shift(R: np.ndarray, t: np.ndarray, point: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """How far a point of the part is off along a direction, shape (n,)."""
    return (R @ point + t - point) @ direction
