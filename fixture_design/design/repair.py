"""Repair: the smallest change to a layout that makes it do what it requires.

Elements moved, added or removed, and preloads changed; what is ``fixed`` stays. The number of moves, additions and
removals that locating, a way out and closure take has a proof (`changes`); what forces and accuracy take besides is
found step by step. Among changes that are as few, the places are those that are best for the objective.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.design.candidates import Candidates
from fixture_design.design.changing import Fewest, fewest_over_ways
from fixture_design.design.features import features_of
from fixture_design.design.fitting import fitting, standing
from fixture_design.design.mended import NamedLeavesError, first_that_holds
from fixture_design.design.plans import LEAVING, LOCATING, Plan, by_certainty
from fixture_design.design.preloads import duties_of
from fixture_design.design.problem import Problem
from fixture_design.design.result import ChangeBound, DesignResult, closure_margin
from fixture_design.design.shortfall import left_out_in_words, not_yet_no
from fixture_design.design.staged import as_seen, aside, unlike_asked, words
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
        return DesignResult(
            Answer.YES, asked, before, margin=closure_margin(before), changes=ChangeBound(0, 0, complete=True)
        )
    mending = _Mending(asked, before, ways, seed, rules or CandidateRules(), progress, cancelled)
    others = aside(asked)
    result = mending.result(others)
    if others and result.satisfied is not Answer.YES and not cancelled():  # they may be what has to change
        again = mending.result(frozenset())
        return again if again.satisfied is Answer.YES else result
    return result


@dataclass(frozen=True, eq=False)
class _Mending:
    """A layout that is to be repaired, and its verdict as it is, if it touches the part at all."""

    asked: Layout
    before: Verdict | None
    ways: Ways
    seed: int
    rules: CandidateRules
    progress: Progress
    cancelled: Callable[[], bool]

    @cached_property
    def unlike(self) -> str | None:
        """Where what is looked for is not quite what is asked."""
        return unlike_asked(self.asked)

    def result(self, left_aside: frozenset[str], staying: frozenset[str] = frozenset()) -> DesignResult:
        """The fewest changes that leave some locators aside and some elements where they are; no named one leaves."""
        try:
            return self._among_candidates(_task(as_seen(self.asked, left_aside, staying), self.rules))
        except NamedLeavesError as error:
            return self.result(left_aside, staying | error.names)

    def _among_candidates(self, task: Task) -> DesignResult:
        self.progress("candidates", 0.0)
        proven, left_out = self.unlike is None, 0
        everything, _ = candidates_of(task, self.ways, self.ways.spots(task.candidates, self.seed))
        everything, _ = fitting(task, self.ways, everything)
        for some in by_certainty(everything):
            left_out = len(everything) - len(some)
            problem = _problem(task, self.ways, some, self.cancelled)
            found = fewest_over_ways(task, self.ways, problem, self.seed, self.progress)
            if np.isfinite(found.found):
                result = first_that_holds(self.asked, self.ways, problem, self._with_bound(found))
                return self._with_notes(result, left_out)
            proven &= found.complete and not (some.errors.any() or problem.vague or problem.barely_stopped)
        what = "no changes among these candidates" if proven else "no changes were found that"
        reason = f"{what} make it locate, let out and close what it has to"
        result = DesignResult(Answer.NO if proven else Answer.UNDECIDED, None, verdict=self.before, reason=reason)
        return self._with_notes(not_yet_no(result, left_out) if left_out else result, 0)

    def _with_bound(self, found: Fewest) -> Fewest:
        """What certainly does not hold does not hold without a change; that may be all that is known."""
        least = int(self.before is not None and self.before.satisfied is Answer.NO)
        if self.unlike is not None:
            return replace(found, bound=least, complete=False)
        return replace(found, bound=max(found.bound, least))

    def _with_notes(self, result: DesignResult, left_out: int) -> DesignResult:
        if left_out:
            result = replace(result, notes=(*result.notes, left_out_in_words(left_out)))
        if self.unlike is None:
            return result
        if result.satisfied is not Answer.YES:
            return replace(result, reason=f"{result.reason}; {self.unlike}")
        return replace(result, notes=(*result.notes, f"that these are the fewest changes has no proof: {self.unlike}"))


def _asked_for(layout: Layout, ways: Ways) -> Layout:
    """With the requirements of a bare part, where the layout has none."""
    if layout.require or any(stage.require for stage in layout.stages):
        return layout
    leaving: tuple[Requirement, ...] = tuple(word for word in LEAVING if word in ways.answers)
    return replace(
        layout, require={"locators": ("deterministic", "strongly_accessible", *leaving), "all": ("form_closure",)}
    )


def _task(layout: Layout, rules: CandidateRules) -> Task:
    """The layout as a task that asks for all that any of its stages requires."""
    assert layout.part is not None
    of_locators, of_others = words(layout)
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
