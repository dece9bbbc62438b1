"""Holding loads: for each load the factors on it that contact forces balance, and whether 1 is one of them.

With w0 the weight and preloads, the factors a for which w0 + a w is balanced are an interval [needed, reserve]. The
load is held if 1 is inside by more than a tie, and the balance is shown; it is not if a motion shows that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from fixture_design.analysis.acting import LoadRow
from fixture_design.analysis.balancing import ForceBranch, Hint, Settled, branches_of, settle
from fixture_design.analysis.contact_forces import ContactForces
from fixture_design.analysis.factors import FactorTable, factor_table
from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.contacts import Contact
from fixture_design.layout import Answer, LoadVerdict, element_name
from fixture_design.tolerances import CARRIES, DEFAULT, LOAD_TIE, WITNESS, ZERO_ROW, Tolerances

First = tuple[tuple[str, Literal["slips", "lifts"]], ...]


@dataclass(frozen=True, eq=False)
class FactorRange:
    """Factors that one branch balances.

    Attributes:
        reserve: bracket of the largest one, needed: of the smallest one; both -inf and inf where there is none.
        first: what gives way beyond the reserve.
        hint: forces or a motion for factor 1.
    """

    reserve: tuple[float, float]
    needed: tuple[float, float]
    first: First = ()
    hint: Hint = field(default_factory=Hint)


def held_loads(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    constant: Vector,
    rows: Sequence[LoadRow],
    tolerances: Tolerances = DEFAULT,
) -> tuple[LoadVerdict, ...]:
    """For each load whether the contacts hold it together with ``constant``, a wrench about W's origin.

    Args:
        preloads: of elements that push with a given force [N].
    """
    branches, complete = branches_of(contacts, preloads, tolerances)
    acting = [row for row in rows if np.abs(row.wrench).max() > ZERO_ROW]
    wrenches = np.array([row.wrench for row in acting]).reshape(-1, len(constant))
    found = [factor_ranges(branch, constant, wrenches) for branch in branches]
    ranges = {id(row): [of_branch[k] for of_branch in found] for k, row in enumerate(acting)}
    return tuple(_held(branches, complete, constant, row, ranges.get(id(row)), tolerances) for row in rows)


def _held(
    branches: Sequence[ForceBranch],
    complete: bool,
    constant: Vector,
    row: LoadRow,
    ranges: Sequence[FactorRange] | None,
    tolerances: Tolerances,
) -> LoadVerdict:
    if ranges is None:
        return _without_load(row, settle(branches, complete, constant + row.wrench, tolerances))
    settled = settle(branches, complete, constant + row.wrench, tolerances, [found.hint for found in ranges])
    # the part is held only if it is in every branch
    first = min(ranges, key=lambda found: found.reserve[1])
    low, high = min(found.reserve[0] for found in ranges), first.reserve[1]
    reserve = None if high < 0 else (max(low, 0.0) if complete else 0.0, high)
    needed = max(0.0, *(next(filter(np.isfinite, found.needed[::-1]), 0.0) for found in ranges))
    answer, reason = _answer(settled, ranges)
    verdict = LoadVerdict(row.load, row.row, row.wrench, answer, reserve, needed, None, first.first, reason)
    return _with_proof(verdict, settled)


def _with_proof(verdict: LoadVerdict, settled: Settled) -> LoadVerdict:
    if verdict.answer is Answer.YES:
        return replace(verdict, proof=settled.balances[0], others=settled.balances[1:])
    return replace(verdict, proof=settled.against) if verdict.answer is Answer.NO else verdict


def _without_load(row: LoadRow, settled: Settled) -> LoadVerdict:
    """A load of nothing: any factor on it is the same."""
    if settled.balances:
        held = LoadVerdict(row.load, row.row, row.wrench, Answer.YES, (np.inf, np.inf), 0.0, None)
        return _with_proof(held, settled)
    answer = Answer.UNDECIDED if settled.reason else Answer.NO
    reserve = (0.0, np.inf) if settled.reason else None
    return _with_proof(
        LoadVerdict(row.load, row.row, row.wrench, answer, reserve, 0.0, None, (), settled.reason), settled
    )


def _answer(settled: Settled, ranges: Sequence[FactorRange]) -> tuple[Answer, str | None]:
    """The answer at factor 1: a proof, and 1 not within a tie of an end."""
    if settled.balances:
        clear = all(r.reserve[0] > 1 + LOAD_TIE and r.needed[1] < 1 - LOAD_TIE for r in ranges)
        return (Answer.YES, None) if clear else (Answer.UNDECIDED, _tie(ranges))
    if settled.reason is not None:
        return Answer.UNDECIDED, settled.reason
    outside = any(found.reserve[1] < 1 - LOAD_TIE or found.needed[0] > 1 + LOAD_TIE for found in ranges)
    return (Answer.NO, None) if outside else (Answer.UNDECIDED, _tie(ranges))


def _tie(ranges: Sequence[FactorRange]) -> str:
    first = [f"{name} {what}" for name, what in min(ranges, key=lambda found: found.reserve[1]).first]
    return f"a tie: the load is the largest that is held{', at which ' + ', '.join(first) if first else ''}"


def factor_ranges(branch: ForceBranch, constant: Vector, wrenches: Rows) -> list[FactorRange]:
    """The brackets of the factors on wrenches, shape (k, d), that a branch balances, with ``constant`` and preloads."""
    given = bool(branch.pushed_with) or bool(np.any(constant))
    own = branch.unit_for(constant) if given else 1.0
    inner = branch.inner.in_units_of(own)
    loads = np.array([inner.applied(wrench) for wrench in wrenches]).reshape(-1, len(inner.given))
    # loads at the size of what is given, so that a factor is about 1 where something gives way
    factors = 1 / np.abs(loads).max(axis=1)
    loads *= factors[:, None]
    fixed = inner.applied(constant) + inner.given
    holds = factor_table(inner.cones, fixed, loads)
    outer = inner if branch.alike else branch.outer.in_units_of(own)
    limits = holds if branch.alike else factor_table(outer.cones, outer.applied(constant) + outer.given, loads)
    return [_range(outer, holds, limits, k, float(factor), own) for k, factor in enumerate(factors)]


def _range(
    outer: ContactForces, holds: FactorTable, limits: FactorTable, load: int, factor: float, unit: float
) -> FactorRange:
    """One load's: what inner forces hold, what limits the outer ones, and what to try at factor 1."""
    up, down = holds.ends(load)
    reserve = _rounded(holds.lower[up]), _rounded(limits.upper[up])
    needed = _rounded(-limits.upper[down]), _rounded(-holds.lower[down])
    first: First = ()
    if np.isfinite(reserve[1]) and np.any(limits.motions[up]):
        first = giving_way(outer, limits.forces[up], limits.motions[up], limits.forces[down])
    x = holds.forces_at(load, 1 / factor)
    beyond = up if limits.upper[up] < 1 / factor else down if -limits.upper[down] > 1 / factor else None
    hint = Hint(None if x is None else x * unit, None if beyond is None else limits.motions[beyond])
    return FactorRange(_times(reserve, factor), _times(needed, factor), first, hint)


