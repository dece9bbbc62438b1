"""How well a grasp stands errors of the part's pose: in which share of them the fingers still close.

The part is moved a little at random while the hand stays; every fingertip then gives way along its normal, until it
touches what is nearest, as far as its joints have travel left. Of pads, which give way to a small tilt, the corners are
looked at, or a grid where they overhang. Closed is what `design` calls so while it searches: rows of the friction
cones' edges that close.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float

from fixture_design.cones.kernel import closure_test
from fixture_design.contacts import Contact, torsion_of_patch, unit_normal
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry.surface import SolidSurface
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.stops import Travel
from fixture_design.grasp.wrenches import pushes_of
from fixture_design.layout import Pose
from fixture_design.tolerances import FINGER_GAP

#: Poses looked at to choose among grasps; and others for what is told of those that are kept, as the best of many looks
#: better than it is at the poses that it was chosen by. Where all or none of the first ones close, these are enough.
POSES, POSES_TOLD = 32, 128

#: Corners of a pad that count: a little inside of it [-].
_CORNER = 0.4

#: Where a pad is looked at that overhangs the part: these parts of the way to its corners [-].
_GRID = (-1.0, -0.6, -0.2, 0.2, 0.6, 1.0)

#: A pad gives way to a tilt up to this [rad], everything gives way up to this much besides the error itself [m].
_TILT, _GIVES = 0.15, 2e-3

#: A normal is seen from this far off the surface [m], to this much of its cosine [-].
_SEEN_FROM, _SEEN_TO = 1e-6, 1e-3


@dataclass(frozen=True)
class PoseError:
    """Standard deviations of the part's position [m], each coordinate, and of its rotation [rad], about each axis."""

    position: float = 1e-3
    rotation: float = 0.02


def robust_share(
    posture: Posture,
    X_WP: Pose,
    surface: SolidSurface,
    tips: Sequence[Fingertip],
    error: PoseError,
    seed: int,
    told: bool = False,
) -> float:
    """The share of pose errors at which some fingertips still close; 0 without any.

    Args:
        told: at more poses, and others than those that a choice was made by.
    """
    rng = np.random.default_rng((seed, int(told)))
    links = posture.links()
    giving = {tip.name: _Giving(posture, Travel.of(posture, tip), error) for tip in tips}
    closed: list[bool] = []
    while len(closed) < POSES or (told and len(closed) < POSES_TOLD and not _settled(closed)):
        shift, turn = error.position * rng.standard_normal(3), error.rotation * rng.standard_normal(3)
        X_PW = composed(X_WP, _small(shift, turn, surface.geometry.box_center)).inverse()
        contacts = [
            contact
            for tip in tips
            for contact in _given_way(tip, composed(X_PW, links[tip.link]), surface, giving[tip.name])
        ]
        closed.append(_closes(contacts, surface))
    return sum(closed) / len(closed)


def _settled(closed: Sequence[bool]) -> bool:
    """Whether all or none of the first poses close."""
    return len(closed) == POSES and sum(closed) in (0, POSES)


@dataclass(frozen=True, eq=False)
class _Giving:
    """How a fingertip gives way: what its joints let it do, and the error of the part's pose that it meets."""

    posture: Posture
    travel: Travel
    error: PoseError


def _small(shift: Float[np.ndarray, 3], turn: Float[np.ndarray, 3], center: Float[np.ndarray, 3]) -> Pose:
    """A small displacement of the part in its own frame, turned about its centre."""
    turned = Pose.from_xyz_rpy(np.zeros(3), turn)
    return Pose(turned.rotation, center - turned.rotation @ center + shift)


def _given_way(tip: Fingertip, X_PL: Pose, surface: SolidSurface, giving: _Giving) -> list[Contact]:
    """The contacts of a fingertip that gives way until it touches; in P.

    A pad has as many as it has corners on the surface; where these are fewer than three, as it overhangs, as many as
    it has points of a grid there, and in its middle one with the patch of its skin.
    """
    if tip.pad is None:
        return _contacts_at(tip, [np.zeros(3)], X_PL, surface, giving)
    found = _contacts_at(tip, _on_pad(tip, (-1.0, 1.0)), X_PL, surface, giving)
    if len(found) >= 3:
        return found
    grid = _contacts_at(tip, _on_pad(tip, _GRID), X_PL, surface, giving)
    return grid + _contacts_at(tip, [np.zeros(3)], X_PL, surface, giving)


def _on_pad(tip: Fingertip, steps: Sequence[float]) -> list[Float[np.ndarray, 3]]:
    """Points of a pad from its middle, at these parts of the way to its corners' both ways."""
    assert tip.pad is not None
    wide, high = _CORNER * tip.pad[0] * tip.sideways, _CORNER * tip.pad[1] * tip.across
    return [u * wide + v * high for u, v in product(steps, repeat=2)]


def _contacts_at(
    tip: Fingertip,
    corners: Sequence[Float[np.ndarray, 3]],
    X_PL: Pose,
    surface: SolidSurface,
    giving: _Giving,
) -> list[Contact]:
    """The contacts of some points of a fingertip, given from its ``at``."""
    facing = X_PL.vectors(tip.facing[None])[0]
    steepest = -np.cos(_TILT if tip.pad is not None else tip.spread)
    single = len(corners) == 1
    size = 0.0 if tip.pad is None else _CORNER * float(np.hypot(*tip.pad))
    error, travel = giving.error, giving.travel
    gives = (_GIVES if single else _GIVES / 4) + 3 * error.position + 3 * error.rotation * size
    # what is further ahead or behind is not reached, but for what a skin gives way
    ahead, behind = min(gives, travel.closing + FINGER_GAP), min(gives, travel.opening + FINGER_GAP)
    friction = giving.posture.model.hand.friction if tip.friction is None else tip.friction
    torsion = torsion_of_patch(tip.soft) if tip.soft is not None and single else 0.0
    found = []
    places = X_PL.points(tip.at + np.array(corners))
    surface.look(places)
    for place in places:
        distance, foot = surface.nearest(place)
        if not -behind <= distance - tip.radius <= ahead or _faces_away(place - foot, distance, facing, steepest):
            continue
        try:
            local = surface.local(foot)
        except (GeometryError, UnsupportedError):  # no place to touch: this corner does not count
            continue
        normal = unit_normal(local.clauses[0][0])
        if local.shape == "flat" and normal @ facing <= steepest:
            found.append(Contact(tip.name, "finger", foot, ((normal,),), friction, torsion=torsion))
    return found


def _faces_away(away: Float[np.ndarray, 3], distance: float, facing: Float[np.ndarray, 3], steepest: float) -> bool:
    """Whether a place off the surface shows already that the normal there is too far from facing the finger.

    The normal is along the way to the foot, if this is as long as the distance: on round surfaces the foot may be on
    the true surface and the distance that to a facet.
    """
    seen = abs(distance) > _SEEN_FROM and abs(float(np.linalg.norm(away)) - abs(distance)) <= _SEEN_FROM / 10
    return bool(seen and away @ facing / distance > steepest + _SEEN_TO)


def _closes(contacts: Sequence[Contact], surface: SolidSurface) -> bool:
    if not contacts:
        return False
    rows = pushes_of(contacts, surface.geometry.box_center).wrenches.copy()
    rows[:, 3:] /= surface.half_diagonal
    return closure_test(-rows / np.linalg.norm(rows, axis=1, keepdims=True)).closes is True
