"""Circles and surfaces of revolution at many placements at once, and the vector products that go with them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: One vector for each placement, shape (n, 3); not checked, as it is made very often.
Placed = np.ndarray

#: Sine of the angle below which a circle lies along a plane, or two edges have no common normal [-].
ALONG = 1e-7


class Circles(NamedTuple):
    """One circle at n placements: center and unit axis, shape (n, 3), radius [m], two unit vectors across the axis."""

    center: Placed
    axis: Placed
    radius: float
    basis: tuple[np.ndarray, np.ndarray]

    @classmethod
    def around(cls, center: np.ndarray, axis: np.ndarray, radius: float) -> Circles:
        """With two unit vectors across the axis."""
        x, y, z = axis.T
        # the axis with two of its components exchanged, one with its sign: those that are not both small
        zero = np.zeros_like(x)
        first = np.where((np.abs(x) > np.abs(z))[:, None], np.stack([-y, x, zero], -1), np.stack([zero, -z, y], -1))
        first /= lengths_of(first)[:, None]
        return cls(center, axis, radius, (first, crossed(axis, first)))

    def outward(self, angles: np.ndarray) -> np.ndarray:
        """Unit vectors from the center to the points at angles (n,) or (n, m)."""
        u, v = self.basis
        if angles.ndim > 1:
            u, v = u[:, None], v[:, None]
        return np.cos(angles)[..., None] * u + np.sin(angles)[..., None] * v

    def frames(self, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outward and tangent unit vectors at angles (n,), shape (n, 3)."""
        (u, v), c, s = self.basis, np.cos(angles)[:, None], np.sin(angles)[:, None]
        return c * u + s * v, c * v - s * u

    def points(self, angles: np.ndarray) -> np.ndarray:
        center = self.center if angles.ndim == 1 else self.center[:, None]
        return center + self.radius * self.outward(angles)

    def angles_of(self, points: np.ndarray) -> np.ndarray:
        """Where points (n, 3) are around the axis."""
        u, v = self.basis
        away = points - self.center
        return np.arctan2(dots(away, v), dots(away, u))


class Cones(NamedTuple):
    """A surface of revolution with a straight generator, at n placements.

    Its points are at ``radius`` from the axis at ``origin``, growing along it; offset = c (rho - radius) - s z with
    [s, c] the generator's direction, outwards and along the axis.
    """

    origin: Placed
    axis: Placed
    radius: float
    slope: tuple[float, float]
    length: float

    def seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of points (n, 3): outward unit vectors, distance from the axis, height over the origin."""
        away = points - self.origin
        along = dots(away, self.axis)
        across = away - along[:, None] * self.axis
        rho = lengths_of(across)
        return across / np.maximum(rho, np.finfo(float).tiny)[:, None], rho, along


def crossed(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """As numpy's, many times as fast for few rows."""
    a, b, c = first[..., 0], first[..., 1], first[..., 2]
    x, y, z = second[..., 0], second[..., 1], second[..., 2]
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=-1)


def lengths_of(rows: np.ndarray) -> np.ndarray:
    return np.sqrt(dots(rows, rows))


def dots(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", first, second)
