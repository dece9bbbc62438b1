"""Repair: the smallest change to a layout that makes it do what it requires.

Elements moved, added or removed, and preloads changed; what is ``fixed`` stays. The number of moves, additions and
removals that locating, a way out and closure take has a proof (`changes`); what forces and accuracy take besides is
found step by step. Among changes that are as few, the places are those that are best for the objective.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.contacts import Role
from fixture_design.design.candidates import Candidates
from fixture_design.design.changed_layout import changed, index_of, raised
from fixture_design.design.changes import Options, fewest_changes
from fixture_design.design.clamping import closes, held_best
from fixture_design.design.features import features_of
from fixture_design.design.fitting import fitting, standing
from fixture_design.design.found import Found
from fixture_design.design.locating import exchanged
from fixture_design.design.plans import LEAVING, LOCATING, Plan, by_certainty
from fixture_design.design.preloads import duties_of
from fixture_design.design.pressing import pressed_clamps
from fixture_design.design.problem import Problem
from fixture_design.design.raising import fewest_raised
from fixture_design.design.regions import ways_out
from fixture_design.design.result import ChangeBound, DesignResult
from fixture_design.design.search import search
from fixture_design.design.shortfall import failing
from fixture_design.design.start import begun, elements_of
from fixture_design.design.task import CandidateRules, Limits, Task
from fixture_design.design.touching import candidates_of
from fixture_design.design.ways import Progress, Ways, ways_of
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Answer, Layout, Requirement
from fixture_design.tolerances import COPLANAR_ANGLE


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
    for some in by_certainty(everything):
        problem = _problem(task, ways, some, cancelled)
        found = _fewest(task, ways, problem, seed, progress)
        if np.isfinite(found.found):
            best = _best_places(problem, found.locators, found.clamps, found.pool)
            # what certainly does not hold does not hold without a change
            least = max(found.bound, int(before is not None and before.satisfied is Answer.NO))
            return _drawn_up(asked, ways, problem, best, least, found.complete)
        proven &= found.complete and not some.errors.any()
    what = "no changes among these candidates" if proven else "no changes were found that"
    reason = f"{what} make it locate, let out and close what it has to"
    return DesignResult(Answer.NO if proven else Answer.UNDECIDED, None, verdict=before, reason=reason)


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


def _of_role(problem: Problem, role: Role) -> Indices:
    elements = enumerate(problem.candidates.elements)
    return np.array([index for index, e in elements if e is not None and e.role == role], np.int64)


@dataclass(frozen=True, eq=False)
class _Fewest:
    """The fewest changes there are in some ways out.

    Attributes:
        found: how many; inf without any.  bound: no layout takes fewer, if ``complete``.
        locators, clamps: of the layout they lead to.  pool: where its locators may be.
    """

    found: float
    bound: int
    complete: bool
    locators: Indices
    clamps: Indices
    pool: Indices


def _fewest(task: Task, ways: Ways, problem: Problem, seed: int, progress: Progress) -> _Fewest:
    """The fewest changes. What a design from this start gives has only to be matched."""
    return _among_ways(problem, seed, progress, _as_designed(task, ways, problem, seed, progress))


def _as_designed(task: Task, ways: Ways, problem: Problem, seed: int, progress: Progress) -> _Fewest:
    """What the search for the best layout makes of this start, with all clamps that it had."""
    none = np.zeros(0, dtype=np.int64)
    new = problem.candidates.chosen(problem.new)
    start = begun(task, new, ways, keep_all=True, leaves=True, opens=True)
    as_begun = replace(
        problem, locators=start.locators, clamps=start.others, spare=start.spare, leaves=True, opens=True
    )
    found = None if start.conflict or problem.never_stopped is not None else search(as_begun, seed, progress).found
    if found is None:
        return _Fewest(np.inf, 0, True, none, none, none)
    locators, clamps = _of_role(problem, "locator"), _of_role(problem, "clamp")
    after = np.setdiff1d(np.union1d(found.clamps, clamps), np.array(problem.clamps, dtype=np.int64))
    moves = _changes(locators, found.locators) + _changes(clamps, after)
    pool = problem.new
    if found.out is not None:
        pool = pool[(problem.candidates.normals[pool, 0] @ found.out) < -COPLANAR_ANGLE]
    return _Fewest(float(moves), 0, True, found.locators, after, pool)


def _changes(before: Indices, after: Indices) -> int:
    """Of one role: one that leaves and one that comes are one change."""
    return max(len(np.setdiff1d(before, after)), len(np.setdiff1d(after, before)))


def _among_ways(problem: Problem, seed: int, progress: Progress, best: _Fewest) -> _Fewest:
    """The fewest changes in any way out, or ``best`` if there are no fewer; the bound is of all these ways.

    The part may slide out along its locators; that some motion leaves all of them is asked for itself.
    """
    locators, clamps = _of_role(problem, "locator"), _of_role(problem, "clamp")
    fixed = np.array([i for i, e in enumerate(problem.candidates.elements) if e is not None and e.fixed], np.int64)
    ways, complete = ways_out(replace(problem, opens=False), seed)
    bound, complete = np.inf, complete and not problem.vague
    # where many locators have to leave there are many changes
    for number, (_, allowed) in enumerate(sorted(ways, key=lambda way: int((~way[1][locators]).sum()))):
        leaving = int((~allowed[locators]).sum())
        if not allowed[np.intersect1d(fixed, locators)].all():
            continue
        if leaving >= best.found:
            bound = min(bound, leaving)
            break
        progress(f"way out {number + 1} of {len(ways)}", number / len(ways))
        pool = problem.new[allowed[problem.new]]
        options = Options.of(problem, locators[allowed[locators]], clamps, fixed, pool)
        found = fewest_changes(problem, options, leaving, best.found, problem.cancelled)
        sure = found
        if problem.closes == "with friction":  # the true cones close with no more than the larger ones
            sure = fewest_changes(replace(problem, generous=True), options, leaving, best.found, problem.cancelled)
        bound, complete = min(bound, sure.bound), complete and sure.complete
        if found.locators is not None and found.clamps is not None:
            best = _Fewest(float(found.bound), 0, True, found.locators, found.clamps, pool)
    least = int(min(bound, best.found)) if np.isfinite(min(bound, best.found)) else 0
    return replace(best, bound=least, complete=complete and not problem.cancelled())


def _best_places(problem: Problem, locators: Indices, clamps: Indices, pool: Indices) -> tuple[Indices, Indices]:
    """What comes, moved to where it is best: locators as exact as they can be, clamps with the largest margin."""
    staying = locators[~np.isin(locators, problem.new)]
    if problem.each == 1 and len(locators) == problem.candidates.freedoms and problem.locates:
        moved = exchanged(problem.rows, pool, locators, staying, problem.features)
        everything = np.concatenate([moved, clamps])
        if problem.together(everything) and (problem.closes is None or closes(problem.closing_rows, everything)):
            locators = moved
    coming = clamps[np.isin(clamps, problem.new)]
    others = np.concatenate([locators, np.setdiff1d(clamps, coming), np.array(problem.clamps, dtype=np.int64)])
    if problem.closes is not None and len(coming):
        free = np.setdiff1d(problem.new, others)
        coming, _ = held_best(
            problem.closing_rows, others, coming, free, problem.candidates.places, standing=problem.standing
        )
    old = np.setdiff1d(clamps, problem.new)
    if problem.pushing is not None and len(coming):
        pressed = pressed_clamps(
            replace(problem, spare=tuple(old.tolist())), problem.pushing, locators, np.concatenate([old, coming])
        )
        if np.isfinite(pressed.total) and len(pressed.clamps) == len(clamps):
            coming = np.setdiff1d(pressed.clamps, old)
    return locators, np.concatenate([old, coming])


def _drawn_up(
    asked: Layout, ways: Ways, problem: Problem, best: tuple[Indices, Indices], bound: int, complete: bool
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
    reason = None if satisfied is Answer.YES else f"what was found does not verify: {failing(verdict)}"
    return DesignResult(
        Answer.UNDECIDED if satisfied is Answer.NO else satisfied, after, verdict, tuple(steps),
        changes=ChangeBound(len(steps), bound, complete), reason=reason,
    )  # fmt: skip
