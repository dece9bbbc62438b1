"""What is proven about the number of elements, and why there is no layout."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.design.found import Found, Outcome
from fixture_design.design.locating_several import fewest_locators
from fixture_design.design.problem import Problem
from fixture_design.design.regions import least_clamps_sliding
from fixture_design.design.result import Bound, DesignResult
from fixture_design.design.start import Start
from fixture_design.layout import Answer, Verdict


def bound_of(problem: Problem, outcome: Outcome) -> Bound | None:
    """What is proven about the number of elements."""
    if outcome.least_clamps is None:
        return None
    found = None if outcome.found is None else outcome.found.count
    if outcome.least_elements is not None:
        return Bound(0, 0, outcome.least_elements, found, outcome.complete, len(problem.candidates))
    locators = fewest_locators(problem) if problem.determines else len(problem.locators)
    single = problem.each == 1 and problem.closes == "without friction"
    elements = max(locators + outcome.least_clamps, problem.candidates.dimension + 1 if single else 0)
    clamps = max(0, outcome.least_clamps - problem.supporting)
    letting_go = problem.lets_go
    return Bound(locators, clamps, elements, found, outcome.complete, len(problem.candidates), letting_go)


def refused(problem: Problem, found: Found) -> bool:
    """Whether there are more elements than there may be, or they cannot hold what has to be held."""
    if not found.holds:
        return True
    limits = problem.limits
    many_locators = limits.locators is not None and len(found.locators) > limits.locators
    return many_locators or (limits.clamps is not None and len(found.clamps) - problem.supporting > limits.clamps)


def failing(verdict: Verdict) -> str:
    """Which requirements do not hold, and why, where that is told."""
    told = []
    for required in verdict.requirements:
        if required.answer is not Answer.YES:
            finding = verdict.groups[required.group].findings.get(required.require)
            why = f" ({finding.reason})" if finding is not None and finding.reason else ""
            told.append(f"{required.require} of {required.group} is {required.answer or 'not asked'}{why}")
    return "; ".join(told)


def _not_held(problem: Problem, outcome: Outcome, bound: Bound | None, start: Start) -> DesignResult:
    """No clamps hold the loads within the limits of their preload, where there are any."""
    limited = problem.duties is not None and bool(np.isfinite(problem.duties.high[problem.duties.pushes]).any())
    within = " within the limits of the preload" if limited else ", whatever the clamps push with"
    if outcome.best_preload == np.inf and outcome.complete and not problem.uncertain:
        reason = f"no layout among these candidates holds the loads{within}"
        return DesignResult(Answer.NO, None, steps=start.steps, bound=bound, reason=reason)
    reason = f"no layout was found that holds the loads{within}"
    return DesignResult(Answer.UNDECIDED, None, steps=start.steps, bound=bound, reason=reason)


def without_layout(problem: Problem, outcome: Outcome, bound: Bound | None, start: Start, seed: int) -> DesignResult:
    """Why there is none, and whether that is proven.

    Ways out that leave every locator at once are searched where some motion has to; others, along which the part
    slides, are only bounded.
    """
    limits, steps = problem.limits, start.steps
    sure = not (problem.uncertain or problem.cancelled())
    complete = outcome.complete and problem.determines and sure
    never = outcome.found is None and outcome.best_preload == np.inf
    if never or (outcome.found is not None and not outcome.found.holds):
        return _not_held(problem, outcome, bound, start)
    if bound is None:
        reason = "no straight way out leaves enough places for locators that determine the part"
        if complete and problem.lets_go:
            complete = least_clamps_sliding(problem, seed, 1) == np.inf
            reason += " and is not only slid out of" if not complete else ""
        answer = Answer.NO if complete else Answer.UNDECIDED
        return DesignResult(answer, None, steps=steps, reason=reason)
    for what, least, most in (("locators", bound.locators, limits.locators), ("clamps", bound.clamps, limits.clamps)):
        if most is not None and least > most:
            certain = bound.complete and sure and (what == "clamps" or problem.determines)
            if certain and what == "clamps" and problem.lets_go:
                allowed = most + problem.supporting
                certain = least_clamps_sliding(problem, seed, allowed + 1) > allowed
            answer = Answer.NO if certain else Answer.UNDECIDED
            reason = f"at least {least} {what} are needed among these candidates, and at most {most} are allowed"
            if not certain and problem.lets_go:
                reason += ", where some direction is to leave all locators at once"
            return DesignResult(answer, None, steps=steps, bound=bound, reason=reason)
    if limits.locators is not None and limits.clamps is not None:
        allowed = limits.locators + limits.clamps + problem.supporting
        if allowed < bound.elements:
            reason = f"at least {bound.elements} elements are needed among these candidates, and {allowed} are allowed"
            return DesignResult(Answer.NO if bound.complete and sure and not problem.lets_go else Answer.UNDECIDED,
                                None, steps=steps, bound=bound, reason=reason)  # fmt: skip
    needed = f"{bound.locators} locators and {bound.clamps} clamps"
    needed = needed if outcome.least_elements is None else f"{bound.elements} elements"
    reason = f"no layout was found; at least {needed} are needed"
    if problem.limits.spacing > 0:
        reason += f", at least {problem.limits.spacing:g} m from each other"
    if problem.standing is not None:
        reason += ", with stems and bodies out of each other's way"
    if problem.cancelled():
        reason = "the search was stopped before it found a layout"
    return DesignResult(Answer.UNDECIDED, None, steps=steps, bound=bound, reason=reason)


def left_out_in_words(count: int, *, flat_first: bool = False) -> str:
    """A note on candidates that were not looked at, maybe since flat ones do."""
    words = f"{count} candidates on round or uncertain surfaces were left out: with them fewer elements might do"
    return f"{words} (`candidates: {{round: true}}` counts those that are known well)" if flat_first else words


def not_yet_no(found: DesignResult, left_out: int) -> DesignResult:
    """A no that some candidates had no part in is none."""
    if found.satisfied is not Answer.NO:
        return found
    reason = (
        f"{found.reason}; {left_out} more, whose normals are known less well, were not looked at "
        "(`part: {faceted: true}` says that every facet is meant as it is)"
    )
    return replace(found, satisfied=Answer.UNDECIDED, reason=reason)
