"""Which of two results does more: one that holds, one of which nothing is known to fail, one of which more holds."""

from __future__ import annotations

from dataclasses import replace

from fixture_design.design.result import DesignResult
from fixture_design.layout import Answer

_RANK = {Answer.YES: 2, Answer.UNDECIDED: 1, Answer.NO: 0}


def merit(result: DesignResult) -> tuple[int, ...]:
    """Large is good; without a layout the least there is."""
    if result.layout is None or result.verdict is None:
        return (int(result.layout is not None),)
    answers = [required.answer for required in result.verdict.requirements]
    failing = answers.count(Answer.NO)
    return 1, _RANK[result.satisfied], int(failing == 0), answers.count(Answer.YES), -failing


def better_of(first: DesignResult, second: DesignResult) -> DesignResult:
    """The one that does more; of two that do as much the later one, which looked at more."""
    return first if merit(first) > merit(second) else second


def noted(result: DesignResult, *notes: str) -> DesignResult:
    """The result with more notes, each of them once."""
    return replace(result, notes=tuple(dict.fromkeys((*result.notes, *notes))))


def as_it_holds(result: DesignResult) -> DesignResult:
    """Without the bounds that a layout would be measured by, if it does not hold: those that do may be far from it."""
    if result.satisfied is Answer.YES:
        return result
    bound = None if result.bound is None else replace(result.bound, found=None)
    return replace(result, bound=bound, best_accuracy=None, best_preload=None, best_preload_here=None)
