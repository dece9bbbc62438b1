"""Wrenches, twists and face vectors: the one place for their order, signs and reference points.

Thesis order: a displacement is dq = [dx; dtheta], a wrench p = [f; m]; moments and rotations are about the stated
origin. In the plane dtheta and m are scalars: [dx, dy, dtheta], [fx, fy, m], and x X n = x ny - y nx.

The face vector of a contact at x with outward normal n is  d = [n; x X n]  (2-5): admissible displacements have
d . dq <= 0 (2-6), a contact pushes the part along -d, and loads it can balance are p = R d with R >= 0 (2-16).
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point, Vector, cross_products


def face_vectors(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """d = [n; x X n] for every row (2-5).

    Args:
        points: contact points x from the reference point, shape (..., p), p = 2 or 3 [m].
        normals: outward normals of the part, shape (..., p), any length.

    Returns:
        shape (..., 3) in the plane, (..., 6) in space.
    """
    return np.concatenate([normals, cross(points, normals)], axis=-1)


def scaled_rows(
    levers: np.ndarray, forces: np.ndarray, length: float | np.ndarray, moments: float | np.ndarray = 0.0
) -> np.ndarray:
    """Dimensionless rows [f; (x X f + m) / length], of one layout or many: the same numbers give the same digits.

    Args:
        levers: x from the reference point, and forces, shape (..., p).  moments: added to those of the levers.
    """
    rows = face_vectors(levers, forces)
    rows[..., levers.shape[-1] :] += moments
    rows[..., levers.shape[-1] :] /= length
    return rows


def cross(points: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """x X v row by row: shape (..., 1) in the plane, (..., 3) in space."""
    if points.shape[-1] == 2:
        return points[..., :1] * vectors[..., 1:] - points[..., 1:] * vectors[..., :1]
    return cross_products(points, vectors)


def velocity(motion: Vector, point: Point) -> Point:
    """dx + dtheta X x: how the part's point x moves under a displacement about the origin (2-3)."""
    if len(motion) == 3:
        return motion[:2] + motion[2] * np.array([-point[1], point[0]])
    return motion[:3] + cross_products(motion[3:], point)


def motion_about_origin(scaled: Vector, reference: Point, length: float) -> Vector:
    """A scaled motion [velocity of the reference point; rotation * length] as [dx; dtheta] about W's origin.

    It pairs with rows [n; (x - reference) X n / length]: the products d . u are the same before and after.
    """
    plane = len(reference)
    rotation = scaled[plane:] / length
    moved = np.concatenate([scaled[:plane], rotation])
    return np.concatenate([velocity(moved, -reference), rotation])


def motion_scaled(motion: Vector, reference: Point, length: float) -> Vector:
    """The inverse of `motion_about_origin`."""
    plane = len(reference)
    return np.concatenate([velocity(motion, reference), motion[plane:] * length])
