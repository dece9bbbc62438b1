"""Stories of what holds: weights that close, forces that carry a load."""

from __future__ import annotations

import numpy as np

from fixture_design.layout import Answer, Balance, Finding, LoadVerdict, Weights
from fixture_design.viewing.palette import LOAD
from fixture_design.viewing.scene.acting import acting_point, tail
from fixture_design.viewing.scene.arrows import central_point, wrench_things
from fixture_design.viewing.scene.pushes import force_pushes, longest_of, push_things, scale_for, weight_pushes
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.space import Twist
from fixture_design.viewing.scene.telling import PLAIN, Backdrop, Told


def told_weights(stage: Backdrop, branches: tuple[Weights, ...], finding: Finding) -> Told:
    """Arrows as long as the weights that balance."""
    pushes = weight_pushes(branches[0], stage.contacts, finding)
    scale = scale_for(longest_of(pushes), stage.size)
    several = f" (the first of {len(branches)} branches)" if len(branches) > 1 else ""
    caption = f"Purple arrows: pushes that balance each other; their lengths are the weights{several}."
    things = tuple(push_things(stage.path, pushes, scale, stage.size))
    return Told(caption, things, without=(*PLAIN, "normals", "cones"))


def told_balance(stage: Backdrop, balance: Balance, load: LoadVerdict | None, weight: np.ndarray) -> Told:
    """Forces of the contacts, the load and the weight, all in one scale.

    Args:
        load: None where gravity and clamps alone act.  weight: a wrench about W's origin.
    """
    pushes = force_pushes(balance.forces, stage.contacts)
    acting = _acting(stage, load, weight)
    largest = max([longest_of(pushes), *(float(np.linalg.norm(wrench.along)) for _, wrench, _ in acting)])
    scale = scale_for(largest, stage.size)
    things: list[Thing] = list(push_things(stage.path, pushes, scale, stage.size))
    labels: list[Label] = []
    for number, (name, wrench, at) in enumerate(acting):
        path = f"{stage.path}/acting/{number}"
        drawn = tuple(wrench_things(path, wrench, at, scale, stage.size, LOAD))
        things += drawn
        if drawn:
            labels.append(Label(stage.path, name, tail(wrench, at, scale, stage.size), LOAD))
    longest = f"{longest_of(pushes):.3g} N"
    caption = f"Purple arrows: forces of the contacts on the part, the longest {longest}; black: what they carry."
    return Told(caption, tuple(things), tuple(labels), without=(*PLAIN, "normals"))


def _acting(stage: Backdrop, load: LoadVerdict | None, weight: np.ndarray) -> list[tuple[str, Twist, np.ndarray]]:
    """Name, wrench and place of what acts besides contacts."""
    heavy = Twist.of_motion(weight)
    found = [("weight", heavy, central_point(heavy, stage.center))] if np.any(weight) else []
    if load is not None and np.any(load.wrench):
        at = acting_point(stage.layout, load.load, load.wrench, stage.center)
        found.append((load_name(load), Twist.of_motion(load.wrench), at))
    return found


def load_name(load: LoadVerdict) -> str:
    """ "cutting", "contour, row 12"; how many times it can be held where that is too few."""
    name = load.load if load.row is None else f"{load.load}, row {load.row}"
    if load.answer is Answer.NO and load.reserve is not None and 0 < load.reserve[1] < 1:
        return f"{name}: {load.reserve[1]:.3g} times it is too much"
    return name
