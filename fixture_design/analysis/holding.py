"""Holding loads: for each load the factors on it that contact forces balance, and whether 1 is one of them.

With w0 the weight and preloads, the factors a for which w0 + a w is balanced are an interval [needed, reserve]. The
load is held if 1 is inside by more than a tie, and the balance is shown; it is not if a motion shows that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fixture_design.analysis.acting import LoadRow
from fixture_design.analysis.balancing import ForceBranch, Settled, branches_of, settle
from fixture_design.analysis.contact_forces import ContactForces
from fixture_design.analysis.loads import largest_factors
from fixture_design.arrays import Vector, Weights
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
    """

    reserve: tuple[float, float]
    needed: tuple[float, float]
    first: First = ()


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
    return tuple(_held(branches, complete, constant, row, tolerances) for row in rows)


def _held(
    branches: Sequence[ForceBranch], complete: bool, constant: Vector, row: LoadRow, tolerances: Tolerances
) -> LoadVerdict:
    settled = settle(branches, complete, constant + row.wrench, tolerances)
    if np.abs(row.wrench).max() <= ZERO_ROW:
        return _without_load(row, settled)
    ranges = [factor_range(branch, constant, row.wrench) for branch in branches]
    best = max(ranges, key=lambda found: found.reserve)
    most = max(found.reserve[1] for found in ranges) if complete else np.inf
    reserve = None if most < 0 else (max(best.reserve[0], 0.0), most)
    if settled.branch is not None:
        ranges = [found for branch, found in zip(branches, ranges, strict=True) if branch is settled.branch]
    needed = max(0.0, next(filter(np.isfinite, best.needed[::-1]), 0.0))
    answer, reason = _answer(settled, ranges)
    verdict = LoadVerdict(row.load, row.row, answer, reserve, needed, None, best.first, reason)
    return _with_proof(verdict, settled)


def _with_proof(verdict: LoadVerdict, settled: Settled) -> LoadVerdict:
    if verdict.answer is Answer.YES:
        return replace(verdict, proof=settled.balance)
    if verdict.answer is Answer.NO:
        return replace(verdict, proof=settled.against[0], others=settled.against[1:])
    return verdict


def _without_load(row: LoadRow, settled: Settled) -> LoadVerdict:
    """A load of nothing: any factor on it is the same."""
    if settled.balance is not None:
        return LoadVerdict(row.load, row.row, Answer.YES, (np.inf, np.inf), 0.0, settled.balance)
    answer = Answer.UNDECIDED if settled.reason else Answer.NO
    reserve = (0.0, np.inf) if settled.reason else None
    return _with_proof(LoadVerdict(row.load, row.row, answer, reserve, 0.0, None, (), settled.reason), settled)


def _answer(settled: Settled, ranges: Sequence[FactorRange]) -> tuple[Answer, str | None]:
    """The answer at factor 1: a proof, and 1 not within a tie of an end."""
    if settled.balance is not None:
        clear = ranges[0].reserve[0] > 1 + LOAD_TIE and ranges[0].needed[1] < 1 - LOAD_TIE
        return (Answer.YES, None) if clear else (Answer.UNDECIDED, _tie(ranges[0]))
    if settled.reason is not None:
        return Answer.UNDECIDED, settled.reason
    outside = all(found.reserve[1] < 1 - LOAD_TIE or found.needed[0] > 1 + LOAD_TIE for found in ranges)
    return (Answer.NO, None) if outside else (Answer.UNDECIDED, _tie(ranges[0]))


def _tie(found: FactorRange) -> str:
    first = [f"{name} {what}" for name, what in found.first]
    return f"a tie: the load is the largest that is held{', at which ' + ', '.join(first) if first else ''}"


def factor_range(branch: ForceBranch, constant: Vector, wrench: Vector) -> FactorRange:
    """The bracket of the factors on ``wrench`` that a branch balances, with ``constant`` and its preloads."""
    own = branch.unit_for(constant) if branch.pushed_with or np.any(constant) else branch.unit_for(wrench)
    size = branch.unit_for(wrench) if not branch.pushed_with else _size(branch.inner, wrench)
    # the load at the size of what is given, so that a factor is about 1 where something gives way
    factor = own / size
    low, high, first = _ends(branch.inner.in_units_of(own), constant, wrench * factor)
    if branch.alike:
        reserve, needed = (low[0], low[1]), (-high[1], -high[0])
    else:
        outer_low, outer_high, first = _ends(branch.outer.in_units_of(own), constant, wrench * factor)
        reserve, needed = (low[0], outer_low[1]), (-outer_high[1], -high[0])
    return FactorRange(_times(reserve, factor), _times(needed, factor), first)


def _size(forces: ContactForces, wrench: Vector) -> float:
    return float(np.abs(forces.in_units_of(1.0).applied(wrench)).max())


def _times(bracket: tuple[float, float], factor: float) -> tuple[float, float]:
    return bracket[0] * factor, bracket[1] * factor


def _ends(
    forces: ContactForces, constant: Vector, load: Vector
) -> tuple[tuple[float, float], tuple[float, float], First]:
    """Brackets of the largest factor and of the largest factor on the reversed load, and what gives way first."""
    fixed, along = forces.applied(constant) + forces.given, forces.applied(load)
    found = largest_factors(forces.cones, fixed, np.array([along, -along]))
    brackets = [(_rounded(low), _rounded(high)) for low, high in zip(found.lower, found.upper, strict=True)]
    first: First = ()
    if np.isfinite(brackets[0][1]) and np.any(found.motions[0]):
        first = giving_way(forces, found.forces[0], found.motions[0], found.forces[1])
    return brackets[0], brackets[1], first


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
