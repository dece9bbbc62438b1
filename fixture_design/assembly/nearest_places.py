"""The places of a circle nearest to a surface of revolution, or farthest from it: up to two, by Newton steps."""

from __future__ import annotations

import numpy as np

from fixture_design.assembly.circles import Circles, Cones, dots

#: Places around a circle at which a nearest point is looked for; two nearer to each other than one step are not told
#: apart.
_AROUND = 48

#: Newton steps from there, at most.
_STEPS = 8


#: The last one leaves rounding only [rad].
_SETTLED = 1e-14


def nearest_angles(circle: Circles, cone: Cones, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Angles of the up to two places of a circle where sign * offset to a cone is least, and which exist; (n, 2)."""
    u, v = circle.basis
    away, r = circle.center - cone.origin, circle.radius
    s, c = cone.slope
    # along the axis and squared length, each k0 + k1 cos + k2 sin
    A = np.stack([dots(away, cone.axis), r * dots(u, cone.axis), r * dots(v, cone.axis)])
    B = np.stack([dots(away, away) + r * r, 2 * r * dots(away, u), 2 * r * dots(away, v)])

    def value(angles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        co, si = np.cos(angles), np.sin(angles)
        along, slope, bend = _wave(A, co, si)
        squared, rate, second = _wave(B, co, si)
        squared, rate, second = (
            squared - along**2, rate - 2 * along * slope, second - 2 * slope**2 - 2 * along * bend
        )  # fmt: skip
        rho = np.sqrt(np.maximum(squared, np.finfo(float).tiny))
        first = c * rate / (2 * rho) - s * slope
        return (
            sign * (c * rho - s * along),
            sign * first,
            sign * (c * (second / (2 * rho) - rate**2 / (4 * rho**3)) - s * bend),
        )

    step = 2 * np.pi / _AROUND
    grid = np.broadcast_to(np.arange(_AROUND) * step, (len(away), _AROUND))
    heights = value(grid)[0]
    least = (heights <= np.roll(heights, 1, axis=1)) & (heights < np.roll(heights, -1, axis=1))
    least[~least.any(axis=1), 0] = True
    order = np.argsort(np.where(least, heights, np.inf), axis=1, kind="stable")[:, :2]
    exists = np.take_along_axis(least, order, axis=1)
    angles = np.take_along_axis(grid, order, axis=1)
    for _ in range(_STEPS):
        _, first, second = value(angles)
        steepest = np.abs(first) + np.abs(second)
        by = -first / np.where(second > 0, second, np.maximum(steepest, np.finfo(float).tiny))
        angles = angles + np.clip(by, -step, step)
        if np.abs(by).max(initial=0.0) <= _SETTLED:
            break
    apart = np.abs(np.angle(np.exp(1j * (angles[:, 1] - angles[:, 0])))) > step
    exists[:, 1] &= apart & (value(angles)[2][:, 1] > 0)
    return angles, exists


def _wave(k: np.ndarray, co: np.ndarray, si: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of k0 + k1 cos + k2 sin the value and two derivatives."""
    k0, k1, k2 = k[:, :, None]
    return k0 + k1 * co + k2 * si, k2 * co - k1 * si, -k1 * co - k2 * si
