"""Poses in space and in the plane, in Drake's monogram notation: X_WP takes coordinates in P to coordinates in W."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.arrays import ArrayLike, Point, Points, read_only


@dataclass(frozen=True, eq=False)
class Pose:
    """X_WP: p_W = R_WP p_P + p_WP, with R shape (p, p) and p_WP shape (p,), p = 2 or 3 [m]."""

    rotation: Points
    translation: Point

    @classmethod
    def identity(cls, plane: int) -> Pose:
        """The pose that changes nothing; ``plane`` is the number of coordinates, 2 or 3."""
        return cls(read_only(np.eye(plane)), read_only(np.zeros(plane)))

    @classmethod
    def from_xyz_rpy(cls, xyz: ArrayLike, rpy: ArrayLike) -> Pose:
        """As in URDF: R = Rz(yaw) Ry(pitch) Rx(roll), lengths in metres, angles in radians."""
        roll, pitch, yaw = np.asarray(rpy, dtype=np.float64)
        x_turn, y_turn, z_turn = _turn(roll, 1, 2), _turn(pitch, 2, 0), _turn(yaw, 0, 1)
        return cls(read_only(z_turn @ y_turn @ x_turn), read_only(xyz))

    @classmethod
    def from_xy_theta(cls, xy: ArrayLike, theta: float) -> Pose:
        """Planar: counter-clockwise by theta [rad], then moved by xy [m]."""
        return cls(read_only(_turn(theta, 0, 1)[:2, :2]), read_only(xy))

    def points(self, p_P: Points) -> Points:
        """Points given in P, shape (n, p), in W."""
        return p_P @ self.rotation.T + self.translation

    def vectors(self, v_P: Points) -> Points:
        """Directions given in P, shape (n, p), in W."""
        return v_P @ self.rotation.T

    def inverse(self) -> Pose:
        """X_PW."""
        return self._inverse

    @cached_property
    def _inverse(self) -> Pose:
        return Pose(read_only(self.rotation.T), read_only(-self.rotation.T @ self.translation))


def _turn(angle: float, first: int, second: int) -> Points:
    """Rotation in space from axis ``first`` towards axis ``second``."""
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix
