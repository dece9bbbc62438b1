"""Fingertips of a hand whose files do not tell: guessed from its leaf links.

A leaf link is one from which no joint goes on; those count that reach about as far as the farthest. A ball at its end
is a ball tip. Else the tip is the largest flat that looks towards the other fingers, as a pad; where no flat does, the
point that reaches farthest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.geometry.facets import Facet
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.link_geometry import Ball, LinkGeometry
from fixture_design.tolerances import NEARLY_ACROSS, NEARLY_ALONG

if TYPE_CHECKING:
    from fixture_design.grasp.hand_model import HandModel

#: Leaf links that reach less far than this part of the farthest are no fingers [-].
_REACH = 0.85

#: Smaller balls are contact points that a modeller put on a pad [m].
_SMALLEST_BALL = 3e-3

#: A pad looks this near to where the other fingers are [rad], and has at least this area [m^2].
_TOWARDS, _SMALLEST_PAD = 1.2, 2e-5

#: Flats count as at the finger's end from this part of the farthest one's distance on [-].
_END = 0.75

#: Directions in which a ball's surroundings are looked at; how much those count that look away from other fingers [-];
#: and the least spread that is guessed [rad].
_DIRECTIONS, _ALSO, _LEAST_SPREAD = 2000, 0.3, 0.3

#: Guessed balls may touch nearly all around: which part of them is meant nobody says [rad].
_ALL_AROUND = 2.0

#: Points this near to the foremost one are as far in front [m].
_LEVEL = 3e-4

#: Number of configurations by which it is told where the other fingers are, and how much of their ranges they use [-].
_LOOKED_AT, _AROUND = 30, 0.4


@dataclass(frozen=True, eq=False)
class _Leaf:
    """The last link of a finger, its farthest point, the mean direction to the other fingers, and the vertices of what
    it is welded to, shape (n, 3); all in its frame.
    """

    link: LinkGeometry
    end: Point
    towards: Point
    beside: np.ndarray


def guessed_tips(model: HandModel) -> tuple[tuple[Fingertip, ...], tuple[str, ...]]:
    """Fingertips, and a note that says what was guessed."""
    leaves = _leaves(model)
    tips = tuple(_tip(leaf) for leaf in leaves)
    if not tips:
        return (), ("no link at the end of a joint is made of anything: there are no fingertips",)
    named = "; ".join(f"{tip.link}: {_in_words(tip)}" for tip in tips)
    why = "there is no hand file" if model.hand.source is None else "the hand file names none"
    return tips, (f"fingertips are guessed from the leaf links, since {why}: {named}",)


def _in_words(tip: Fingertip) -> str:
    if tip.ball is not None:
        return f"a ball of {tip.ball * 1000:.3g} mm"
    if tip.pad is not None:
        return f"a pad of {tip.pad[0] * 1000:.3g} x {tip.pad[1] * 1000:.3g} mm"
    return "a point"


def _leaves(model: HandModel) -> list[_Leaf]:
    names = _leaf_names(model)
    rng = np.random.default_rng(0)
    # around the middle: at the ends of their ranges fingers look past each other
    drawn = [model.middle, *(model.middle + _AROUND * (model.random(4 * _LOOKED_AT, rng)[:_LOOKED_AT] - model.middle))]
    poses = [model.poses(q) for q in drawn]
    ends: dict[str, Point] = {}
    reach: dict[str, float] = {}
    for name in names:
        vertices = model.links[name].geometry.vertices
        far = np.mean([np.linalg.norm(pose[name].points(vertices), axis=1) for pose in poses], axis=0)
        ends[name], reach[name] = vertices[int(np.argmax(far))], float(far.max())
    names = [name for name in names if reach[name] >= _REACH * max(reach.values())]
    return [
        _Leaf(model.links[name], ends[name], _towards(name, names, ends, poses), _beside(model, name, poses[0]))
        for name in names
    ]


def _beside(model: HandModel, name: str, poses: dict) -> np.ndarray:
    """The vertices of the links that a link is welded to, in its frame."""
    plant = model._plant
    welded = [body.name() for body in plant.GetBodiesWeldedTo(plant.GetBodyByName(name))]
    X_LH = poses[name].inverse()
    found = [
        X_LH.points(poses[other].points(model.links[other].geometry.vertices))
        for other in welded
        if other != name and other in model.links
    ]
    return np.vstack(found) if found else np.zeros((0, 3))


def _towards(name: str, names: Sequence[str], ends: dict[str, Point], poses: Sequence[dict]) -> Point:
    """The mean direction from the end of a finger to the ends of the others, in its link's frame; zero without any."""
    others = [other for other in names if other != name]
    total = np.zeros(3)
    for pose in poses:
        at = pose[name].points(ends[name][None])[0]
        for other in others:
            away = pose[other].points(ends[other][None])[0] - at
            total += pose[name].rotation.T @ away
    size = np.linalg.norm(total)
    return total / size if size > 0 else total


