"""Where circles touch planes, cylinders, cones and circles: gaps, normals and points, for many placements at once.

Every function returns `Touch` with the gap measured along a common normal of both surfaces. Rigid motions of one body
then change it by [n; arm X n] exactly: that the point moves along the features adds nothing, as they are square to n.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

#: One vector for each placement, shape (n, 3); not checked, as it is made very often.
Placed = np.ndarray

#: Sine of the angle below which a circle lies along a plane, or two edges have no common normal [-].
ALONG = 1e-7

#: Sine of the angle between two circles where they meet below which they touch along each other rather than cross [-]:
#: what ends on them there touches as well. Far above what solved configurations leave, and below what is told apart.
ALONGSIDE = 1e-4

#: Places around a circle at which a nearest point is looked for; two nearer to each other than one step are not told
#: apart.
_AROUND = 48

#: Newton steps from there, at most, and the last one, that leaves rounding only [rad].
_STEPS = 8
_SETTLED = 1e-14

#: Second derivatives below this, relative to the circle's, are those of a circle all of which is as near [-].
_FLAT = 1e-9

#: Largest Newton step of two circles [rad].
_LARGEST_STEP = 0.5

#: Newton steps of two circles, and the share of their radius that the last one leaves where they have arrived [-].
_CROSSING_STEPS, _ARRIVED = 12, 1e-10


class Touch(NamedTuple):
    """One pair, at n placements.

    Attributes:
        gap: signed, shape (n,) [m].  normal: from the fixed to the moving body, unit, shape (n, 3).
        point: on the moving body, shape (n, 3) [m].
        beyond: how far the point is beyond the end of a feature, negative within [m].
        exists: whether there is such a place; elsewhere the pair is far apart, and the rest says where one may be.
        slide: how ``beyond`` changes with motions, [f; m] about the point, shape (n, 6): points move along circles as
            bodies turn. Of crossings only if it is wanted.
    """

    gap: np.ndarray
    normal: np.ndarray
    point: np.ndarray
    beyond: np.ndarray
    exists: np.ndarray
    slide: np.ndarray

    @staticmethod
    def ordered(found: Sequence[Touch]) -> tuple[Touch, Touch]:
        """Two places of one pair, the nearer first: what is beyond an end, or does not exist, comes last."""
        first, second = found
        distance = [np.where(t.exists, np.hypot(t.gap, np.maximum(t.beyond, 0.0)), np.inf) for t in found]
        swap = distance[1] < distance[0]
        return first.where(~swap, second), second.where(~swap, first)

    def where(self, mask: np.ndarray, other: Touch) -> Touch:
        def chosen(mine: np.ndarray, theirs: np.ndarray) -> np.ndarray:
            return np.where(mask.reshape(-1, *[1] * (mine.ndim - 1)), mine, theirs)

        return Touch(
            chosen(self.gap, other.gap), chosen(self.normal, other.normal), chosen(self.point, other.point),
            chosen(self.beyond, other.beyond), chosen(self.exists, other.exists), chosen(self.slide, other.slide),
        )  # fmt: skip


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


def on_plane(
    circle: Circles,
    normal: np.ndarray,
    offset: float,
    aside: np.ndarray,
    border: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> Touch:
    """The lowest point of a moving circle over a plane: c . n - r sqrt(1 - (a . n)^2).

    Args:
        aside: where a circle along the plane is said to touch, shape (n, 3): towards there.
        border: of points (n, 3) in the plane, how far they are beyond the facet's border, and unit vectors out of it.
    """
    out, sine = lowest(circle, normal, aside)
    gap = circle.center @ normal - offset - circle.radius * sine
    point = circle.center + circle.radius * out
    beyond, across = border(point)
    everywhere = np.ones(len(gap), dtype=bool)
    # as the body turns, the lowest point moves around the circle: d out = -(du - out (out . du)) / sine
    cosine = circle.axis @ normal
    w = (across - dots(across, out)[:, None] * out) / np.where(sine < ALONG, np.inf, sine)[:, None]
    turn = circle.radius * crossed(circle.axis, dots(w, circle.axis)[:, None] * normal + cosine[:, None] * w)
    slide = np.concatenate([across, turn - circle.radius * crossed(out, across)], axis=1)
    return Touch(gap, np.broadcast_to(normal, point.shape), point, beyond, everywhere, slide)


def lowest(circle: Circles, normal: np.ndarray, aside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From a circle's center to its lowest point, unit, and the sine of its tilt against the plane."""
    up = normal - (circle.axis @ normal)[:, None] * circle.axis
    sine = lengths_of(up)
    flat = sine < ALONG
    level = aside - dots(aside, circle.axis)[:, None] * circle.axis
    level /= np.maximum(lengths_of(level), np.finfo(float).tiny)[:, None]
    return np.where(flat[:, None], level, -up / np.where(flat, 1.0, sine)[:, None]), sine


