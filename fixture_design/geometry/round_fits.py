"""Least-squares fits of round surfaces to the vertices of facets.

A mesh of a round surface has its vertices on it, up to rounding; its facets' normals are those of chords and only
serve for a first guess. From there Gauss-Newton minimises the distances of the vertices.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, Vector, cross_products
from fixture_design.contacts import tangents
from fixture_design.geometry.shapes import Directions, FacetVectors, Vector3
from fixture_design.geometry.smooth_surface import RoundKind, RoundShape, SeenFromAxis

#: How far off points of size one may still be before each step of Gauss-Newton, and the step that is none [-].
_OFF_AFTER_STEPS, _CONVERGED = (0.2, 0.1, 3e-2, 1e-2, 1e-3, 1e-3, 1e-3, 1e-3), 1e-11
#: Steps of numerical differences of normals, and singular values that count as none, for points of size one [-].
_DIFFERENCE, _NO_SAY = 1e-6, 1e-7
_TINY = 1e-300
#: What the points of a surface must determine: its parameters without those that move it along itself.
_FREEDOMS: dict[RoundKind, int] = {"cylinder": 5, "cone": 6, "sphere": 4, "torus": 7}
#: Points this many offsets from the axis of a cone are its apex [-].
_AT_APEX = 10.0
#: Offsets this many times the noise are no noise [-]: three coordinates rounded at once make up to the root of three.
_MORE_THAN_NOISE = 2.0
#: Fits with a radius beyond so many times the points' size are planes [-].
_FLAT = 50.0


@dataclass(frozen=True, eq=False)
class Patch:
    """What a fit is made to: vertices, shape (n, 3), and the unit normals and middles of facets, shape (f, 3)."""

    points: Directions
    normals: FacetVectors
    middles: FacetVectors


def fitted(kind: RoundKind, patch: Patch) -> RoundShape | None:
    """The surface of a kind that is nearest to the patch's points; None where a guess or the fit fails.

    Whether it is near enough is for the caller to judge, by its offsets.
    """
    center = patch.points.mean(axis=0)
    size = float(np.linalg.norm(np.ptp(patch.points, axis=0)))
    unit = Patch((patch.points - center) / size, patch.normals, (patch.middles - center) / size)
    guess = _GUESSES[kind](unit)
    shape = None if guess is None else refined(guess, unit.points)
    if shape is None:
        return None
    radius = shape.radius if kind == "cone" else shape.radius * size
    return RoundShape(kind, shape.point * size + center, shape.axis, radius, shape.ring * size)


def refitted(shape: RoundShape, points: Directions) -> RoundShape | None:
    """The surface nearest to points, from one that is near; None if it leaves what makes sense."""
    center, size = points.mean(axis=0), float(np.linalg.norm(np.ptp(points, axis=0)))
    radius = shape.radius if shape.kind == "cone" else shape.radius / size
    unit = RoundShape(shape.kind, (shape.point - center) / size, shape.axis, radius, shape.ring / size)
    found = refined(unit, (points - center) / size) if _sensible(unit) else None
    if found is None:
        return None
    radius = found.radius if found.kind == "cone" else found.radius * size
    return RoundShape(found.kind, found.point * size + center, found.axis, radius, found.ring * size)


def refined(shape: RoundShape, points: Directions) -> RoundShape | None:
    """Gauss-Newton on the distances of the points, which have size one; None if it leaves what makes sense.

    A guess of the right kind is near; what is still off after a few steps is of another kind.
    """
    for limit in _OFF_AFTER_STEPS:
        seen = shape.seen(points)
        offsets = shape.offsets_at(seen)
        if np.abs(offsets).max() > limit:
            return None
        step = np.linalg.lstsq(jacobian(shape, seen), -offsets, rcond=_NO_SAY)[0]
        shape = _moved(shape, step)
        if not _sensible(shape):
            return None
        if np.abs(step).max() < _CONVERGED:
            break
    return shape


def jacobian(shape: RoundShape, seen: SeenFromAxis) -> Float[np.ndarray, "n k"]:
    """Derivatives of points' offsets by the shape's parameters: point, two tilts of the axis, radius, ring.

    Moving or turning the shape is moving the points the other way, and an offset grows along its direction.
    """
    out = shape.directions_at(seen)
    rows = np.empty((len(out), 7 if shape.kind == "torus" else 6))
    rows[:, :3] = -out
    # to tilt towards one tangent is to turn about the other, and out . (turn X away) = (away X out) . turn
    first, second = tangents(shape.axis)
    rows[:, 3:5] = -cross_products(seen.away, out) @ np.column_stack([second, -first])
    if shape.kind == "cone":
        rows[:, 5] = -seen.across * np.sin(shape.radius) - seen.along * np.cos(shape.radius)
    else:
        rows[:, 5] = -1.0
    if shape.kind == "torus":
        rows[:, 6] = -np.einsum("ij,ij->i", out, seen.outward) / np.maximum(seen.across, _TINY)
    return rows


def normal_error(
    shape: RoundShape, points: Directions, where: FacetVectors, off: float, noise: float, width: float
) -> float:
    """How far normals at some places of a fitted surface may be off [rad]; infinite if the points leave it open.

    The parameters' covariance from the fit, carried over to the normals. Where the points are off by no more than their
    noise, by three standard deviations: a crown or taper that is lost in the noise is not told from none. Else the
    surface is not quite of this kind, all may be off one way, which the square root of their number allows for, and the
    surface may wave by as much from facet to facet.

    Args:
        points: that were fitted.  where: the places.
        off: largest offset of the points [m].  noise: how well they are known [m].  width: of the narrowest facet [m].
    """
    center, size = points.mean(axis=0), float(np.linalg.norm(np.ptp(points, axis=0)))
    radius = shape.radius if shape.kind == "cone" else shape.radius / size
    unit = RoundShape(shape.kind, (shape.point - center) / size, shape.axis, radius, shape.ring / size)
    rows = jacobian(unit, unit.seen((points - center) / size))
    if shape.kind == "cone" and (shape.reaches(points) <= _AT_APEX * max(off, noise)).any():
        # a vertex at the apex is there in all three directions, though its distance from the surface has no slope
        rows = np.vstack([rows, np.eye(3, 6)])
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    counted = values > _NO_SAY * values[0]
    if counted.sum() < _FREEDOMS[shape.kind]:
        return np.inf
    systematic = off > _MORE_THAN_NOISE * noise
    deviations = max(3.0, np.sqrt(len(points))) if systematic else 3.0
    ways = right[counted] / values[counted, None] * (deviations * max(off, noise) / size)
    places = (where - center) / size
    # a step that is small against the shape, whatever the error is
    reach = [_DIFFERENCE / max(float(np.abs(way).max()), _TINY) for way in ways]
    turns = [
        np.linalg.norm(_moved(unit, way * r).directions(places) - unit.directions(places), axis=1) / r
        for way, r in zip(ways, reach, strict=True)
    ]
    waves = 2 * off / width if systematic else 0.0
    return float(np.linalg.norm(turns, axis=0).max()) + waves


def _moved(shape: RoundShape, step: Vector) -> RoundShape:
    first, second = tangents(shape.axis)
    axis = shape.axis + step[3] * first + step[4] * second
    ring = shape.ring + (step[6] if len(step) > 6 else 0.0)
    return RoundShape(
        shape.kind, shape.point + step[:3], axis / np.linalg.norm(axis), shape.radius + float(step[5]), float(ring)
    )


def _sensible(shape: RoundShape) -> bool:
    if shape.kind == "cone":
        return bool(1e-3 < shape.radius < np.pi / 2 - 1e-3 and np.abs(shape.point).max() < _FLAT)
    return bool(0 < shape.radius < _FLAT and 0 <= shape.ring < _FLAT and np.abs(shape.point).max() < 2 * _FLAT)


def _sphere(patch: Patch) -> RoundShape | None:
    """|x|^2 = 2 c . x + (R^2 - |c|^2), linear in c and the bracket."""
    found = _ball(patch.points)
    return None if found is None else RoundShape("sphere", found[0], np.array([0.0, 0.0, 1.0]), found[1])


def _cylinder(patch: Patch) -> RoundShape | None:
    """The axis is square to all normals; the vertices seen along it lie on a circle."""
    axis = np.linalg.svd(patch.normals)[2][-1]
    return _around(patch, axis)


def _around(patch: Patch, axis: Vector3) -> RoundShape | None:
    frame = np.array(tangents(axis))
    found = _ball(patch.points @ frame.T)
    return None if found is None else RoundShape("cylinder", found[0] @ frame, axis, found[1])


def _cone(patch: Patch) -> RoundShape | None:
    """Normals make one angle with the axis; the facets' planes meet in the apex."""
    axis = np.linalg.svd(patch.normals - patch.normals.mean(axis=0))[2][-1]
    heights = np.einsum("ij,ij->i", patch.normals, patch.middles)
    apex = np.linalg.lstsq(patch.normals, heights, rcond=_NO_SAY)[0]
    away = patch.points - apex
    along = away @ axis
    if along.sum() < 0:
        axis, along = -axis, -along
    across = np.linalg.norm(away - np.outer(along, axis), axis=1)
    guess = RoundShape("cone", apex, axis, float(np.arctan2(across.sum(), along.sum())))
    return guess if _sensible(guess) else None


