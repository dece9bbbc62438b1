"""A circular edge across the rim of a hole: places of stationary distance between two circles, by Newton steps."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fixture_design.assembly.circles import ALONG, Circles, crossed, dots, lengths_of
from fixture_design.assembly.touch import Touch

#: Sine of the angle between two circles where they meet below which they touch along each other rather than cross [-]:
#: what ends on them there touches as well. Far above what solved configurations leave, and below what is told apart.
ALONGSIDE = 1e-4

#: Largest Newton step of two circles [rad].
_LARGEST_STEP = 0.5

#: Newton steps of two circles, and the share of their radius that the last one leaves where they have arrived [-].
_CROSSING_STEPS, _ARRIVED = 12, 1e-10

#: The last Newton step, that leaves rounding only [rad].
_SETTLED = 1e-14


def crossing(circle: Circles, rim: Circles, wedge: tuple[np.ndarray, np.ndarray], slides: bool) -> tuple[Touch, Touch]:
    """A moving convex circular edge across the fixed rim of a hole: up to two places, where the circle is in its plane.

    The gap is along the common normal of both circles at their stationary distance there. A touch is beyond the end of
    the edges where this normal is outside of the normals of either, times the radius.

    Args:
        rim: its axis is out of the block; the hole is within.
        wedge: of the circle the normals of the surfaces below and above it, each [outward, along], unit.
    """
    found = [_crossing(circle, rim, wedge, start, slides) for start in _starts(circle, rim)]
    first, second = found
    together = lengths_of(first.point - second.point) <= _ARRIVED**0.5 * circle.radius
    second = second._replace(exists=second.exists & ~together)
    return Touch.ordered([first, second])


def _starts(circle: Circles, rim: Circles) -> list[np.ndarray]:
    """Angles of the circle's points in the rim's plane, or nearest to it."""
    u, v = circle.basis
    height = dots(circle.center - rim.center, rim.axis)
    a, b = circle.radius * dots(u, rim.axis), circle.radius * dots(v, rim.axis)
    most = np.maximum(np.hypot(a, b), np.finfo(float).tiny)
    middle, half = np.arctan2(b, a), np.arccos(np.clip(-height / most, -1.0, 1.0))
    level = np.hypot(a, b) < ALONG * circle.radius
    # along the plane the two circles meet, if they do, on either side of the line between their centers
    away = circle.center - rim.center
    distance = np.maximum(lengths_of(away), np.finfo(float).tiny)
    cosine = (rim.radius**2 - circle.radius**2 - distance**2) / (2 * distance * circle.radius)
    middle = np.where(level, circle.angles_of(circle.center + away), middle)
    half = np.where(level, np.arccos(np.clip(cosine, -1.0, 1.0)), half)
    return [middle + half, middle - half]


def _crossing(
    circle: Circles, rim: Circles, wedge: tuple[np.ndarray, np.ndarray], start: np.ndarray, slides: bool
) -> Touch:
    begin = angles = np.stack([start, rim.angles_of(circle.points(start))], axis=1)
    last = np.full(len(start), np.inf)
    for _ in range(_CROSSING_STEPS):
        step = _Met(circle, rim, angles).towards()
        last = np.abs(step).max(axis=1)
        angles = angles - np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)
        if last.max(initial=0.0) <= _SETTLED:
            break
    # where there is no stationary distance near by, the place in the rim's plane tells which way there may be one
    met = _Met(circle, rim, np.where((last <= _ARRIVED)[:, None], angles, begin))
    bounds = met.bounds(wedge)
    worst = bounds.argmax(axis=0)
    slide = met.slides(wedge)[worst, np.arange(len(worst))] if slides else np.zeros((len(worst), 6))
    exists = (met.sine >= ALONGSIDE) & (last <= _ARRIVED)
    beyond = circle.radius * bounds.max(axis=0)
    return Touch(dots(met.normal, met.away), met.normal, met.point, beyond, exists, circle.radius * slide)


class _Met:
    """A circle and a rim at angles around each, shape (n, 2)."""

    def __init__(self, circle: Circles, rim: Circles, angles: np.ndarray) -> None:
        self.circle, self.rim = circle, rim
        (self.mine, self.t), (self.theirs, self.tau) = circle.frames(angles[:, 0]), rim.frames(angles[:, 1])
        self.point = circle.center + circle.radius * self.mine
        self.away = self.point - rim.center - rim.radius * self.theirs

    def towards(self) -> np.ndarray:
        """The Newton step towards stationary distance, to be subtracted; infinite where there is none."""
        r, R = self.circle.radius, self.rim.radius
        slope = np.stack([r * dots(self.away, self.t), -R * dots(self.away, self.tau)], axis=1)
        return self.solved(slope)

    def solved(self, slope: np.ndarray) -> np.ndarray:
        """The inverse Hessian of half the squared distance times some slopes, shape (n, 2)."""
        r, R = self.circle.radius, self.rim.radius
        mixed = -r * R * dots(self.t, self.tau)
        h11, h22 = r * r - r * dots(self.away, self.mine), R * R + R * dots(self.away, self.theirs)
        det = h11 * h22 - mixed**2
        none = np.abs(det) < ALONG**2 * (r * R) ** 2
        columns = [h22 * slope[:, 0] - mixed * slope[:, 1], h11 * slope[:, 1] - mixed * slope[:, 0]]
        return np.where(none[:, None], np.inf, np.stack(columns, axis=1) / np.where(none, 1.0, det)[:, None])

    @cached_property
    def sine(self) -> np.ndarray:
        return lengths_of(crossed(self.t, self.tau))

    @cached_property
    def normal(self) -> np.ndarray:
        common = crossed(self.t, self.tau)
        out = dots(common, self.rim.axis - self.theirs)
        return common * (np.where(out < 0, -1.0, 1.0) / np.where(self.sine < ALONG, 1.0, self.sine))[:, None]

    def bounds(self, wedge: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Sines, shape (4, n), of how far the common normal is out of the normals of the rim, and of the circle."""
        n, (low, high) = self.normal, wedge
        out, up = -dots(n, self.mine), -dots(n, self.circle.axis)
        own = [low[1] * out - low[0] * up, high[0] * up - high[1] * out]
        return np.array([-dots(n, self.rim.axis), dots(n, self.theirs), *own])

    def slides(self, wedge: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """How these change with the motion of the circle, [f; m] about the point, shape (4, n, 6)."""
        found = [self._rates(wedge, *np.split(motion, 2)) for motion in np.eye(6)]
        return np.where(np.isfinite(found), found, 0.0).transpose(1, 2, 0)

    def _rates(self, wedge: tuple[np.ndarray, np.ndarray], dx: np.ndarray, turn: np.ndarray) -> np.ndarray:
        r, R, (low, high), n = self.circle.radius, self.rim.radius, wedge, self.normal
        turned = crossed(turn, self.t)
        slope = np.stack([r * (self.t @ dx + dots(self.away, turned)), -R * (self.tau @ dx)], axis=1)
        with np.errstate(invalid="ignore"):
            around = -self.solved(slope)
            dt = turned - around[:, :1] * self.mine
            rate = crossed(dt, self.tau) - around[:, 1:] * crossed(self.t, self.theirs)
            side = np.where(dots(crossed(self.t, self.tau), n) < 0, -1.0, 1.0) / np.where(
                self.sine < ALONG, np.inf, self.sine
            )
            dn = (rate - dots(rate, n)[:, None] * n) * side[:, None]
            out = -dots(dn, self.mine) - dots(n, crossed(turn, self.mine))
            up = -dots(dn, self.circle.axis) - dots(n, crossed(turn, self.circle.axis))
            own = [low[1] * out - low[0] * up, high[0] * up - high[1] * out]
            return np.array([-dots(dn, self.rim.axis), dots(dn, self.theirs), *own])
