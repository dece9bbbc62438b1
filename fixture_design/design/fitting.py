"""Elements that fit: candidates whose stem has room, stems out of each other's way, and the part past all of them.

What this takes away is taken from candidates. Bounds are those of the candidates that are left: of a way out they are
computed before elements in it are barred, on the relaxed problem, so that they hold for every layout that avoids them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, cross_products
from fixture_design.contacts import unit_normal
from fixture_design.design.candidates import Candidates
from fixture_design.design.found import Found
from fixture_design.design.plates_apart import Plates
from fixture_design.design.problem import Problem
from fixture_design.design.standing import Standing
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.errors import GeometryError
from fixture_design.layout import (
    LineTip,
    PadTip,
    PinTip,
    Stem,
    StraightWays,
    Tip,
    Verdict,
    element_name,
    pin_stem,
    stem_of,
)

#: Names of elements by candidate.
Names = Mapping[int, str]


def fitting(task: Task, ways: Ways, candidates: Candidates) -> tuple[Candidates, tuple[str, ...]]:
    """Candidates whose stem and body do not cut the part, and a note of how many others there were.

    Raises:
        GeometryError: there are none.
    """
    free = _fits(task, ways, candidates, np.arange(len(candidates)))
    if free.all():
        return candidates, ()
    if not free.any():
        problem = f"none of {len(free)} candidates has room for an element's stem and body"
        raise GeometryError(problem, expected="smaller ones: candidates: {stem: {radius: r, body_radius: r}}")
    note = f"{int((~free).sum())} candidates were left out: stem or body of an element there would cut the part"
    return candidates.chosen(free), (note,)


def standing(task: Task, candidates: Candidates) -> Standing | None:
    """The stems of candidates and of the start's elements; None in the plane, where elements stand upright."""
    if task.space == "planar":
        return None
    stems, feet, normals = _stems(task, candidates), candidates.places.copy(), np.array(candidates.normals[:, 0])
    theirs = _names_of_start(task)
    for index, element in enumerate(candidates.elements):
        # pins of the design point out of their stems; those of the start may point either way
        if element is not None and element.name not in theirs and isinstance(element.tip, PinTip):
            assert element.axis is not None
            stems[index] = pin_stem(element.tip, candidates.scale.length)
            normals[index] = -np.asarray(element.axis)
    return Standing.of(feet, normals, stems, _plates(task, candidates, stems))


def _names_of_start(task: Task) -> set[str]:
    return {element.name for element in task.start.elements} if task.start else set()


def _plates(task: Task, candidates: Candidates, stems: Sequence[Stem | None]) -> Plates | None:
    """The plates that pads and lines are; None where there are none."""
    tips = _tip_of_each(task, candidates)
    if not any(isinstance(tip, PadTip | LineTip) for tip in tips):
        return None
    middles, halves = candidates.places.copy(), np.zeros((len(tips), 3, 3))
    for index, (tip, stem) in enumerate(zip(tips, stems, strict=True)):
        if stem is not None and isinstance(tip, PadTip | LineTip):
            normal = candidates.normals[index, 0]
            first = unit_normal(tip.along - (tip.along @ normal) * normal)
            length, width = (tip.width, tip.height) if isinstance(tip, PadTip) else (tip.length, stem.tip)
            edges = np.array([length * first, width * cross_products(normal, first), stem.tip * normal])
            middles[index], halves[index] = middles[index] + edges[2] / 2, edges / 2
    return Plates(middles, halves)


def _tip_of_each(task: Task, candidates: Candidates) -> list[Tip | None]:
    """Of new elements, and of the start's as they are written; bodies and contacts that were given have none."""
    theirs = _names_of_start(task)
    return [
        make.tip if make is not None else element.tip if element is not None and element.name in theirs else None
        for make, element in zip(candidates.makes, candidates.elements, strict=True)
    ]


def _stems(task: Task, candidates: Candidates) -> list[Stem | None]:
    """Of new elements, and of the start's as they are written; bodies, contacts that were given, and pins have none."""
    known: dict[tuple[type[Tip], float | None], Stem] = {}
    stems: list[Stem | None] = []
    for tip in _tip_of_each(task, candidates):
        if tip is None or isinstance(tip, PinTip):
            stems.append(None)
            continue
        key = (type(tip), getattr(tip, "radius", None))
        if key not in known:
            known[key] = stem_of(tip, candidates.scale.length, task.candidates.stem)
        stems.append(known[key])
    return stems


def _fits(task: Task, ways: Ways, candidates: Candidates, which: Indices, out: Point | None = None) -> Mask:
    """Which elements have room; those whose stem nobody knows have."""
    stems = _stems(task, candidates)
    free = np.ones(len(which), dtype=bool)
    for stem in {stems[index] for index in which.tolist()} - {None}:
        assert stem is not None
        mine = np.array([stems[index] == stem for index in which.tolist()])
        places, normals = candidates.places[which[mine]], np.array(candidates.normals[which[mine], 0])
        free[mine] = ways.fits(places, normals, stem, out)
    return free


def in_the_way(
    task: Task, ways: Ways, problem: Problem, found: Found, verdict: Verdict, names: Names, passed: Point | None
) -> Mask | None:
    """Candidates that the part runs into on its way out, shape (n,); None if it comes out past the locators chosen.

    What is in the way is the tip of a locator, as the verdict has it, or a tip, stem or body in the direction of the
    verdict, or in that of the search; where a direction is asked for, in this one. If one is, all candidates are asked
    at once, so that the next locator does not stand where the same thing happens.

    Args:
        passed: the `way_out`.
    """
    if found.out is None:
        return None
    new = found.locators[np.isin(found.locators, problem.new)]
    blocking = _tips(_ways_out(verdict), new, names)
    if not len(blocking) and passed is not None:
        return None
    hit = np.zeros(len(problem.candidates), dtype=bool)
    hit[problem.new] = ~_fits(task, ways, problem.candidates, problem.new, found.out)
    hit[blocking] = True
    return hit if hit[new].any() else None


def way_out(task: Task, ways: Ways, problem: Problem, found: Found, verdict: Verdict) -> Point | None:
    """The direction of the search, or that of the verdict, in which the part passes the new locators with their bodies.

    None: in neither. Where a direction is asked for, it is that of the search.
    """
    use = _ways_out(verdict)
    tried = [found.out]
    if task.limits.loading is None and use is not None and use.obstacle is None:
        # of what is kept the verdict looks at the bodies too
        tried = [use.direction, found.out] if len(problem.kept) else [found.out, use.direction]
    new = found.locators[np.isin(found.locators, problem.new)]
    fitting = (way for way in tried if way is not None and _fits(task, ways, problem.candidates, new, way).all())
    return next(fitting, None)


def in_every_way(verdict: Verdict | None) -> set[str]:
    """The elements that are in the way where every way out is blocked."""
    use = None if verdict is None else _ways_out(verdict)
    return set() if use is None or use.obstacle is None else {element_name(obstacle.name) for obstacle in use.tried}


def _ways_out(verdict: Verdict) -> StraightWays | None:
    finding = verdict.groups["locators"].findings.get("loadable")
    return finding.use if finding is not None and isinstance(finding.use, StraightWays) else None


def _tips(use: StraightWays | None, new: Indices, names: Names) -> Indices:
    """New locators whose tips are in the way where every way is blocked."""
    blocking = {element_name(obstacle.name) for obstacle in use.tried} if use is not None and use.obstacle else set()
    return np.array([index for index in new.tolist() if names[index] in blocking], dtype=np.int64)
