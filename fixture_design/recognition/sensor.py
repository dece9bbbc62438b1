"""From the sensor to the part: where the sensor sits, and what it shows without a load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, read_only
from fixture_design.contacts import cross
from fixture_design.errors import InputError
from fixture_design.layout import Pose
from fixture_design.recognition.numbers_of import numbers_of


@dataclass(frozen=True, eq=False)
class Sensor:
    """What makes wrenches and twists of the sensor frame S those of the classifier.

    Attributes:
        pose: X_PS, the sensor in the frame of the moving part's origin and the classifier's axes.
        tare: the sensor's wrench without a load, in S, shape (3,) or (6,); taken off all others.
    """

    pose: Pose
    tare: Rows | np.ndarray

    @classmethod
    def of(cls, plane: int, pose: Pose | None = None, tare: ArrayLike | None = None) -> Sensor:
        """A sensor; without a pose it sits in the part's origin, without a tare it shows zero.

        Raises:
            InputError: numbers that do not fit.
        """
        if plane not in (2, 3):
            raise InputError("a sensor is planar or spatial", found=f"plane {plane}", expected="2 or 3")
        size = 3 * (plane - 1)
        zero = np.zeros(size) if tare is None else numbers_of(tare, "a tare")
        if zero.shape != (size,) or not np.isfinite(zero).all():
            raise InputError(f"a tare is {size} finite numbers here", found=str(zero.tolist()))
        return cls(Pose.identity(plane) if pose is None else pose, read_only(zero))

    def wrenches(self, p_S: Rows) -> Rows:
        """[R f; R m + x X R f] of tared wrenches, shape (n, d), with x and R of the pose."""
        tared = p_S - self.tare
        plane = len(self.pose.translation)
        forces, moments = tared[:, :plane] @ self.pose.rotation.T, self._turned(tared[:, plane:])
        levers = np.repeat(self.pose.translation[None], len(forces), axis=0)
        return np.concatenate([forces, moments + cross(levers, forces)], axis=1)

    def twists(self, v_S: Rows) -> Rows:
        """[R dx - dtheta X x; dtheta] with dtheta = R dtheta_S: the displacement of the part's origin, (n, d)."""
        plane = len(self.pose.translation)
        moved, turns = v_S[:, :plane] @ self.pose.rotation.T, self._turned(v_S[:, plane:])
        x = self.pose.translation
        if plane == 2:
            back = turns * np.array([-x[1], x[0]])
        else:
            back = cross(turns, np.repeat(x[None], len(turns), axis=0))
        return np.concatenate([moved - back, turns], axis=1)

    def _turned(self, rows: Rows) -> Rows:
        return rows if rows.shape[1] == 1 else rows @ self.pose.rotation.T
