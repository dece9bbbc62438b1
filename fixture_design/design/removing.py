"""Removing locators (section 2.7): those that constrain both ways, are in the way out, or locate the same thing twice.

Locators among which some balance constrain the part in both directions: it goes in by force only. BIDIRECTION
(Theorem 5) finds all that take part in such a balance, and one of them has to go; again, until none is left. Where the
part has to come out in a straight line the same is asked of the normals alone: normals that balance leave no direction
in which all locators are left at once. Locators that depend on each other without a balance locate something twice: the
part rests on some of them, and rocks.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, Rows
from fixture_design.cones.kernel import tucker_partition
from fixture_design.design.candidates import Candidates, Several, flat
from fixture_design.design.steps import Step
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT

#: Names of candidates.
Names = Callable[[int], str]


@dataclass(frozen=True)
class Cleared:
    """Locators that are left, and why the others had to go.

    Attributes:
        conflict: names of elements that have to stay and still constrain both ways, or are in the way.
    """

    locators: tuple[int, ...]
    steps: tuple[Step, ...]
    conflict: tuple[str, ...] = ()


def cleared(
    candidates: Candidates,
    locators: Sequence[int],
    staying: Sequence[int],
    name: Names,
    *,
    leaves: bool = True,
    opens: bool = True,
    out: Point | None = None,
) -> Cleared:
    """Locators without those that bind, with a record.

    Args:
        locators: indices of candidates.  staying: those of them that may not leave.
        leaves: whether the part must come out in a straight line; ``out``: in this direction.
        opens: whether some motion must leave all of them; if not, they may constrain both ways.
    """
    left, steps, conflict = list(locators), list[Step](), tuple[str, ...]()
    if leaves and out is not None:
        blocking = [one for one in left if (candidates.normals[one] @ out).max() > COPLANAR_ANGLE]
        steps += [Step("removed", name(one), "in the way") for one in blocking if one not in staying]
        conflict = tuple(name(one) for one in blocking if one in staying)
        left = [one for one in left if one not in blocking or one in staying]
    while opens and (bound := _bound(candidates, left, leaves)):
        movable = [one for one in bound if one not in staying]
        if not movable:
            return Cleared(tuple(left), tuple(steps), tuple(map(name, bound)))
        gone = min(movable, key=lambda one: _left_by(candidates, [o for o in left if o != one], leaves))
        steps.append(Step("removed", name(gone), "bound", circuit=tuple(map(name, bound))))
        left.remove(gone)
    while twice := _dependent(candidates, left):
        movable = [one for one in twice if one not in staying]
        if not movable:
            break
        gone = max(movable, key=lambda one: _spread(candidates, [o for o in left if o != one]))
        steps.append(Step("removed", name(gone), "twice", circuit=tuple(map(name, twice))))
        left.remove(gone)
    return Cleared(tuple(left), tuple(steps), conflict)


def _said(rows: Rows, each: int) -> tuple[Rows, np.ndarray]:
    """Rows that say something, and the number of the element each is of."""
    kept = rows.any(axis=1)
    return np.ascontiguousarray(rows[kept]), (np.arange(len(rows)) // each)[kept]


def balance_of(source: Several, chosen: Sequence[int] | Indices) -> tuple[Rows, Indices, Mask]:
    """Rows of the chosen candidates that say something, which of the chosen each is of, and which balance."""
    rows, owner = _said(flat(source, chosen), source.shape[1])
    return rows, owner, tucker_partition(rows, DEFAULT.tie).balanced if len(rows) else np.zeros(0, dtype=bool)


def bound_both_ways(candidates: Candidates, chosen: Indices) -> bool:
    """Whether there is a balance among locators, so that no motion leaves all of them."""
    return bool(balance_of(candidates.rows, chosen)[2].any())


def _bound(candidates: Candidates, chosen: Sequence[int], leaves: bool) -> list[int]:
    """The candidates that take part in a balance."""
    if not chosen:
        return []
    _, owner, balanced = balance_of(candidates.normals if leaves else candidates.rows, chosen)
    return [chosen[index] for index in np.unique(owner[balanced]).tolist()]


def _left_by(candidates: Candidates, chosen: Sequence[int], leaves: bool) -> tuple[int, int, float]:
    """How good it is if these are left, small is good: how many still bind, what is not located, how near together."""
    rows = flat(candidates.rows, chosen) if chosen else np.zeros((1, candidates.dimension))
    rank = int(np.linalg.matrix_rank(rows, DEFAULT.near))
    return len(_bound(candidates, chosen, leaves)), -rank, -_spread(candidates, chosen)


def _dependent(candidates: Candidates, chosen: Sequence[int]) -> list[int]:
    """The candidates with one row each that depend on others, as far as a single dependence goes; else none."""
    if not chosen:
        return []
    rows, owner = _said(flat(candidates.rows, chosen), candidates.rows.shape[1])
    left, values, _ = np.linalg.svd(rows)
    rank = int((values > DEFAULT.near * values[0]).sum()) if len(values) else 0
    if rank == len(rows):
        return []
    involved = np.linalg.norm(left[:, rank:], axis=1) > DEFAULT.near
    single = np.bincount(owner, minlength=len(chosen)) == 1
    return [chosen[index] for index in np.unique(owner[involved]).tolist() if single[index]]


def _spread(candidates: Candidates, chosen: Sequence[int]) -> float:
    """The product of the singular values of their rows that are not zero: how well they locate what they locate."""
    if not chosen:
        return 0.0
    values = np.linalg.svd(flat(candidates.rows, chosen), compute_uv=False)
    return float(np.prod(values[values > DEFAULT.near * values[0]]))