def _times(bracket: tuple[float, float], factor: float) -> tuple[float, float]:
    return bracket[0] * factor, bracket[1] * factor


def _rounded(factor: float) -> float:
    """Factors on loads of size 1 that are zero but for rounding are zero."""
    return 0.0 if abs(factor) <= WITNESS else float(factor)


def giving_way(forces: ContactForces, x: Weights, motion: Weights, other: Weights) -> First:
    """Elements that slip or lift when the part starts to move along a motion, pushed as hard as x says.

    Of those that lift, the ones that carry in ``other``, the forces under another factor, if there are any: what never
    carries does not give way.
    """
    products = forces.cones.maps.T @ (motion / np.linalg.norm(motion))
    # in units of which what acts is one at most
    least = CARRIES * max(1.0, float(np.abs(x).max(initial=0.0)), float(np.abs(other).max(initial=0.0)))
    found: dict[str, Literal["slips", "lifts"]] = {}
    carried: set[str] = set()
    cones = zip(forces.owners, forces.frictions, forces.cones.heads, forces.cones.blocks(), strict=True)
    for (index, _), friction, head, block in cones:
        push, leaving = float(x[block.start]), float(products[block.start])
        # columns of friction are as long as the friction is large
        across = float(np.linalg.norm(products[block][1:])) / friction if friction else 0.0
        name = element_name(forces.contacts[index].name)
        if push > least and across > CARRIES:
            found[name] = "slips"
        elif push <= least and np.isnan(head) and leaving > CARRIES:
            found.setdefault(name, "lifts")
            carried |= {name} if other[block.start] > least else set()
    return tuple(pair for pair in found.items() if pair[1] == "slips" or not carried or pair[0] in carried)
