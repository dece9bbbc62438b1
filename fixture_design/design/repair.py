"""Repair: the smallest change to a layout that makes it do what it requires.

Elements moved, added or removed, and preloads changed; what is ``fixed`` stays. The number of moves, additions and
removals that locating, a way out and closure take has a proof (`changes`); what forces and accuracy take besides is
found step by step. Among changes that are as few, the places are those that are best for the objective.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import chain

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.candidates import Candidates
from fixture_design.design.changed_layout import changed, index_of, raised
from fixture_design.design.changing import Fewest, best_places, fewest_over_ways, more_exact
from fixture_design.design.features import features_of
from fixture_design.design.fitting import fitting, standing
from fixture_design.design.found import Found
from fixture_design.design.plans import LEAVING, LOCATING, Plan, by_certainty
from fixture_design.design.preloads import duties_of
from fixture_design.design.problem import Problem
from fixture_design.design.raising import fewest_raised
from fixture_design.design.result import ChangeBound, DesignResult
from fixture_design.design.shortfall import failing, left_out_in_words, not_yet_no
from fixture_design.design.start import elements_of
from fixture_design.design.task import CandidateRules, Limits, Task
from fixture_design.design.touching import candidates_of
from fixture_design.design.ways import Progress, Ways, ways_of
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Answer, Layout, Requirement, Verdict


def repair(
    layout: Layout,
    ways: Ways | None = None,
    *,
    seed: int = 0,
    rules: CandidateRules | None = None,
    progress: Progress = lambda words, part: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> DesignResult:
    """The layout with the fewest changes that make its requirements hold, verified; or why there is none.

    Args:
        layout: with a part; without requirements it is to locate, let the part out in a straight line, and close.
        rules: where elements may be moved to or added.

    Raises:
        InputError: the part or an element cannot be used.  UnsupportedError: a layout without a part.

    Example:
        >>> repair(read_layout("jammed.layout.yaml")).steps        # doctest: +SKIP
    """
    if layout.part is None:
        raise UnsupportedError("a layout without a part has nowhere to put elements", source=layout.source)
    ways = ways or ways_of(layout.part, layout.surface_gap)
    asked = _asked_for(layout, ways)
    before = ways.verify(asked) if (asked.elements or asked.bodies or asked.contacts) else None
    if before is not None and before.satisfied is Answer.YES:
        return DesignResult(Answer.YES, asked, before, changes=ChangeBound(0, 0, complete=True))
    progress("candidates", 0.0)
    task = _task(asked, rules or CandidateRules())
    proven = True
    everything, _ = candidates_of(task, ways, ways.spots(task.candidates, seed))
    everything, _ = fitting(task, ways, everything)
    left_out = 0
    for some in by_certainty(everything):
        left_out = len(everything) - len(some)
        problem = _problem(task, ways, some, cancelled)
        found = fewest_over_ways(task, ways, problem, seed, progress)
        if np.isfinite(found.found):
            # what certainly does not hold does not hold without a change
            least = max(found.bound, int(before is not None and before.satisfied is Answer.NO))
            result = _first_that_holds(asked, ways, problem, replace(found, bound=least))
            return replace(result, notes=(*result.notes, left_out_in_words(left_out))) if left_out else result
        proven &= found.complete and not some.errors.any()
    what = "no changes among these candidates" if proven else "no changes were found that"
    reason = f"{what} make it locate, let out and close what it has to"
    result = DesignResult(Answer.NO if proven else Answer.UNDECIDED, None, verdict=before, reason=reason)
    return not_yet_no(result, left_out) if left_out else result


def _asked_for(layout: Layout, ways: Ways) -> Layout:
    """With the requirements of a bare part, where the layout has none."""
    if layout.require or any(stage.require for stage in layout.stages):
        return layout
    leaving: tuple[Requirement, ...] = tuple(word for word in LEAVING if word in ways.answers)
    return replace(
        layout, require={"locators": ("deterministic", "strongly_accessible", *leaving), "all": ("form_closure",)}
    )


def _words(layout: Layout) -> tuple[set[Requirement], set[Requirement]]:
    """What is required of locators alone, and of groups with other contacts."""
    names = {"locator", *(element.name for element in layout.elements if element.role == "locator")}
    of_locators, of_others = set(layout.require.get("locators", ())), set(layout.require.get("all", ()))
    for stage in layout.stages:
        (of_locators if set(stage.active) <= names else of_others).update(stage.require)
    return of_locators, of_others


def _task(layout: Layout, rules: CandidateRules) -> Task:
    """The layout as a task that asks for all that any of its stages requires."""
    assert layout.part is not None
    of_locators, of_others = _words(layout)
    require = {"locators": tuple(sorted(of_locators)), "all": tuple(sorted(of_others))}
    return Task(
        layout.name, layout.part, layout.space, rules, layout, require, Limits(), gravity=layout.gravity,
        friction=layout.friction, surface_gap=layout.surface_gap, key_features=layout.key_features, loads=layout.loads,
        source=layout.source, places=layout.places,
    )  # fmt: skip


def _problem(task: Task, ways: Ways, candidates: Candidates, cancelled: Callable[[], bool]) -> Problem:
    """Everything of the layout among the candidates; supports, fingers, bodies and given contacts stay."""
    assert task.start is not None
    assert task.require is not None
    of_locators, of_others = set(task.require["locators"]), set(task.require["all"])
    both = of_locators | of_others
    candidates = candidates.with_elements(elements_of(task.start, ways))
    others = [
        index
        for index, element in enumerate(candidates.elements)
        if element is not None and element.role not in ("locator", "clamp")
    ]
    closes_how = "with friction" if "force_closure" in both else None
    return Problem(
        candidates, task.limits, task.objective, (), tuple(others),
        locates=bool(of_locators & set(LOCATING)), leaves=bool(both & set(LEAVING)),
        opens="strongly_accessible" in of_locators, determines=bool(of_locators & {"deterministic", "accurate"}),
        closes="without friction" if "form_closure" in both else closes_how, features=features_of(task, candidates),
        duties=duties_of(task, Plan(task.require, task.friction), ways, candidates),
        standing=standing(task, candidates), cancelled=cancelled,
    )  # fmt: skip


def _first_that_holds(asked: Layout, ways: Ways, problem: Problem, fewest: Fewest) -> DesignResult:
    """What the fewest changes lead to, at their best places or where they were found; where that is not exact enough,
    more and more locators are moved besides.
    """
    locators, clamps = best_places(problem, fewest.locators, fewest.clamps, fewest.pool)
    first = _drawn_up(asked, ways, problem, (locators, clamps), fewest)
    if first.satisfied is Answer.YES:
        return first
    others = [(fewest.locators, fewest.clamps)]
    others = [one for one in others if not all(map(np.array_equal, one, (locators, clamps)))]
    exacter = more_exact(problem, locators, clamps, fewest.pool) if _inexact(first.verdict) else ()
    for one in chain(others, ((exact, clamps) for exact in exacter)):
        if problem.cancelled():
            break
        result = _drawn_up(asked, ways, problem, one, fewest)
        if result.satisfied is Answer.YES:
            return result
    return first


def _inexact(verdict: Verdict | None) -> bool:
    return verdict is not None and any(
        r.require == "accurate" and r.answer is not Answer.YES for r in verdict.requirements
    )


def _drawn_up(
    asked: Layout, ways: Ways, problem: Problem, best: tuple[Indices, Indices], fewest: Fewest
) -> DesignResult:
    """The changed layout with its verdict and the record of changes; preloads chosen where forces ask for it."""
    locators, clamps = best
    after, steps = changed(asked, problem, locators, clamps)
    verdict = ways.verify(after)
    if verdict.satisfied is not Answer.YES and problem.pushing is not None:
        names = {index_of(problem, e, clamps): e.name for e in after.elements if e.role == "clamp"}
        found = Found(locators, np.array([*names, *problem.clamps], dtype=np.int64), None, 0.0, 0.0)
        coming = [step.element for step in steps if step.action in ("added", "moved")]
        pushed = fewest_raised(ways, problem, found, after, names, coming)
        if pushed is not None:
            (after, verdict), steps = pushed, [*steps, *raised(asked, pushed[0])]
    satisfied = Answer.YES if verdict.satisfied is None else verdict.satisfied
    if satisfied is not Answer.YES:  # no number of changes is known to do
        reason = f"what was found does not verify: {failing(verdict)}"
        return DesignResult(Answer.UNDECIDED, after, verdict, tuple(steps), reason=reason)
    return DesignResult(
        satisfied, after, verdict, tuple(steps), changes=ChangeBound(len(steps), fewest.bound, fewest.complete)
    )