def _leaf_names(model: HandModel) -> list[str]:
    """For every weld of links from which no joint goes on, the link of it that is made of most."""
    plant = model._plant
    moving = {joint.name for joint in model.joints}
    parents = {plant.GetJointByName(name).parent_body().index() for name in moving}
    leaves = []
    for name in sorted(moving):
        welded = plant.GetBodiesWeldedTo(plant.GetJointByName(name).child_body())
        if any(body.index() in parents for body in welded):
            continue
        solid = [body.name() for body in welded if body.name() in model.links]
        leaves += [_last(model, solid)] if solid else []
    return leaves


def _last(model: HandModel, names: Sequence[str]) -> str:
    """Of links welded to each other: one that is nothing but a ball, then the thinnest, which is the skin."""
    balls = [n for n in names if model.links[n].balls and len(model.links[n].pieces) == len(model.links[n].balls)]
    return min(balls or names, key=lambda name: model.links[name].around.radius)


def _tip(leaf: _Leaf) -> Fingertip:
    link, towards = leaf.link, leaf.towards
    known = towards.any()
    ball = _ball(leaf)
    if ball is not None:
        facing, spread = _skin_of(ball, leaf)
        return Fingertip(link.name, link.name, read_only(ball.center), facing, ball.radius, spread=spread)
    pad = (_protruding(link, towards) or _flat(link, towards)) if known else None
    if pad is not None:
        return pad
    facing = towards if known else _outward(leaf)
    return Fingertip(link.name, link.name, read_only(leaf.end), read_only(facing), spread=_ALL_AROUND)


def _ball(leaf: _Leaf) -> Ball | None:
    """The ball at the end of the link, if there is one."""
    large = [ball for ball in leaf.link.balls if ball.radius >= _SMALLEST_BALL]
    near = [ball for ball in large if np.linalg.norm(ball.center - leaf.end) <= 2 * ball.radius]
    return max(near, key=lambda ball: ball.radius) if near else None


