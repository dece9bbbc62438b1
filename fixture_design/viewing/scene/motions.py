"""Motions to see: the way as an arrow, a turn as an arc about its axis, a screw as both; and the part moving so.

Evidence is a displacement to first order. It is followed as the one screw motion that begins with it, as far as can be
seen and no further: a picture of a direction, not of how far the part really gets.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.layout import Pose
from fixture_design.viewing.palette import LOAD, MOTION
from fixture_design.viewing.scene.arrows import bent_along, bent_arrow
from fixture_design.viewing.scene.drawn_sizes import NEAR_AXIS, SHOWN, SHOWN_ANGLE, THICK, THIN, TURN, WAY
from fixture_design.viewing.scene.scene import Animation, Thing
from fixture_design.viewing.scene.shapes import Arrow, Cylinder, Mesh, Points3, Vector3
from fixture_design.viewing.scene.space import Twist

#: Steps of an animation, and how long it takes one way [s].
_STEPS, _SECONDS = 12, 1.4

#: Points of a curved way; how much slower or less square to a motion a surface may be and still be pushed at [-].
_PATH, _ALIKE = 40, 0.05


def screw_pose(twist: Twist, amount: float) -> Pose:
    """The screw motion that begins with a displacement, followed for ``amount``: exp(amount [dx; dtheta]).

    R by Rodrigues' formula; p = (a 1 + (1 - cos(a w)) / w K + (a - sin(a w) / w) K^2) dx, with a the amount,
    w = |dtheta| and K the cross product with dtheta / w.
    """
    turn = float(np.linalg.norm(twist.about))
    if turn == 0:
        return Pose(np.eye(3), amount * twist.along)
    x, y, z = twist.about / turn
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = amount * turn
    rotation = np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew
    # 1 - cos by half the angle: small turns are translations, without cancellation
    moved = (
        amount * np.eye(3) + 2 * np.sin(angle / 2) ** 2 / turn * skew + (amount - np.sin(angle) / turn) * skew @ skew
    )
    return Pose(rotation, moved @ twist.along)


def shown_amount(twist: Twist, vertices: Points3, size: float) -> float:
    """How far a displacement is followed to be seen: the farthest point by a part of the size, turns by little."""
    speeds = np.linalg.norm(twist.along + np.cross(twist.about, vertices), axis=1)
    amount = SHOWN * size / float(speeds.max())
    turn = float(np.linalg.norm(twist.about))
    return min(amount, SHOWN_ANGLE / turn) if turn > 0 else amount


def motion_animation(twist: Twist, amount: float, path: str = "part", both_ways: bool = False) -> Animation:
    """The part along the motion and back."""
    poses = tuple(screw_pose(twist, amount * k / _STEPS) for k in range(_STEPS + 1))
    return Animation(path, poses, _SECONDS, both_ways)


def motion_things(path: str, twist: Twist, center: Vector3, size: float) -> Iterator[Thing]:
    """An arrow through the part's middle, or an arc around the axis with the axis; a screw's arc climbs.

    Args:
        center, size: the part's middle and half diagonal [m].
    """
    if twist.is_straight(center, size):
        way = twist.at(center)
        way = way / np.linalg.norm(way)
        yield Thing(f"{path}/way", Arrow(center, center + WAY * size * way, 1.4 * THICK * size), MOTION)
        return
    turn = float(np.linalg.norm(twist.about))
    axis = twist.about / turn
    velocity = twist.at(center)
    on_axis = center + np.cross(twist.about, velocity) / turn**2
    if np.linalg.norm(on_axis - center) > NEAR_AXIS * size:
        yield Thing(f"{path}/way", bent_along(_path_of(twist, center, size), 1.4 * THICK * size), MOTION)
        return
    pitch = float(twist.about @ velocity) / turn**2
    half = 1.3 * size * axis
    yield Thing(f"{path}/axis", Cylinder(on_axis - half, on_axis + half, THIN * size), MOTION)
    climb = float(np.clip(1.5 * np.pi * pitch, -size, size))
    yield Thing(f"{path}/turn", bent_arrow(on_axis, axis, TURN * size, 1.4 * THICK * size, climb), MOTION)


def _path_of(twist: Twist, point: Vector3, size: float) -> Points3:
    """Where the screw motion takes a point, along an arc as long as a straight motion's arrow."""
    amounts = np.linspace(0.0, WAY * size / float(np.linalg.norm(twist.at(point))), _PATH)
    return np.vstack([screw_pose(twist, amount).points(point[None]) for amount in amounts])


def smallest_push(path: str, twist: Twist, surface: Mesh, size: float) -> Iterator[Thing]:
    """A push along the motion from outside, where the surface faces it most and is fastest: the smallest will do."""
    corners = surface.vertices[surface.triangles]
    middles = corners.mean(axis=1)
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(areas, axis=1)
    velocities = twist.along + np.cross(twist.about, middles)
    facing = -np.einsum("ij,ij->i", areas, velocities) / np.where(sizes > 0, sizes, 1.0)
    # of triangles that are as good the largest, whose middle is furthest from edges
    best = int(np.argmax(np.where(facing > (1 - _ALIKE) * facing.max(), sizes, -1.0)))
    unit = velocities[best] / np.linalg.norm(velocities[best])
    yield Thing(f"{path}/disturbance", Arrow(middles[best] - 0.4 * size * unit, middles[best], THICK * size), LOAD)
