"""Whether the fingertips that a hand file gives are on their links: what is not there touches nothing.

Looked at are the foremost point of a point or ball, ``at`` + radius * ``facing``, and of a pad its middle and corners.
Each must be on the surface of its link, or of what that is welded to; or on the hull of one of these, since a pad may
stand for small shapes in front of a link. A step along ``facing`` must lead away from the link.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Weights
from fixture_design.errors import format_length
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.hand import Fingertip, HandError
from fixture_design.grasp.link_geometry import LinkGeometry
from fixture_design.layout import Pose
from fixture_design.tolerances import FINGER_GAP, TIP_OFF_LINK

if TYPE_CHECKING:
    from fixture_design.grasp.hand_model import HandModel

#: A step along ``facing`` must lead at least this part of it away from the link [-]: of a pad, which is flat, nearly
#: all; a point or ball may look along its link, but not into it.
_PAD_RISES, _RISES = 0.9, -0.1

#: Lengths of fingertips of real hands [m]: what is beyond may be of another unit.
_REAL = (1e-3, 0.5)

#: Corners of a pad may hang over its link by this part of the pad's smaller side [-], and no more than this [m]: faces
#: are rounded and chamfered.
_OVERHANG, _MOST_OVERHANG = 0.2, 5e-3

_ON_LINK = "`at`, ball and pad on the link's collision shapes, in the link's frame"


def check_tips(model: HandModel) -> tuple[str, ...]:
    """What there is to say about fingertips that are a little off their links.

    Raises:
        HandError: a fingertip's link is made of nothing, or it is off its link, or it looks into it.
    """
    return tuple(note for tip in model.hand.fingertips for note in _checked(tip, model))


def _checked(tip: Fingertip, model: HandModel) -> Iterator[str]:
    source, place = model.hand.source, f"fingertip {tip.name!r}"
    skin = _Skin.of(model, tip.link)
    if not skin.parts:
        expected = "a link with collision shapes, or one that is welded to such"
        raise HandError(f"link {tip.link!r} is made of nothing", source=source, place=place, expected=expected)
    points = np.array(list(_points(tip)))
    off, what, most = _farthest(skin, tip, points)
    rises = _PAD_RISES if tip.pad is not None else _RISES
    if skin.off(points[:1])[0] <= TIP_OFF_LINK and (rise := skin.rise(points[0], tip.facing)) < rises:
        how = "into" if rise < _RISES else "along"
        problem = f"its `facing` looks {how} link {tip.link!r}"
        raise HandError(problem, source=source, place=place, expected="a direction out of the link, towards the part")
    if off > most:
        problem, expected = f"{what} is {format_length(off)} off link {tip.link!r}", f"at most {format_length(most)}"
        raise HandError(problem, source=source, place=place, expected=f"{expected}: {_cause(skin, tip)}")
    size = tip.radius if tip.pad is None else min(tip.pad)
    if 0 < size < _REAL[0]:
        yield f"fingertip {tip.name!r} is only {format_length(size)} large: check `units`"
    if off > FINGER_GAP:
        yield f"fingertip {tip.name!r}: {what} is {format_length(off)} off link {tip.link!r}, and taken as it is given"


def _points(tip: Fingertip) -> Iterator[Float[np.ndarray, 3]]:
    yield tip.at + tip.radius * tip.facing
    if tip.pad is not None:
        for u, v in product((-0.5, 0.5), repeat=2):
            yield tip.at + u * tip.pad[0] * tip.sideways + v * tip.pad[1] * tip.across


def _farthest(skin: _Skin, tip: Fingertip, points: Float[np.ndarray, "n 3"]) -> tuple[float, str, float]:
    """How far off the worst of its points is, what that is, and how far it may be [m]; corners last."""
    off = skin.off(points)
    if tip.pad is None:
        return float(off[0]), "its `at`" if tip.ball is None else "the foremost point of its ball", TIP_OFF_LINK
    if off[0] > TIP_OFF_LINK:
        return float(off[0]), "the middle of its pad", TIP_OFF_LINK
    over = min(_OVERHANG * min(tip.pad), _MOST_OVERHANG)
    return float(off.max()), "a corner of its pad", max(TIP_OFF_LINK, over)


def _cause(skin: _Skin, tip: Fingertip) -> str:
    """What is likely wrong: where lengths of another unit fit, the unit."""
    largest = max(float(np.abs(tip.at).max()), tip.radius, *(tip.pad or (0.0,)))
    if largest > _REAL[1] and _fits(skin, _scaled(tip, 1e-3)):
        return "these look like millimetres: `units: mm` is missing in the hand file"
    if largest < _REAL[0] and _fits(skin, _scaled(tip, 1e3)):
        return "these look like metres, and the hand file says `units: mm`"
    if tip.ball is not None and _fits(skin, replace(tip, facing=-tip.facing)):
        return "its `facing` looks into the link; turned round it fits"
    return _ON_LINK


def _scaled(tip: Fingertip, factor: float) -> Fingertip:
    pad = tip.pad and (tip.pad[0] * factor, tip.pad[1] * factor)
    return replace(tip, at=tip.at * factor, ball=tip.ball and tip.ball * factor, pad=pad)


def _fits(skin: _Skin, tip: Fingertip) -> bool:
    off, _, most = _farthest(skin, tip, np.array(list(_points(tip))))
    return off <= most


@dataclass(frozen=True, eq=False)
class _Skin:
    """A link and what is welded to it; ``parts`` are their solids with X_ML, L the link's frame."""

    parts: tuple[tuple[LinkGeometry, Pose], ...]

    @classmethod
    def of(cls, model: HandModel, link: str) -> _Skin:
        plant, poses = model._plant, model.poses(model.middle)
        welded = [body.name() for body in plant.GetBodiesWeldedTo(plant.GetBodyByName(link))]
        solid = [name for name in welded if name in model.links]
        return cls(tuple((model.links[name], composed(poses[name].inverse(), poses[link])) for name in solid))

    def off(self, points: Float[np.ndarray, "n 3"]) -> Weights:
        """How far points are from the surface, or from the hull of one of the links where they are on that [m]."""
        hulls = np.min([np.abs(link.above_hull(X_ML.points(points))) for link, X_ML in self.parts], axis=0)
        off = np.abs(self.distances(points))
        return np.where(hulls <= TIP_OFF_LINK, np.minimum(off, hulls), off)

    def rise(self, point: Float[np.ndarray, 3], facing: Float[np.ndarray, 3]) -> float:
        """By which part of a small step the distance from the surface grows [-]; of the hull where it is outside."""
        both = np.array([point, point + FINGER_GAP * facing])
        before, after = self.distances(both)
        if abs(before) > TIP_OFF_LINK:
            before, after = np.min([link.above_hull(X_ML.points(both)) for link, X_ML in self.parts], axis=0)
        return float(after - before) / FINGER_GAP

    def distances(self, points: Float[np.ndarray, "n 3"]) -> Weights:
        """Signed distances from the surface of all of it, negative inside [m]."""
        return np.min([_distances(link, X_ML.points(points)) for link, X_ML in self.parts], axis=0)


def _distances(link: LinkGeometry, points: Float[np.ndarray, "n 3"]) -> Weights:
    """Signed distances from a link, balls as they are and all else by its triangles [m]."""
    balls = [np.linalg.norm(points - ball.center, axis=1) - ball.radius for ball in link.balls]
    return np.min([*balls, *([] if link.only_balls else [link.solid.distances(points)])], axis=0)