def _slide(
    circle: Circles, angles: np.ndarray, cone: Cones, along: np.ndarray, curvature: float
) -> tuple[np.ndarray, np.ndarray]:
    """How the height along a direction of the circle's place next to a cone changes as the circle moves: [f; m].

    With x(phi) the circle, N the cone's normal and G = N . x' = 0 at the place: dphi = -dG / G', where x' turns with
    the circle and N changes around the axis: dN = (c / rho) tau (tau . dx), tau around it.
    """
    out, tangent = circle.frames(angles)
    step = circle.radius * tangent
    radial, rho, _ = cone.seen(circle.center + circle.radius * out)
    s, c = cone.slope
    normal = c * radial - s * cone.axis
    around = crossed(cone.axis, radial)
    bent = (c / rho * dots(around, step))[:, None] * around
    rate = dots(bent, step) - circle.radius * dots(normal, out)
    least = curvature * circle.radius**2 / np.maximum(rho, np.finfo(float).tiny)
    share = np.where(np.abs(rate) > least, dots(along, step) / np.where(np.abs(rate) > least, rate, 1.0), 0.0)[:, None]
    return along - share * bent, -share * crossed(step, normal)


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


def in_hole(circle: Circles, hole: Cones) -> tuple[Touch, Touch]:
    """A moving circle in a fixed cylindrical hole: the up to two places where it is farthest from the hole's axis."""
    angles, exists = nearest_angles(circle, hole, -1.0)
    found = []
    for k in range(2):
        point = circle.points(angles[:, k])
        out, rho, along = hole.seen(point)
        beyond = np.maximum(along - hole.length, -along)
        up = np.where((along - hole.length > -along)[:, None], hole.axis, -hole.axis)
        slide = np.concatenate(_slide(circle, angles[:, k], hole, up, _FLAT), axis=1)
        found.append(Touch(hole.radius - rho, -out, point, beyond, exists[:, k], slide))
    return Touch.ordered(found)


def over_rim(cone: Cones, rim: Circles) -> tuple[Touch, Touch]:
    """A moving surface over a fixed circle: the up to two places where the circle is nearest to it."""
    angles, exists = nearest_angles(rim, cone, 1.0)
    s, c = cone.slope
    found = []
    for k in range(2):
        there = rim.points(angles[:, k])
        out, rho, along = cone.seen(there)
        normal = c * out - s * cone.axis
        gap = c * (rho - cone.radius) - s * along
        share = c * along + s * (rho - cone.radius)
        beyond = np.maximum(share - cone.length, -share)
        point = there - gap[:, None] * normal
        up = np.where((share - cone.length > -share)[:, None], 1.0, -1.0) * (c * cone.axis + s * out)
        # it is the cone that moves: the circle moves the other way past it
        force, moment = _slide(rim, angles[:, k], cone, up, _FLAT)
        slide = -np.concatenate([force, moment + crossed(there - point, force)], axis=1)
        found.append(Touch(gap, -normal, point, beyond, exists[:, k], slide))
    return Touch.ordered(found)


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
