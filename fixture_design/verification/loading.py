"""Loadable: whether the part leaves the locators in a straight line, and so is loaded along it the other way.

First the contacts: which translations they admit (`analysis.straight_ways`). Then, where the part's shape is known, the
way itself: whether the part, moved along one of them, meets any element or body of the fixture. While it is loaded
clamps are open and supports down; pins that have clearance keep nothing in, but the part must come off them. A way
past all clamps, wherever they are when open, is preferred to one on which some have to be out of the way; these are
named.

yes: a direction that the contacts admit, along which nothing is in the way. no: the contacts admit none, or none but
those of one line, and these are blocked. Where there are more directions than can be tried, it is undecided.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.analysis.straight_ways import DirectionCone, WaysOfBranch, clause_value, direction_cone
from fixture_design.arrays import Point
from fixture_design.contacts import OPENED, STANDING, Contact, Role, unit_normal
from fixture_design.errors import InputError, format_length, looking_at
from fixture_design.layout import Answer, Finding, Group, Layout, Obstacle, PinTip, StraightWays
from fixture_design.tolerances import Tolerances
from fixture_design.verification.found import FoundContacts

if TYPE_CHECKING:
    from fixture_design.geometry import PlanarSurroundings, Surroundings

#: Directions tried before it is left undecided.
MOST_TRIED = 40
#: Clear directions of which the one with fewest clamps in the way is taken.
MOST_COMPARED = 6
#: Names in one reason before it says "and so many more".
_NAMES_SHOWN = 4


def closed_while_loading(contact: Contact) -> bool:
    """Whether a contact keeps the part in while it is loaded."""
    return contact.role in STANDING and not contact.clearance


def loadable(layout: Layout, group: Group, found: FoundContacts, tolerances: Tolerances) -> Finding:
    """Whether the part leaves a group's contacts straight, and what else stands there; see the module's docstring.

    Returns:
        yes with the direction, no with weights or with what is in the way, or undecided. The margin is how far the
        direction leaves the contacts, the least -n . t, where it is yes.

    Raises:
        InputError: the part's or a body's file cannot be used.
    """
    plane = 2 if layout.space == "planar" else 3
    asked = tuple(contact for contact in group.contacts if closed_while_loading(contact))
    up = None if layout.gravity is None else -np.asarray(layout.gravity, dtype=np.float64)
    cone = direction_cone(asked, up, tolerances, plane)
    opened = tuple(contact.name for contact in group.contacts if not closed_while_loading(contact))
    if cone.truth is None:
        return Finding(Answer.UNDECIDED, use=_ways(cone, opened, cone.first), reason=cone.reason)
    if cone.truth is False:
        return Finding(Answer.NO, residual=max(_off(asked, w) for w in cone.weights), use=_ways(cone, opened, None))
    around = _surroundings(layout, found, STANDING)
    if around is None:
        assert cone.first is not None
        return _yes(cone, _ways(cone, opened, cone.first), cone.first)
    away = _surroundings(layout, found, OPENED)
    assert away is not None
    return _tried(layout, cone, opened, around, away)


def _tried(
    layout: Layout,
    cone: DirectionCone,
    opened: tuple[str, ...],
    around: Surroundings | PlanarSurroundings,
    away: Surroundings | PlanarSurroundings,
) -> Finding:
    """The first direction along which nothing is in the way, or what is in the way in all of them."""
    blocked: list[Obstacle] = []
    clear: list[tuple[Point, tuple[str, ...]]] = []
    certain = True
    directions = cone.candidates(_preferred(layout))
    for direction in directions[:MOST_TRIED]:
        # what is first in the way is told of the best one, and of all there are if these are few
        meeting = around.meeting(direction, any_one=bool(blocked) and cone.confining is None)
        if meeting is None:
            clear.append((direction, away.met(direction)))
            if not clear[-1][1] or len(clear) == MOST_COMPARED:
                break
            continue
        blocked.append(meeting.obstacle)
        certain = certain and meeting.certain
    if clear:
        direction, aside = min(clear, key=lambda way: len(way[1]))
        ways = _ways(cone, opened, direction, length=around.length(direction), against=around.names)
        return _yes(cone, replace(ways, aside=aside), direction)
    first, confining = directions[0], cone.confining
    ways = _ways(
        cone, opened, first, length=around.length(first), against=around.names,
        obstacle=blocked[0], weights=confining, tried=tuple(blocked),
    )  # fmt: skip
    if confining is not None and certain:
        return Finding(Answer.NO, residual=_off(cone.contacts, confining), use=ways)
    return Finding(Answer.UNDECIDED, use=ways, reason=_why(blocked, confining is not None))


def _why(blocked: Sequence[Obstacle], confined: bool) -> str:
    best = blocked[0]
    assert best.direction is not None
    towards = np.round(best.direction, 3).tolist()
    names = list(dict.fromkeys(obstacle.name for obstacle in blocked))
    others = ", ".join(names[:_NAMES_SHOWN]) + (f" and {len(names) - _NAMES_SHOWN} more" * (len(names) > _NAMES_SHOWN))
    count = f"{len(blocked)} directions were" if len(blocked) > 1 else "1 direction was"
    if confined:
        return (
            f"no other direction than along {towards} leaves the contacts, and {best.name} is in the way there, as far "
            f"as its size is known"
        )
    return (
        f"{count} tried, and all are blocked (by {others}): in the best one, {towards}, {best.name} is in the way "
        f"after {format_length(best.after)}; others may be clear"
    )


def _preferred(layout: Layout) -> list[Point]:
    """Along pins and against gravity, then along the part's axes, all both ways."""
    pins = [e.axis for e in layout.elements if isinstance(e.tip, PinTip) and e.axis is not None and e.role in STANDING]
    axes = [] if layout.part is None else list(layout.part.pose.rotation.T)
    found = [np.asarray(axis, dtype=np.float64) for axis in (*pins, *axes)]
    scaled = [axis / np.abs(axis).max() for axis in found if axis.any()]
    return [sign * axis for axis in scaled for sign in (1.0, -1.0)]


