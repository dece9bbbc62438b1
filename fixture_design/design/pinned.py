"""A plane and two pins: a round pin in one hole, a diamond pin (or a slot) in another, and three points on faces.

The part comes off pins along their axis t, so that t is the way out: the round pin takes both straight motions across
it, the diamond pin, relieved along the line between the two, the turn about it, and three points with n . t < 0 the
rest. The pins of a pair are kept while the points are exchanged for better ones, as elements of a start layout are.
Pairs that are far apart are tried, for each way out, and the best one is taken.

Bounds are those of layouts with such a pair, of the pairs that were tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from fixture_design.arrays import Point, cross_products, read_only
from fixture_design.design.drawing_up import fresh_names
from fixture_design.design.features import features_of
from fixture_design.design.fitting import standing
from fixture_design.design.found import Outcome
from fixture_design.design.problem import Problem
from fixture_design.design.regions import bounded_region
from fixture_design.design.search import RESTARTS, search_region
from fixture_design.design.task import PinRules, Task
from fixture_design.design.ways import Hole, Progress, Ways
from fixture_design.layout import Element, PinTip, pin_stem
from fixture_design.tolerances import COPLANAR_ANGLE

#: Pairs of holes that are tried for each way out, widest first.
MOST_PAIRS = 6
#: Restarts by which pairs are compared; the best is searched with as many as any other way out.
_GLANCES = 1
#: Two holes whose axes are no further apart than this part of their diameter are one behind the other [-].
_SAME_AXIS = 0.5
#: A slot takes the turn if its walls are square to the line to the hole within this cosine [-].
_ACROSS = 0.5


@dataclass(frozen=True, eq=False)
class Pinned:
    """A problem with two pins among what stays, and the way out along them.

    Attributes:
        holes: the surface that each pin touches, by the pin's name.
    """

    problem: Problem
    out: Point
    holes: Mapping[str, str]

    def search(self, problem: Problem, seed: int, restarts: int = RESTARTS) -> Outcome:
        """Of a problem like this one's, with its way out alone."""
        region = bounded_region(problem, self.out)
        return search_region(problem, region, seed, restarts) if region is not None else Outcome(None, None, True)


#: Finds the best layout of a problem; its arguments are those of `search`.
Find = Callable[[Problem, int, Progress], Outcome]


def pinned_best_first(
    task: Task, ways: Ways, problem: Problem, seed: int, progress: Progress
) -> list[tuple[Pinned, Find]]:
    """Problems with a pair of pins kept, each with the search that finds its best layout, best first.

    The bound of clamps that the searches give is the least of all pairs, complete only if all that there are were
    tried.
    """
    rules = task.candidates.pins
    assert rules is not None
    found: list[tuple[tuple[float, ...], Pinned]] = []
    least = float("inf")
    pairs, complete = _pairs(ways.holes(), rules, problem.limits.way_out)
    for number, (first, second, out) in enumerate(pairs):
        if problem.cancelled():
            complete = False
            break
        progress(f"pins in {first.feature} and {second.feature}", number / len(pairs))
        pinned = _with_pins(task, ways, problem, (first, second), out, rules)
        outcome = None if pinned is None else pinned.search(pinned.problem, seed, _GLANCES)
        if pinned is None or outcome is None or outcome.least_clamps is None:
            continue
        least = min(least, float(outcome.least_clamps))
        if outcome.found is not None:
            found.append((outcome.found.score(problem.objective), pinned))
    found.sort(key=lambda scored: scored[0])
    return [(pinned, _bounded_by(pinned, least, complete)) for _, pinned in found]


def _bounded_by(pinned: Pinned, least: float, complete: bool) -> Find:
    def again(problem: Problem, seed: int, progress: Progress) -> Outcome:
        found = pinned.search(problem, seed)
        # other pairs may be more exact, or do with less: what is known of these is of this pair
        return replace(found, least_clamps=int(least), complete=complete, best_accuracy=None, best_preload=None)

    return again


