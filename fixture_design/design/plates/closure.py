"""Form closure of four contacts in the plane, and its margin.

Four rows d_i = [n; x X n / length] of R^3 close if and only if the origin is inside their tetrahedron. With three rows
independent, the fourth is d_4 = w_1 d_1 + w_2 d_2 + w_3 d_3, and they close if and only if all w < 0. The margin is the
distance of the nearest face, s = min over |u| = 1 of max_i d_i . u: the same number as `analysis.margin` has.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Mask, Weights
from fixture_design.tolerances import HELD

_FACES = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])


def planar_rows(
    points: Float[np.ndarray, "*k 2"], normals: Float[np.ndarray, "*k 2"], length: float
) -> Float[np.ndarray, "*k 3"]:
    """[n; x X n / length] for points from the reference point [m] and unit normals."""
    moments = points[..., 0] * normals[..., 1] - points[..., 1] * normals[..., 0]
    return np.concatenate([normals, moments[..., None] / length], axis=-1)


def locating(rows: Float[np.ndarray, "k 3 3"]) -> Mask:
    """Whether three contacts determine the part's place: their face of the tetrahedron is away from the origin."""
    return _face_distances(rows) > HELD


def closing(locators: Float[np.ndarray, "k 3 3"], clamps: Float[np.ndarray, "k 3"]) -> Mask:
    """Whether the clamp's row is in the open cone opposite to the three locators' rows: all w < 0."""
    return np.asarray((clamp_weights(locators, clamps) < 0).all(axis=1))


def clamp_weights(locators: Float[np.ndarray, "k 3 3"], clamps: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 3"]:
    """w of d_4 = sum w_i d_i, by Cramer's rule; -w are the locators' forces for a unit one at the clamp."""
    first, second, third = locators[:, 0], locators[:, 1], locators[:, 2]
    faces = [np.cross(second, third), np.cross(third, first), np.cross(first, second)]
    volume = np.einsum("kj,kj->k", first, faces[0])
    return np.stack([np.einsum("kj,kj->k", clamps, face) / volume for face in faces], axis=1)


def margins(rows: Float[np.ndarray, "k 4 3"]) -> Weights:
    """s of four rows that close: the distance of the tetrahedron's nearest face from the origin."""
    return np.min([_face_distances(rows[:, face]) for face in _FACES], axis=0)


def _face_distances(rows: Float[np.ndarray, "k 3 3"]) -> Weights:
    """Distance of the plane through three points from the origin; zero where they have none."""
    across = np.cross(rows[:, 1] - rows[:, 0], rows[:, 2] - rows[:, 0])
    area = np.maximum(np.linalg.norm(across, axis=1), np.finfo(np.float64).tiny)
    return np.abs(np.einsum("kj,kj->k", rows[:, 0], across)) / area