def _skin_of(ball: Ball, leaf: _Leaf) -> tuple[Point, float]:
    """The middle of the part of a ball that can touch, towards the other fingers, and the angle it reaches from there.

    A ball touches only where nothing else of its finger is ahead: (v - center) . u <= radius for all its vertices v.
    """
    rng = np.random.default_rng(0)
    directions = rng.standard_normal((_DIRECTIONS, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    ahead = (directions @ (leaf.beside - ball.center).T).max(axis=1, initial=-np.inf)
    free = ahead <= ball.radius
    if not free.any():
        return read_only(_outward(leaf)), _ALL_AROUND
    # those that look towards the other fingers count more
    weights = np.clip(directions @ leaf.towards, 0.0, None) + _ALSO
    middle = (directions[free] * weights[free, None]).sum(axis=0)
    middle /= np.linalg.norm(middle)
    covered = (directions @ middle)[~free]
    spread = _ALL_AROUND if free.all() else float(np.arccos(np.clip(covered.max(), -1.0, 1.0)))
    return read_only(middle), max(spread, _LEAST_SPREAD)


def _outward(leaf: _Leaf) -> Point:
    away = leaf.end - leaf.link.geometry.box_center
    size = np.linalg.norm(away)
    return away / size if size > 0 else np.array([0.0, 0.0, 1.0])


def _protruding(link: LinkGeometry, towards: Point) -> Fingertip | None:
    """The pad that small balls stand for, which some models have in front of a finger."""
    small = [ball for ball in link.balls if ball.radius < _SMALLEST_BALL]
    if len(small) < 3:
        return None
    centers = np.array([ball.center for ball in small])
    normal = np.linalg.svd(centers - centers.mean(axis=0))[2][2]
    normal = normal * np.sign(normal @ towards)
    facing = _on_axis(normal)
    return _pad(link, centers + facing * small[0].radius, facing)


def _on_axis(direction: Point) -> Point:
    """The direction, or the axis of the link that it is along but for rounding."""
    axis = int(np.argmax(np.abs(direction)))
    snapped = np.zeros(3)
    snapped[axis] = np.sign(direction[axis])
    return snapped if abs(direction[axis]) > 1 - NEARLY_ALONG else direction / np.linalg.norm(direction)


def _flat(link: LinkGeometry, towards: Point) -> Fingertip | None:
    """The largest facet at the end that looks towards the other fingers, by what it shows them."""
    shown = [(_shown(link, facet, towards), facet) for facet in link.geometry.facets]
    large = [(area, facet, _from_joint(link, facet)) for area, facet in shown if area >= _SMALLEST_PAD]
    if not large:
        return None
    farthest = max(distance for _, _, distance in large)
    _, facet, _ = max((one for one in large if one[2] >= _END * farthest), key=lambda one: one[0])
    normal = np.array(facet.normal) / np.linalg.norm(facet.normal)
    used = np.unique(link.geometry.triangles[facet.triangles])
    return _pad(link, link.geometry.vertices[used], _on_axis(normal))


def _from_joint(link: LinkGeometry, facet: Facet) -> float:
    """How far the middle of a facet is from the link's own frame, which is at its joint [m]."""
    return float(
        np.linalg.norm(link.geometry.vertices[np.unique(link.geometry.triangles[facet.triangles])].mean(axis=0))
    )


def _shown(link: LinkGeometry, facet: Facet, towards: Point) -> float:
    corners = link.geometry.vertices[link.geometry.triangles[facet.triangles]]
    vector = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0) / 2
    area = float(np.linalg.norm(vector))
    cosine = float(vector @ towards) / area if area > 0 else 0.0
    return area * cosine if cosine > np.cos(_TOWARDS) else 0.0


def _pad(link: LinkGeometry, points: np.ndarray, facing: Point) -> Fingertip:
    """The rectangle around some points of one plane, its sides along the longest extent and across it."""
    ahead = points @ facing
    level = points[ahead >= ahead.max() - _LEVEL]
    flat = level - np.outer(level @ facing - ahead.max(), facing)
    along = _across(facing, flat)
    frame = np.array([along, np.cross(facing, along)])
    low, high = (flat @ frame.T).min(axis=0), (flat @ frame.T).max(axis=0)
    at = frame.T @ ((low + high) / 2) + facing * ahead.max()
    width, height = (high - low).tolist()
    return Fingertip(
        link.name, link.name, read_only(at), read_only(facing), pad=(width, height), along=read_only(along)
    )


def _across(facing: Point, flat: np.ndarray) -> Point:
    """An axis of the link across ``facing`` if there is one, else the longest extent of the points."""
    for axis in np.eye(3):
        if abs(axis @ facing) < NEARLY_ACROSS:
            return axis
    longest = np.linalg.svd(flat - flat.mean(axis=0))[2][0]
    longest = longest - (longest @ facing) * facing
    return longest / np.linalg.norm(longest)