def _surroundings(
    layout: Layout, found: FoundContacts, roles: Sequence[Role]
) -> Surroundings | PlanarSurroundings | None:
    """What has one of these roles around the part; None where the part has no shape."""
    if layout.part is None:
        return None
    from fixture_design.geometry import (  # noqa: PLC0415 - Drake only where there is geometry
        PlanarSurroundings,
        Polygon,
        Surroundings,
        load_geometry,
    )

    part = layout.part
    if (part.kind == "polygon") != (layout.space == "planar"):
        problem = f"part {part.name!r} does not fit a {layout.space} layout"
        raise InputError(problem, source=layout.source, place=layout.places.get(("part",)), found=f"kind {part.kind!r}")
    with looking_at(layout.source, layout.places.get(("part",))):
        geometry = found.geometry or load_geometry(part)
    if isinstance(geometry, Polygon):
        return PlanarSurroundings.of(layout, geometry, found.contacts, roles)
    return Surroundings.of(layout, geometry, found.contacts, roles)


def _yes(cone: DirectionCone, ways: StraightWays, direction: Point) -> Finding:
    values = [clause_value(c, i, direction) for c in cone.contacts for i in range(len(c.clauses))]
    return Finding(Answer.YES, margin=ways.leaving, residual=max(values, default=-1.0), use=ways)


def _ways(
    cone: DirectionCone,
    opened: tuple[str, ...],
    direction: Point | None,
    *,
    length: float | None = None,
    against: tuple[str, ...] = (),
    obstacle: Obstacle | None = None,
    weights: Mapping[str, tuple[float, ...]] | None = None,
    tried: tuple[Obstacle, ...] = (),
) -> StraightWays:
    branch = _branch_of(cone, direction)
    nothing = np.zeros((0, len(cone.up)))
    if cone.truth is False and len(cone.weights) == 1:
        weights = cone.weights[0]
    return StraightWays(
        contacts=tuple(contact.name for contact in cone.contacts),
        open=opened,
        spans=nothing if branch is None else branch.spans,
        lines=nothing if branch is None else branch.lines,
        direction=direction,
        leaving=0.0 if direction is None else _leaving(cone, direction),
        slides=() if direction is None else cone.slides(direction),
        length=length,
        against=against,
        obstacle=obstacle,
        weights=weights,
        branches=cone.weights if len(cone.weights) > 1 else (),
        tried=tried,
    )


def _leaving(cone: DirectionCone, direction: Point) -> float:
    """Zero up to rounding: it slides."""
    value = cone.leaving(direction)
    return value if value > cone.tolerances.zero else 0.0


def _branch_of(cone: DirectionCone, direction: Point | None) -> WaysOfBranch | None:
    """The branch that has a direction; the best one without."""
    if direction is not None:
        for branch in cone.branches:
            if float((branch.rows @ direction).max(initial=-1.0)) <= cone.tolerances.zero:
                return branch
    return next(iter(cone.branches), None)


def _off(contacts: Sequence[Contact], weights: Mapping[str, tuple[float, ...]]) -> float:
    """|sum w n| / sum w."""
    units = np.array([unit_normal(normal) for contact in contacts for normal in contact.normals])
    values = np.array([weight for contact in contacts for weight in weights[contact.name]])
    return float(np.linalg.norm(values @ units) / values.sum())
