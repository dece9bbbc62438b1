"""The record of a design: which motion was free and which element stopped it, which circuit bound and which left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Rows, Vector
from fixture_design.contacts import Scale, motion_about_origin
from fixture_design.design.candidates import flat
from fixture_design.design.problem import Problem
from fixture_design.tolerances import DEFAULT, SUM_ROUNDING

#: A translation that an element meets at this part of its normal, or more, is told before any rotation [-].
_STRAIGHT = 0.3


@dataclass(frozen=True, eq=False)
class Step:
    """One element that came, left, moved, or pushes with something else.

    Attributes:
        action: "added" or "removed".  element: its name.
        why: "unnoticed": no locator noticed ``motion``; "free": nothing stopped it; "bound": the elements of
            ``circuit`` constrained both ways; "twice": they located the same thing; "in the way": the part could not
            come out past it; "spare": the others do without it; "loads": it takes another preload.
        motion: [dx; dtheta] about W's origin; None where there is none to tell.  preload: the new one [N].
    """

    action: Literal["added", "removed", "moved", "preloaded"]
    element: str
    why: Literal["unnoticed", "free", "bound", "twice", "in the way", "spare", "loads"]
    motion: Vector | None = None
    circuit: tuple[str, ...] = ()
    preload: float | None = None


def in_world(motion: Vector, scale: Scale) -> Vector:
    """A unit motion of scaled rows as [dx; dtheta] about W's origin; what is only rounding becomes zero."""
    tidy = np.where(np.abs(motion) < SUM_ROUNDING, 0.0, motion)
    return motion_about_origin(tidy, scale.reference, scale.length)


def additions(problem: Problem, locators: Indices, clamps: Indices, names: dict[int, str]) -> list[Step]:
    """Why each new element is there, one after the other: the motion that was free before it, and is not after it.

    Args:
        names: of all elements, by candidate; those of the start are there from the beginning.
    """
    steps, here = [], [*problem.locators]
    for locator in (int(index) for index in locators if index not in problem.locators):
        motion = unnoticed(problem, here, locator)
        steps.append(_step(problem, names[locator], "unnoticed", motion))
        here.append(locator)
    before = [int(index) for index in clamps if problem.candidates.elements[index] is not None]
    here += before
    for clamp in (int(index) for index in clamps if index not in before):
        motion = stopped(problem, here, clamp)
        steps.append(_step(problem, names[clamp], "free", motion))
        here.append(clamp)
    return steps


def _step(problem: Problem, name: str, why: Literal["unnoticed", "free"], motion: Vector | None) -> Step:
    return Step("added", name, why, None if motion is None else in_world(motion, problem.candidates.scale))


def unnoticed(problem: Problem, here: list[int], locator: int) -> Vector | None:
    """A motion that no locator so far notices, and this one does: a straight one if there is one, else the one that it
    notices most.
    """
    row = problem.rows[problem.rows_of((locator,))[0]]
    rows = problem.rows[problem.rows_of(tuple(here))] if here else np.zeros((1, len(row)))
    p = problem.candidates.points.shape[2]
    straight = _off(row[:p], rows[:, :p])
    if np.linalg.norm(straight) > _STRAIGHT * np.linalg.norm(row[:p]):
        return np.pad(straight / np.linalg.norm(straight), (0, len(row) - p))
    least = _off(row, rows)
    length = float(np.linalg.norm(least))
    return least / length if length > DEFAULT.near else None


def _off(vector: Vector, rows: Rows) -> Vector:
    """The part of a vector that is orthogonal to some rows."""
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    basis = right[values > DEFAULT.near * max(float(values[0]), DEFAULT.near)]
    return vector - vector @ basis.T @ basis


def stopped(problem: Problem, here: list[int], clamp: int) -> Vector | None:
    """A motion that is free before this clamp and that it stops: a straight one if there is one; None without any."""
    rows = flat(problem.closing_rows, here) if here else np.zeros((1, problem.candidates.dimension))
    p = problem.candidates.points.shape[2]
    straight = _pushed(rows[:, :p], flat(problem.closing_rows, [clamp])[:, :p])
    if straight is not None:
        return np.pad(straight, (0, rows.shape[1] - p))
    return _pushed(rows, flat(problem.closing_rows, [clamp]))


def _pushed(rows: Rows, stopping: Rows) -> Vector | None:
    """The motion that ``stopping`` stops most: max d . u with rows . u <= 0 and no coordinate above 1."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    best, motion = DEFAULT.near, None
    for row in stopping:
        found = linprog(-row, A_ub=rows, b_ub=np.zeros(len(rows)), bounds=(-1, 1), method="highs")
        if found.x is not None and -found.fun > best:
            best, motion = -found.fun, found.x / np.linalg.norm(found.x)
    return motion
