"""One attempt at a design: some candidates, one plan, one search, and the layout it gives, verified."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.design.candidates import Candidates
from fixture_design.design.drawing_up import layout_of, named
from fixture_design.design.features import features_of
from fixture_design.design.fitting import in_every_way, in_the_way, standing, way_out
from fixture_design.design.found import Found, Outcome
from fixture_design.design.locating_several import redundancy
from fixture_design.design.merit import as_it_holds, better_of, merit, noted
from fixture_design.design.pinned import pinned_best_first
from fixture_design.design.plans import LEAVING, LOCATING, Plan
from fixture_design.design.preloads import duties_of, found_preload, preloaded
from fixture_design.design.problem import Problem
from fixture_design.design.result import Bound, DesignResult, closure_margin
from fixture_design.design.search import search
from fixture_design.design.shortfall import bound_of, failing, refused, without_layout
from fixture_design.design.start import Start, begun
from fixture_design.design.steps import Step, additions, in_world
from fixture_design.design.task import Task
from fixture_design.design.unstoppable import free_for_certain
from fixture_design.design.ways import Progress, Ways
from fixture_design.errors import GeometryError
from fixture_design.layout import Answer

#: How often a way out is searched again without locators that turned out to be in it.
MOST_BARRED = 8
#: How many pairs of holes are verified before pins are given up.
MOST_PINNED = 6


@dataclass(frozen=True, eq=False)
class Asked:
    """What a design is asked for, and by whom.

    Attributes:
        ways: geometry and verification.
        seed: of restarts.
        progress: told what is being done.  cancelled: once it says True the best so far is the result.
    """

    task: Task
    ways: Ways
    seed: int
    progress: Progress
    cancelled: Callable[[], bool]


class _UselessError(Exception):
    """Candidates, shape (n,), that turn out not to be places for an element (where solids overlap)."""

    def __init__(self, useless: Mask) -> None:
        super().__init__(f"{int(useless.sum())} candidates")
        self.useless = useless


def leaves_straight(task: Task, plan: Plan) -> bool:
    """Whether the part must come out of the locators in a straight line."""
    asked = bool(set(LEAVING) & set(plan.require.get("locators", ())))
    return asked or task.require is None or task.limits.loading is not None


def opens_all(plan: Plan) -> bool:
    """Whether some motion must leave all locators at once."""
    return "strongly_accessible" in plan.require.get("locators", ())


def attempt(asked: Asked, candidates: Candidates, plan: Plan, *, keep_all: bool, slides: bool = False) -> DesignResult:
    """The best layout among some candidates that does what a plan asks, verified; or why there is none.

    Args:
        keep_all: whether what the start has stays where it does no harm, or only what is ``fixed``.
        slides: whether the part may slide along locators on its straight way out, although some motion leaves all.
    """
    task, ways = asked.task, asked.ways
    locators, everything = plan.require.get("locators", ()), plan.require.get("all", ())
    leaves, opens = leaves_straight(task, plan), opens_all(plan)
    lets_go = leaves and opens and not slides
    start = begun(task, candidates.with_friction(plan.friction), ways, keep_all, leaves=lets_go, opens=opens)
    closes = "with friction" if "force_closure" in everything else None
    problem = Problem(
        start.candidates, task.limits, task.objective, start.locators, start.others, start.spare,
        locates=bool(set(LOCATING) & set(locators)), leaves=leaves,
        closes="without friction" if "form_closure" in everything else closes,
        features=features_of(task, start.candidates), duties=duties_of(task, plan, ways, start.candidates),
        standing=standing(task, start.candidates), determines=bool({"deterministic", "accurate"} & set(locators)),
        enters=leaves or opens or "accessible" in locators, opens=opens, slides=slides,
        cancelled=asked.cancelled,
    )  # fmt: skip
    if start.conflict:
        reason = f"{', '.join(start.conflict)} must stay, and let the part neither in nor out"
        return DesignResult(Answer.NO, None, steps=start.steps, reason=reason)
    try:
        pinned = _with_pins(asked, problem, start, plan)
        if pinned is not None and pinned.satisfied is Answer.YES:
            return pinned
        found = _by_points(asked, problem, candidates, start, plan)
    except _UselessError as error:
        kept = candidates.chosen(~error.useless[: len(candidates)])
        return attempt(asked, kept, plan, keep_all=keep_all, slides=slides)
    if task.candidates.pins is None:
        return found
    note = "without pins: no two holes of the part take a pin each in a way that lets it out and closes it"
    if pinned is None:
        return noted(found, note)
    better = better_of(found, pinned)
    return better if better is pinned else noted(better, f"without pins: with them {pinned.reason or 'it is worse'}")


def _by_points(asked: Asked, problem: Problem, candidates: Candidates, start: Start, plan: Plan) -> DesignResult:
    """Tips on the surface alone, as far as they can notice and stop what is asked."""
    if problem.never_stopped is not None:
        return _unstoppable(asked, problem, candidates, start)
    if (
        "deterministic" in plan.require.get("locators", ())
        and problem.candidates.freedoms < problem.candidates.dimension
    ):
        return _unnoticed(problem, candidates, start)
    return _past_locators(asked, problem, start, plan, search)


def _unnoticed(problem: Problem, candidates: Candidates, start: Start) -> DesignResult:
    """No candidate notices a motion: so much is certain where normals are known, and elements have one choice each."""
    free = in_world(np.linalg.svd(problem.rows)[2][-1], start.candidates.scale)
    reason = f"no candidate notices a motion; {len(candidates)} were there"
    if not candidates.errors.any() and not problem.vague:
        return DesignResult(Answer.NO, None, steps=start.steps, free=free, reason=reason)
    reason = f"{reason}, and some normals are not known exactly, or are alternatives"
    return DesignResult(Answer.UNDECIDED, None, steps=start.steps, free=free, reason=reason)


def _with_pins(asked: Asked, problem: Problem, start: Start, plan: Plan) -> DesignResult | None:
    """A plane and two pins; None where that is not asked for, or the part has no holes for them."""
    task = asked.task
    if task.candidates.pins is None or not (problem.leaves and problem.locates):
        return None
    best: DesignResult | None = None
    blocked: set[str] = set()
    tried = 0
    for pinned, find in pinned_best_first(task, asked.ways, problem, asked.seed, asked.progress):
        if blocked & set(pinned.holes.values()):
            continue
        found = _past_locators(asked, pinned.problem, start, plan, find)
        best, tried = found if best is None else better_of(best, found), tried + 1
        if best.satisfied is Answer.YES or problem.cancelled() or tried == MOST_PINNED:
            break
        # a hole that the part cannot leave its pin by is no better for another pair
        blocked |= {pinned.holes[name] for name in in_every_way(found.verdict) if name in pinned.holes}
    return best


def _past_locators(
    asked: Asked, problem: Problem, start: Start, plan: Plan, find: Callable[[Problem, int, Progress], Outcome]
) -> DesignResult:
    """What the search finds; searched again, a few times, without locators that the part runs into on its way out."""
    outcome = find(problem, asked.seed, asked.progress)
    bound = bound_of(problem, outcome)
    if outcome.found is None or refused(problem, outcome.found):
        bound = None if bound is None else replace(bound, found=None)
        return without_layout(problem, outcome, bound, start, asked.seed)
    result, names = _drawn_up(asked, problem, outcome, bound, start, plan)
    assert result.verdict is not None
    passed = way_out(asked.task, asked.ways, problem, outcome.found, result.verdict)
    hit = in_the_way(asked.task, asked.ways, problem, outcome.found, result.verdict, names, passed)
    if hit is None or problem.cancelled():
        return result if passed is None else replace(result, out=passed)
    assert outcome.found.out is not None
    result = replace(result, out=None)  # something is in that way
    blocking = [index for index in outcome.found.locators.tolist() if hit[index]]
    where = ", ".join(f"{names[index]} on {problem.candidates.features[index]}" for index in blocking)
    if len(problem.barred) == MOST_BARRED:
        return noted(result, f"in the part's way out: {where}; no more was tried")
    barred = replace(problem, barred=(*problem.barred, (outcome.found.out, hit)))
    again = _past_locators(asked, barred, start, plan, find)
    if merit(again) < merit(result):
        return noted(result, f"in the part's way out: {where}; nothing better was found")
    motion = np.pad(outcome.found.out, (0, problem.candidates.dimension - len(outcome.found.out)))
    left = tuple(
        Step("removed", f"a locator on {problem.candidates.features[i]}", "in the way", motion) for i in blocking
    )
    note = f"{int(hit.sum())} candidates are in the part's way out along {np.round(outcome.found.out, 3).tolist()}"
    return noted(replace(again, steps=(*left, *again.steps)), note)


def _unstoppable(asked: Asked, problem: Problem, candidates: Candidates, start: Start) -> DesignResult:
    """No candidate stops a motion; whether that is certain where normals are not known exactly is asked again."""
    assert problem.never_stopped is not None
    free = in_world(problem.never_stopped, candidates.scale)
    reason = f"no candidate stops a motion; {len(candidates)} were there"
    if not candidates.errors.any() and not problem.vague and not problem.barely_stopped:
        return DesignResult(Answer.NO, None, steps=start.steps, free=free, reason=reason)
    certain = (
        free_for_certain(replace(asked.task, start=None), asked.ways, candidates)
        if problem.closes != "with friction" and not problem.vague
        else None
    )
    if certain is not None:
        return DesignResult(Answer.NO, None, steps=start.steps, free=certain, reason=reason)
    barely, unknown = "some stop it by no more than rounding does", "some of their normals are not known exactly"
    but = barely if problem.barely_stopped else unknown
    return DesignResult(Answer.UNDECIDED, None, steps=start.steps, free=free, reason=f"{reason}, and {but}")


def _useless(asked: Asked, problem: Problem, found: Found) -> Mask:
    """Candidates that turn out not to be places for an element (where solids overlap), shape (n,)."""
    useless = np.zeros(len(problem.candidates), dtype=bool)
    for index in np.concatenate([found.locators, found.clamps]).tolist():
        if problem.candidates.elements[index] is None:
            place = np.array([index])
            names = {index: "candidate"}
            alone = layout_of(replace(asked.task, start=None), problem.candidates, place, place[:0], names, {}, 0.0)
            try:
                asked.ways.contacts(alone)
            except GeometryError:
                useless[index] = True
    return useless


def _drawn_up(
    asked: Asked, problem: Problem, outcome: Outcome, bound: Bound | None, start: Start, plan: Plan
) -> tuple[DesignResult, dict[int, str]]:
    """The layout of what was found, with its verdict and its record; and its elements' names.

    Raises:
        _UselessError: some candidates are no places for an element after all.
    """
    found = outcome.found
    assert found is not None
    taken = [element.name for element in problem.candidates.elements if element is not None]
    names = named(problem.candidates, found.locators, found.clamps, taken)
    layout = layout_of(asked.task, problem.candidates, found.locators, found.clamps, names, plan.require, plan.friction)
    try:
        layout, verdict = preloaded(asked.ways, problem, found, layout, names)
    except GeometryError as cause:
        useless = _useless(asked, problem, found)
        if not useless.any():
            raise
        raise _UselessError(useless) from cause
    answer = Answer.YES if verdict.satisfied is None else verdict.satisfied
    spare = tuple(Step("removed", start.name(i), "spare") for i in problem.spare if i not in found.clamps)
    reason = plan.reason if answer is Answer.YES else f"the layout that was found does not verify: {failing(verdict)}"
    exact = found.accuracy if np.isfinite(found.accuracy) else None
    shown = replace(problem, locators=start.locators)  # new pins have their reasons too
    result = DesignResult(
        # a layout that fails does not prove that none holds
        Answer.UNDECIDED if answer is Answer.NO else answer, layout, verdict,
        (*start.steps, *spare, *additions(shown, found.locators, found.clamps, names)), bound,
        found.out, exact, outcome.best_accuracy, closure_margin(verdict),
        preload=found_preload(problem, layout), best_preload=outcome.best_preload,
        best_preload_here=outcome.best_preload_here,
        reason=reason, notes=tuple(_notes(asked.task, problem, found)),
    )  # fmt: skip
    return as_it_holds(result), names


def _notes(task: Task, problem: Problem, found: Found) -> Iterator[str]:
    if problem.several and (twice := redundancy(problem, found.locators)):
        yield f"{twice} rows of the locators say what others say: flat tips on faces that meet share a turn"
    elements = [problem.candidates.elements[index] for index in problem.kept.tolist()]
    if kept := [element.name for element in elements if element is not None and not element.fixed]:
        yield f"the bounds are those of layouts that keep {', '.join(kept)}"
    if "preload" in task.objective and problem.duties is not None and not problem.duties.wrenches.any():
        yield "no load and no weight acts on the part: nothing says what the clamps should push with"
