"""Stories of what moves: the part that gets away, the way out, the error of a feature."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import OPENED, unit_normal
from fixture_design.errors import format_length
from fixture_design.layout import Answer, LoadVerdict, LocatingErrors, Pose, StraightWays, Unbalanced, element_name
from fixture_design.viewing.palette import LOAD, MOTION, VERMILLION
from fixture_design.viewing.scene.acting import acting_point, tail
from fixture_design.viewing.scene.arrows import wrench_things
from fixture_design.viewing.scene.balance_telling import load_name
from fixture_design.viewing.scene.drawn_sizes import DOT, FOLLOWED, LONGEST, THICK, WAY
from fixture_design.viewing.scene.elements import element_path
from fixture_design.viewing.scene.features import error_things
from fixture_design.viewing.scene.motions import motion_animation, motion_things, shown_amount, smallest_push
from fixture_design.viewing.scene.pushes import push_things, scale_for
from fixture_design.viewing.scene.scene import Animation, Label, Thing
from fixture_design.viewing.scene.shapes import Arrow, Sphere
from fixture_design.viewing.scene.space import Twist, lifted
from fixture_design.viewing.scene.telling import PLAIN, Backdrop, Told

#: Steps of an animation along a straight way, and how long it takes [s].
_STEPS, _SECONDS = 8, 1.8


def told_motion(stage: Backdrop, motion: Vector, *, breaks: bool, both_ways: bool = False) -> Told:
    """A displacement as an arrow or a screw, and the part moving so.

    Args:
        breaks: nothing resists it, so that the smallest push along it moves the part; that push is drawn too.
        both_ways: nothing notices its opposite either.
    """
    twist = Twist.of_motion(motion)
    amount = shown_amount(twist, stage.hull, stage.size)
    things = list(motion_things(stage.path, twist, stage.center, stage.size))
    moved = amount * float(np.linalg.norm(twist.along + np.cross(twist.about, stage.hull), axis=1).max())
    caption = f"Orange: how the part moves, drawn so large ({format_length(moved)}) that it is seen."
    if breaks:
        things += smallest_push(stage.path, twist, stage.surface, stage.size)
        caption += " Black: the smallest push there is enough, nothing resists it."
    return Told(caption, tuple(things), (), motion_animation(twist, amount, both_ways=both_ways), PLAIN)


def told_unbalanced(stage: Backdrop, proof: Unbalanced, load: LoadVerdict | None) -> Told:
    """What a load moves: the motion, and the load itself."""
    told = told_motion(stage, proof.motion, breaks=False)
    wrench = Twist.of_motion(proof.wrench if load is None or not np.any(load.wrench) else load.wrench)
    name = "what acts" if load is None or not np.any(load.wrench) else load_name(load)
    at = acting_point(
        stage.layout, "" if load is None else load.load, np.concatenate([wrench.along, wrench.about]), stage.center
    )
    size = float(np.linalg.norm(wrench.along))
    scale = LONGEST * stage.size / size if size > 0 else 1.0
    things = tuple(wrench_things(f"{stage.path}/acting", wrench, at, scale, stage.size, LOAD))
    label = Label(stage.path, name, tail(wrench, at, scale, stage.size), LOAD)
    caption = f"Black: the load that nothing balances. {told.caption}"
    return Told(caption, (*told.things, *things), (label,), told.animation, PLAIN)


def told_way(stage: Backdrop, ways: StraightWays) -> Told:
    """The straight way out and the part on it, at its true length; or what is in the way."""
    aside = tuple(_opened(stage, ways))
    without = (*PLAIN, "normals", "cones", *aside)
    if ways.direction is None:
        pushes = _normals_that_balance(stage, ways)
        scale = scale_for(max((float(np.linalg.norm(force)) for _, _, force in pushes), default=0.0), stage.size)
        caption = "No straight way: purple arrows, as long as their weights, balance each other."
        return Told(caption, tuple(push_things(stage.path, pushes, scale, stage.size)), without=without)
    way = lifted(ways.direction)
    things: list[Thing] = [
        Thing(
            f"{stage.path}/way",
            Arrow(stage.center, stage.center + WAY * stage.size * way, 1.4 * THICK * stage.size),
            MOTION,
        )
    ]
    labels: list[Label] = []
    length = FOLLOWED * stage.size if ways.length is None else min(ways.length, FOLLOWED * stage.size)
    true = f"drawn for {format_length(length)} at its true length"
    caption = f"Orange: straight out, {true}; clamps and supports are open then and left out."
    if ways.obstacle is not None:
        length = ways.obstacle.after
        at = lifted(ways.obstacle.point)
        things.append(Thing(f"{stage.path}/obstacle", Sphere(at, 2.5 * DOT * stage.size), VERMILLION))
        labels.append(Label(stage.path, f"meets {ways.obstacle.name}", at, VERMILLION))
        caption = f"Orange: the best way, blocked after {format_length(length)} at the red ball."
    return Told(caption, tuple(things), tuple(labels), _straight(way * length), without)


def _straight(way: np.ndarray) -> Animation:
    still = np.eye(3)
    return Animation("part", tuple(Pose(still, way * k / _STEPS) for k in range(_STEPS + 1)), _SECONDS, far=True)


def _opened(stage: Backdrop, ways: StraightWays) -> Iterator[str]:
    """Paths of clamps and supports that are open; pins with clearance are open too, but stay where they are."""
    names = {element_name(name) for name in ways.open}
    for owner in (*stage.layout.elements, *stage.layout.bodies):
        path = element_path(stage.layout, owner.name)
        if owner.name in names and owner.role in OPENED and path is not None:
            yield path


def _normals_that_balance(stage: Backdrop, ways: StraightWays) -> list[tuple[str, np.ndarray, np.ndarray]]:
    weights = ways.weights or (ways.branches[0] if ways.branches else {})
    return [
        (contact.name, lifted(contact.point), -weight * lifted(unit_normal(normal)))
        for contact in stage.contacts
        for normal, weight in zip(contact.normals, weights.get(contact.name, ()), strict=False)
        if weight > 0
    ]


def told_errors(stage: Backdrop, evidence: LocatingErrors, answer: Answer | None) -> Told:
    """Errors beside their tolerances; where one is too large, the part as far off as it may be."""
    if evidence.motion is not None:
        return told_motion(stage, evidence.motion, breaks=False, both_ways=True)
    things = tuple(error_things(stage.path, evidence, stage.size))
    caption = "Arrows: the largest error of each feature; black discs: its tolerance, drawn alike for all."
    worst = [feature.displacement for feature in evidence.features if feature.displacement is not None]
    if answer is Answer.NO and worst and np.any(worst[0]):
        twist = Twist.of_motion(worst[0])
        amount = shown_amount(twist, stage.hull, stage.size)
        caption += f" The part moves as it may be off, {amount:.3g} times enlarged."
        return Told(caption, things, (), motion_animation(twist, amount), ("loads", "normals", "cones"))
    return Told(caption, things, without=("loads", "normals", "cones"))