def _torus(patch: Patch) -> RoundShape | None:
    """All normals meet the axis: m . a + n . (a's moment) = 0, with m = x X n; then a circle in the half plane."""
    rows = np.hstack([cross_products(patch.middles, patch.normals), patch.normals])
    line = np.linalg.svd(rows)[2][-1]
    length = float(np.linalg.norm(line[:3]))
    if length < _NO_SAY:
        return None
    axis, moment = line[:3] / length, line[3:] / length
    point = cross_products(axis, moment)
    away = patch.points - point
    along = away @ axis
    across = np.linalg.norm(away - np.outer(along, axis), axis=1)
    found = _ball(np.column_stack([across, along]))
    if found is None:
        return None
    (ring, height), radius = found
    guess = RoundShape("torus", point + height * axis, axis, radius, float(ring))
    return guess if _sensible(guess) else None


def _ball(points: Float[np.ndarray, "n p"]) -> tuple[Point, float] | None:
    """Centre and radius of the circle or sphere through points, by least squares; None if they are in a line."""
    rows = np.column_stack([2 * points, np.ones(len(points))])
    solution, _, rank, _ = np.linalg.lstsq(rows, np.sum(points**2, axis=1), rcond=_NO_SAY)
    center = solution[:-1]
    square = float(solution[-1] + center @ center)
    return (center, float(np.sqrt(square))) if rank == rows.shape[1] and square > 0 else None


_GUESSES: dict[RoundKind, Callable[[Patch], RoundShape | None]] = {
    "cylinder": _cylinder,
    "cone": _cone,
    "sphere": _sphere,
    "torus": _torus,
}