def _pairs(
    holes: tuple[Hole, ...], rules: PinRules, asked: Point | None
) -> tuple[list[tuple[Hole, Hole, Point]], bool]:
    """A hole for the round pin, one for the other, and a way out, the one that is asked for where one is, widest first;
    and whether these are all there are.
    """
    low, high = rules.diameters
    usable = [hole for hole in holes if low <= hole.diameter - rules.clearance <= high]
    by_way: dict[tuple[float, ...], list[tuple[float, Hole, Hole, Point]]] = {}
    for first, second in permutations(usable, 2):
        axis = _axis(first)
        line = second.low - first.low - ((second.low - first.low) @ axis) * axis
        parallel = np.linalg.norm(cross_products(axis, _axis(second))) <= COPLANAR_ANGLE
        width = float(np.linalg.norm(line))
        if first.across is not None or not parallel or width <= _SAME_AXIS * (first.diameter + second.diameter):
            continue
        if second.across is not None and abs(second.across @ cross_products(axis, line)) < _ACROSS * width:
            continue
        for out in (axis, -axis):
            if asked is not None and float(asked @ out) < 1 - COPLANAR_ANGLE:
                continue
            by_way.setdefault(tuple(np.round(out, 6).tolist()), []).append((width, first, second, out))
    widest = [sorted(pairs, key=lambda pair: -pair[0])[:MOST_PAIRS] for pairs in by_way.values()]
    every = all(len(pairs) <= MOST_PAIRS for pairs in by_way.values())
    return [(first, second, out) for pairs in widest for _, first, second, out in pairs], every


def _axis(hole: Hole) -> Point:
    along = np.asarray(hole.high - hole.low)
    return along / np.linalg.norm(along)


def _with_pins(
    task: Task, ways: Ways, problem: Problem, holes: tuple[Hole, Hole], out: Point, rules: PinRules
) -> Pinned | None:
    """The problem with both pins, where they reach into their holes and have room below."""
    taken = {element.name for element in problem.candidates.elements if element is not None}
    names = fresh_names("P", taken)
    line = holes[1].low - holes[0].low
    across = read_only(cross_products(out, line - (line @ out) * out))
    pins = list(_pins(holes, out, rules, across, names))
    feet = np.array([_mouth(hole, out) for hole in holes])
    size = problem.candidates.scale.length
    for foot, pin in zip(feet, pins, strict=True):
        assert isinstance(pin.tip, PinTip)
        if not ways.fits(foot[None], -out[None], pin_stem(pin.tip, size), None).all():
            return None
    contacts = ways.touching(pins)
    if not all(contacts):
        return None
    count = len(problem.candidates)
    candidates = problem.candidates.with_elements(list(zip(pins, contacts, strict=True)), known_to=np.inf)
    changed = replace(
        problem,
        candidates=candidates,
        locators=(*problem.locators, count, count + 1),
        features=features_of(task, candidates),
        duties=None if problem.duties is None else problem.duties.and_more(len(pins)),
        standing=standing(task, candidates),
    )
    return Pinned(changed, out, {pin.name: hole.feature for pin, hole in zip(pins, holes, strict=True)})


def _pins(
    holes: tuple[Hole, Hole], out: Point, rules: PinRules, across: Point, names: Iterator[str]
) -> Iterator[Element]:
    """A round pin, and a diamond pin or a round one in a slot; each as deep in its hole as it is thick, if that is."""
    for number, hole in enumerate(holes):
        diamond = number == 1 and hole.across is None
        diameter = hole.diameter - rules.clearance
        tip = PinTip(diameter, rules.clearance, "diamond" if diamond else "round", across if diamond else None)
        depth = min(diameter, float(np.linalg.norm(hole.high - hole.low)) / 2)
        yield Element(next(names), "locator", read_only(_mouth(hole, out) + depth * out), tip, read_only(out))


def _mouth(hole: Hole, out: Point) -> Point:
    """Where the pin comes in: the end of the hole that the part does not leave by."""
    return np.asarray(hole.low if (hole.high - hole.low) @ out > 0 else hole.high)
