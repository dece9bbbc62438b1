"""Where circles touch planes, cylinders, cones and circles: gaps, normals and points, for many placements at once.

Every function returns `Touch` with the gap measured along a common normal of both surfaces. Rigid motions of one body
then change it by [n; arm X n] exactly: that the point moves along the features adds nothing, as they are square to n.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fixture_design.assembly.circles import ALONG, Circles, Cones, crossed, dots, lengths_of
from fixture_design.assembly.nearest_places import nearest_angles
from fixture_design.assembly.touch import Touch

#: Second derivatives below this, relative to the circle's, are those of a circle all of which is as near [-].
_FLAT = 1e-9


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
