"""What the fewest changes lead to: a layout, verified, with the record of its changes."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.design.changed_layout import changed, index_of, raised
from fixture_design.design.changing import Fewest, best_places, more_exact
from fixture_design.design.found import Found
from fixture_design.design.problem import Problem
from fixture_design.design.raising import fewest_raised
from fixture_design.design.result import ChangeBound, DesignResult, closure_margin
from fixture_design.design.shortfall import failing
from fixture_design.design.staged import named_by_stages
from fixture_design.design.ways import Ways
from fixture_design.layout import Answer, Layout, Verdict


class NamedLeavesError(Exception):
    """Elements leave that a stage names: then it would name nobody."""

    def __init__(self, names: frozenset[str]) -> None:
        super().__init__(", ".join(sorted(names)))
        self.names = names


def first_that_holds(asked: Layout, ways: Ways, problem: Problem, fewest: Fewest) -> DesignResult:
    """What the fewest changes lead to, at their best places or where they were found; where that is not exact enough,
    more and more locators are moved besides.

    Raises:
        NamedLeavesError: elements leave that a stage names.
    """
    locators, clamps = best_places(problem, fewest.locators, fewest.clamps, fewest.pool)
    first = _drawn_up(asked, ways, problem, (locators, clamps), fewest)
    if first.satisfied is Answer.YES:
        return _without_needless(ways, first)
    others = [(fewest.locators, fewest.clamps)]
    others = [one for one in others if not all(map(np.array_equal, one, (locators, clamps)))]
    exacter = more_exact(problem, locators, clamps, fewest.pool) if _inexact(first.verdict) else ()
    for one in chain(others, ((exact, clamps) for exact in exacter)):
        if problem.cancelled():
            break
        result = _drawn_up(asked, ways, problem, one, fewest)
        if result.satisfied is Answer.YES:
            return _without_needless(ways, result)
    return first


def _without_needless(ways: Ways, result: DesignResult) -> DesignResult:
    """Without elements that were added for what moves, raised preloads or other places have brought about since."""
    for step in result.steps:
        layout, changes = result.layout, result.changes
        assert layout is not None
        assert changes is not None
        if step.action != "added" or changes.found <= max(changes.bound, 1):
            continue
        less = replace(layout, elements=tuple(e for e in layout.elements if e.name != step.element))
        verdict = ways.verify(less)
        if verdict.satisfied is Answer.YES:
            steps = tuple(other for other in result.steps if other is not step)
            result = replace(
                result, layout=less, verdict=verdict, steps=steps, margin=closure_margin(verdict),
                changes=replace(changes, found=len(steps)),
            )  # fmt: skip
    return result


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
    gone = named_by_stages(asked) & {step.element for step in steps if step.action == "removed"}
    if gone:
        raise NamedLeavesError(gone)
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
    changes = ChangeBound(len(steps), fewest.bound, fewest.complete, len(problem.new))
    return DesignResult(satisfied, after, verdict, tuple(steps), margin=closure_margin(verdict), changes=changes)
