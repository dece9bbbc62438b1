"""Which result a design keeps, and what it says about one that does not hold."""

from __future__ import annotations

import numpy as np

from fixture_design.design.merit import as_it_holds, better_of, noted
from fixture_design.design.result import Bound, DesignResult
from fixture_design.layout import Answer, Layout, RequirementVerdict, Verdict

YES, NO, OPEN = Answer.YES, Answer.NO, Answer.UNDECIDED


def result(*answers: Answer, satisfied: Answer = OPEN) -> DesignResult:
    """A layout whose requirements have these answers; design calls all that do not hold undecided."""
    required = tuple(RequirementVerdict("all", "seated", answer) for answer in answers)
    verdict = Verdict("some", None, "spatial", satisfied, {}, (), required, (), np.zeros(3), 1.0)
    bound = Bound(6, 1, 7, 7, True, 80)
    return DesignResult(satisfied, Layout("some"), verdict, bound=bound, best_accuracy=1.0, preload=300.0,
                        best_preload=0.0, best_preload_here=160.0)  # fmt: skip


def test_searching_on_never_makes_the_answer_worse() -> None:
    nearly, worse = result(YES, YES, YES, OPEN), result(YES, NO, OPEN, OPEN)
    assert better_of(nearly, worse) is nearly
    assert better_of(worse, nearly) is nearly


def test_a_requirement_that_fails_is_worse_than_one_that_is_open() -> None:
    failing, open_ = result(YES, YES, NO), result(YES, OPEN, OPEN)
    assert better_of(failing, open_) is open_
    assert better_of(open_, failing) is open_


def test_what_holds_is_kept_and_of_equals_the_later() -> None:
    holds, none = result(YES, YES, satisfied=YES), DesignResult(NO, None)
    assert better_of(holds, result(YES, OPEN)) is holds
    assert better_of(result(NO, NO), none).layout is not None
    assert better_of(none, result(NO, NO)).layout is not None
    first, second = result(YES, OPEN), result(OPEN, YES)
    assert better_of(first, second) is second


def test_a_note_is_told_once() -> None:
    assert noted(noted(result(YES), "twice", "once"), "twice").notes == ("twice", "once")


def test_no_bound_is_told_beside_what_does_not_hold() -> None:
    told = as_it_holds(result(YES, OPEN))
    assert told.best_preload is None
    assert told.best_preload_here is None
    assert told.best_accuracy is None
    assert told.bound is not None
    assert told.bound.gap is None
    assert told.bound.elements == 7  # which is so for every layout
    assert as_it_holds(result(YES, satisfied=YES)).best_preload == 0.0
