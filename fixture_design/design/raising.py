"""Preloads changed on as few clamps as hold what has to be held; the others push with what they pushed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, islice

import numpy as np

from fixture_design.design.found import Found
from fixture_design.design.preloads import preloaded
from fixture_design.design.problem import Problem
from fixture_design.design.ways import Ways
from fixture_design.layout import Answer, Layout, Verdict

#: Sets of clamps that are tried.
_MOST_SETS = 64
#: Limits of a clamp that has none [N].
_ANY = (0.0, np.inf)


def fewest_raised(
    ways: Ways, problem: Problem, found: Found, layout: Layout, names: Mapping[int, str], coming: Sequence[str]
) -> tuple[Layout, Verdict] | None:
    """The layout with preloads that verify, changed on as few clamps as can be among sets of them; None without any.

    Args:
        names: of the clamps that may push, by candidate.
        coming: clamps that were not there before; what they push with is no change of its own.
    """
    clamps = {element.name: element for element in layout.elements if element.role == "clamp"}
    numbers = {name: index for index, name in names.items()}
    free = [name for name, clamp in clamps.items() if name in coming or clamp.preload is None]
    others = [name for name, clamp in clamps.items() if name not in free and not clamp.fixed]
    kept = {name: clamp.preload for name, clamp in clamps.items() if name not in free and clamp.preload is not None}
    for some in islice(_sets(others), _MOST_SETS):
        trial = _with_limits(
            problem,
            {
                numbers[name]: (kept[name], kept[name]) if name in kept and name not in some else clamp.limits or _ANY
                for name, clamp in clamps.items()
            },
        )
        assert trial.pushing is not None
        if np.isfinite(trial.pushing.least(found.locators, found.clamps).total):
            after, verdict = preloaded(ways, trial, found, layout, names)
            if verdict.satisfied is Answer.YES:
                return after, verdict
    return None


def _sets(names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    for count in range(len(names) + 1):
        yield from combinations(names, count)


def _with_limits(problem: Problem, limits: Mapping[int, tuple[float, float]]) -> Problem:
    """The problem in which some clamps push within these limits [N]."""
    assert problem.duties is not None
    low, high = problem.duties.low.copy(), problem.duties.high.copy()
    for index, (least, most) in limits.items():
        low[index], high[index] = least, most
    return replace(problem, duties=replace(problem.duties, low=low, high=high))
