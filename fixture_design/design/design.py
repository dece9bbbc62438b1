"""From a task to a layout that holds: what the command `fixture-design design` does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

from fixture_design.arrays import Vector
from fixture_design.design.attempt import Asked, attempt, leaves_straight, opens_all
from fixture_design.design.fitting import fitting
from fixture_design.design.merit import better_of, noted
from fixture_design.design.plans import Plan, by_certainty, plans, unused_friction
from fixture_design.design.result import DesignResult
from fixture_design.design.shortfall import left_out_in_words, not_yet_no
from fixture_design.design.task import Task
from fixture_design.design.touching import candidates_of
from fixture_design.design.ways import Progress, Ways, ways_of
from fixture_design.layout import Answer


def design(
    task: Task,
    ways: Ways | None = None,
    *,
    seed: int = 0,
    progress: Progress = lambda words, part: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> DesignResult:
    """The best layout with the fewest elements that does what a task asks, verified; or why there is none.

    Args:
        ways: geometry and verification; by default of the task's part.
        seed: another one gives other candidates and restarts; the same one the same layout.
        progress: told what is being done.  cancelled: once it says True the best so far is the result.

    Raises:
        InputError: the part or the start layout cannot be used; the rules leave no candidates.

    Example:
        >>> design(read_task("bracket.task.yaml")).layout        # doctest: +SKIP
    """
    ways = ways or ways_of(task.part, task.surface_gap)
    asked = Asked(task, ways, seed, progress, cancelled)
    best = _searched(asked)
    if best.satisfied is not Answer.UNDECIDED or not task.candidates.more_tips or cancelled():
        return best
    simpler = replace(asked, task=replace(task, candidates=replace(task.candidates, more_tips=())))
    found = _searched(simpler)
    if found.satisfied is not Answer.YES:
        return best
    return noted(found, "with the first kind of tip alone: with all kinds no layout was found that holds")


def _searched(asked: Asked) -> DesignResult:
    task, ways, seed, progress, cancelled = asked.task, asked.ways, asked.seed, asked.progress, asked.cancelled
    progress("candidates", 0.0)
    candidates, left_out_notes = candidates_of(task, ways, ways.spots(task.candidates, seed))
    candidates, no_room = fitting(task, ways, candidates)
    left_out_notes += no_room + unused_friction(task)
    best: DesignResult | None = None
    free: Vector | None = None
    certain = False
    flat_first = not task.candidates.round_too
    for plan in plans(task, ways):
        for some in by_certainty(candidates, round_too=not flat_first):
            for slides, keep_all in _turns(task, plan):
                if slides and best is not None and best.free is not None:
                    break  # a motion that no candidate stops is free however the part comes out
                found = attempt(asked, some, plan, keep_all=keep_all, slides=slides)
                if left_out := len(candidates) - len(some):
                    found = replace(found, notes=(*found.notes, left_out_in_words(left_out, flat_first=flat_first)))
                    found = not_yet_no(found, left_out)
                found = replace(found, notes=(*found.notes, *left_out_notes))
                best = found if best is None else better_of(best, found)
                stopped = cancelled()  # asked once: what is stopped in between is no proof either
                if stopped:
                    best = _stopped(best)
                if stopped or best.satisfied is Answer.YES:
                    return best if free is None else _instead(best, free, certain)
        certain = best is not None and best.satisfied is Answer.NO
        if best is None or best.layout is not None or best.free is None:
            break
        free = best.free  # the next plan has to live with it
    assert best is not None  # there is at least one plan, and candidates for it
    return best


def _stopped(best: DesignResult) -> DesignResult:
    """What was found before the search was stopped; it proves no no."""
    if best.satisfied is not Answer.NO:
        return best
    reason = f"{best.reason}; the search was stopped before all was tried"
    return replace(best, satisfied=Answer.UNDECIDED, reason=reason)


def _instead(second: DesignResult, free: Vector, certain: bool) -> DesignResult:
    """What another plan gave, where the first one left a motion free; no yes as long as that is not certain."""
    if certain or second.satisfied is not Answer.YES:
        return replace(second, free=free)
    reason = (
        f"{second.reason}; whether one without friction does is open: facets that may stand for round surfaces have "
        "normals that are not known (`part: {faceted: true}` says that every facet is meant as it is)"
    )
    return replace(second, satisfied=Answer.UNDECIDED, free=free, reason=reason)


def _turns(task: Task, plan: Plan) -> list[tuple[bool, bool]]:
    """What is tried in turn: whether the part slides on its way out, and whether what the start has is all kept."""
    ways_out = (False, True) if leaves_straight(task, plan) and opens_all(plan) else (False,)
    return list(product(ways_out, (True, False) if _may_let_go(task) else (True,)))


def _may_let_go(task: Task) -> bool:
    return task.start is not None and any(not e.fixed for e in task.start.elements if e.role in ("locator", "clamp"))
