"""Where to look from: the corner of the room from which most elements are in front, as near as all of it is seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Space
from fixture_design.viewing.scene.scene import Camera
from fixture_design.viewing.scene.shapes import Points3, Vector3
from fixture_design.viewing.scene.space import lifted

#: Height of the view [rad], width for its height, and how much of it is left free [-].
_FOV, ASPECT, _FREE = float(np.radians(32)), 1.25, 0.06
#: How often the middle is looked for.
_ROUNDS = 6
#: Elevations of the corners of the room [rad]; in the plane it is looked at from this far off straight above.
_ELEVATION, _PLANAR_TILT = float(np.radians(28)), float(np.radians(28))
#: Azimuths, in order of preference [rad].
_AZIMUTHS = tuple(np.radians([-58.0, -32.0, -122.0, -148.0, 32.0, 58.0, 122.0, 148.0]))


def camera_of(space: Space, contacts: Sequence[Contact], seen: Points3, center: Vector3) -> Camera:
    """A camera that has all points in view.

    Args:
        seen: shape (n, 3), in W [m].  center: what is looked at.
    """
    if space == "planar":
        away, up = np.array([0.0, -np.sin(_PLANAR_TILT), np.cos(_PLANAR_TILT)]), np.array([0.0, 1.0, 0.0])
    else:
        normals = [lifted(unit_normal(normal)) for contact in contacts for normal in contact.normals]
        directions = [_direction(azimuth) for azimuth in _AZIMUTHS]
        fronts = [sum(max(float(normal @ way), 0.0) for normal in normals) for way in directions]
        away, up = directions[int(np.argmax(np.round(fronts, 6)))], np.array([0.0, 0.0, 1.0])
    return aimed(Camera(center + away, center, up, _FOV), seen)


def aimed(camera: Camera, seen: Points3) -> Camera:
    """A camera that looks the same way and has other points in view, in its middle and as near as they fit."""
    away = (camera.eye - camera.target) / np.linalg.norm(camera.eye - camera.target)
    right = np.cross(camera.up, away)
    right /= np.linalg.norm(right)
    axes = np.array([right, np.cross(away, right), away])
    points = (seen - camera.target) @ axes.T
    middle, distance = np.zeros(3), _distance(points)
    for _ in range(_ROUNDS):  # to the middle of what is seen, which is then seen from nearer
        image = points[:, :2] / (distance - points[:, 2])[:, None]
        middle[:2] = (image.max(axis=0) + image.min(axis=0)) / 2 * distance
        distance = _distance(points - middle)
    target = camera.target + middle @ axes
    return Camera(target + distance * away, target, camera.up, camera.fov)


def _direction(azimuth: float) -> Vector3:
    return np.array([np.cos(_ELEVATION) * np.cos(azimuth), np.cos(_ELEVATION) * np.sin(azimuth), np.sin(_ELEVATION)])


def _distance(points: Points3) -> float:
    """The least d from which points (x right, y up, z near) are in view: |x| <= tan(fov / 2) aspect (d - z)."""
    half = np.tan(_FOV / 2) * (1 - _FREE)
    return float((np.abs(points[:, :2]) / half / [ASPECT, 1.0] + points[:, 2:]).max())
