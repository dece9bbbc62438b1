"""The cone programs of forces, one at a time, by Clarabel (through Drake).

    largest_factors    the largest factor on a load that contact forces balance, with a motion that bounds it
    nearest_forces     the forces that leave least of a wrench; what is left is a motion that nothing resists
    squeezed_cones     cones that can push against each other with nothing from outside

Answers of the solver are suggestions: `balances` makes exact forces and motions of them, and only these prove anything.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from fixture_design.analysis.balances import repaired_forces, repaired_motion, surplus
from fixture_design.arrays import Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.tolerances import CARRIES, FORCES_SOLVED, WITNESS

#: What Clarabel is asked for [-]; it stops sooner where it gets no further.
_SOLVER_TOLERANCE = 1e-12

#: Numbers beyond this are a solver's that failed [-].
_RUNAWAY = 1e50

#: Largest N in a squeeze whose least is 1 [-].
_SQUEEZE_CAP = 1e4


@dataclass(frozen=True, eq=False)
class Factors:
    """Brackets of the largest factors.

    Attributes:
        lower, upper: shape (k,): inf where nothing limits the factor, -inf where no factor at all is balanced.
        forces: shape (k, s): x at the factor ``lower``; where that is inf, x at some factor.
        motions: shape (k, d): q with load . q = 1 that proves ``upper``; 0 where that is -inf; zeros without one.
    """

    lower: Weights
    upper: Weights
    forces: np.ndarray
    motions: np.ndarray


@dataclass(frozen=True, eq=False)
class Solved:
    """x of the cones, y of the free variables, and the equations' multipliers; ``found`` if the solver says so."""

    x: Weights
    y: Weights
    dual: Weights
    found: bool


def solve_cones(cones: ForceCones, columns: np.ndarray, sides: Weights, cost: Weights) -> Solved:
    """min cost . [x; y]  with  sides + maps @ x + columns @ y = 0,  x in the cones, y free."""
    solvers, solver, options = _solver()
    program = solvers.MathematicalProgram()
    count, cost = cones.maps.shape[1], np.asarray(cost, dtype=np.float64)
    variables = program.NewContinuousVariables(count + columns.shape[1])
    program.AddLinearCost(cost, 0.0, variables)
    balance = program.AddLinearEqualityConstraint(np.hstack([cones.maps, columns]), -sides, variables)
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        part = variables[block]
        if not np.isnan(head):
            program.AddBoundingBoxConstraint(head, head, part[0])
        if len(part) == 1:
            program.AddBoundingBoxConstraint(0.0, np.inf, part[0])
        else:
            program.AddLorentzConeConstraint(np.eye(len(part)), np.zeros(len(part)), part)
    result = solver.Solve(program, None, options)
    values, dual = _usable(result.GetSolution(variables)), _usable(result.GetDualSolution(balance))
    return Solved(values[:count], values[count:], dual, result.is_success())


def _usable(values: Any) -> Weights:
    """What the solver gives, zeros where it failed: rays of infeasible programs may grow beyond all bounds."""
    array = np.asarray(values, dtype=np.float64)
    return array if np.abs(array).max(initial=0.0) <= _RUNAWAY else np.zeros(len(array))


@cache
def _solver() -> tuple[Any, Any, Any]:
    from pydrake import solvers  # noqa: PLC0415 - Drake only for those who ask about forces

    solver, options = solvers.ClarabelSolver(), solvers.SolverOptions()
    # a program without a solution is an answer here, and nothing to report
    logging.getLogger("drake").addFilter(lambda record: "Clarabel returns" not in record.getMessage())
    for name in ("tol_gap_abs", "tol_gap_rel", "tol_feas"):
        options.SetOption(solver.solver_id(), name, _SOLVER_TOLERANCE)
    return solvers, solver, options


def nearest_forces(cones: ForceCones, wrench: Weights, columns: np.ndarray | None = None) -> Solved:
    """x (and y) that leave least of ``wrench``: min |wrench + maps @ x + columns @ y|.

    What is left, q, is a motion that none of the cones with free heads resists, if it is not zero: ``dual``.
    """
    columns = np.zeros((len(wrench), 0)) if columns is None else columns
    left = np.column_stack([np.zeros(len(wrench)), np.eye(len(wrench))])
    widened = ForceCones(
        np.hstack([cones.maps, left]), np.append(cones.sizes, len(wrench) + 1), np.append(cones.heads, np.nan)
    )
    count = cones.maps.shape[1]
    cost = np.zeros(widened.maps.shape[1] + columns.shape[1])
    cost[count] = 1.0
    found = solve_cones(widened, columns, wrench, cost)
    return Solved(found.x[:count], found.y, -found.x[count + 1 :], found.found)


def largest_factors(cones: ForceCones, fixed: Weights, loads: np.ndarray) -> Factors:
    """For each load the largest factor a with  fixed + a load + maps @ x = 0  for some x in the cones.

    Args:
        fixed: shape (d,).  loads: shape (k, d), not zero; both of about the size of what the cones can do.
    """
    found = [_largest_factor(cones, fixed, load) for load in loads]
    lower, upper, forces, motions = zip(*found, strict=True) if found else ((), (), (), ())
    width, d = cones.maps.shape[1], len(fixed)
    return Factors(
        np.array(lower, dtype=np.float64),
        np.array(upper, dtype=np.float64),
        np.array(forces, dtype=np.float64).reshape(len(loads), width),
        np.array(motions, dtype=np.float64).reshape(len(loads), d),
    )


def _largest_factor(cones: ForceCones, fixed: Weights, load: Weights) -> tuple[float, float, Weights, Weights]:
    cost = np.zeros(cones.maps.shape[1] + 1)
    cost[-1] = -1.0
    solved = solve_cones(cones, load[:, None], fixed, cost)
    motion = _bounding(cones, -solved.dual, load)
    upper = np.inf if motion is None else -surplus(cones, motion, fixed)
    x, left = repaired_forces(cones, fixed + solved.y[0] * load, solved.x)
    # where friction is at its limit nothing has room, and the forces stay as they were found
    if motion is not None and solved.found and left <= FORCES_SOLVED:
        return min(float(solved.y[0]), upper), upper, x, motion
    return _unusual(cones, fixed, load, upper, motion)


def _unusual(
    cones: ForceCones, fixed: Weights, load: Weights, upper: float, motion: Weights | None
) -> tuple[float, float, Weights, Weights]:
    """No factor at all, or no limit, or the solver did not get there."""
    some = nearest_forces(cones, fixed, load[:, None])
    none = np.zeros(len(fixed)) if motion is None else motion
    x, left = repaired_forces(cones, fixed + some.y[0] * load, some.x)
    if left > WITNESS:
        against = repaired_motion(cones, some.dual, square=load)
        if against is not None and surplus(cones, against, fixed) > WITNESS:
            return -np.inf, -np.inf, x, against
        return -np.inf, upper, x, none
    if _recedes(cones, load):
        return np.inf, np.inf, x, np.zeros(len(fixed))
    if np.isfinite(upper) and upper > some.y[0]:
        # the solver has least digits where everything gives way at once; what it did not find may still be there
        for factor in (upper, 0.0) if some.y[0] < 0 < upper else (upper,):
            there = nearest_forces(cones, fixed + factor * load).x
            there, left = repaired_forces(cones, fixed + factor * load, there)
            if left <= FORCES_SOLVED:
                return factor, upper, there, none
    return float(some.y[0]), upper, x, none


def _recedes(cones: ForceCones, load: Weights) -> bool:
    """Whether the cones with free heads alone balance the load, however large it is."""
    size = float(np.linalg.norm(load))
    passive = cones.passive
    return repaired_forces(passive, load / size, nearest_forces(passive, load / size).x)[1] <= WITNESS


def _bounding(cones: ForceCones, motion: Weights, load: Weights) -> Weights | None:
    """The motion, repaired and with load . q = 1; None if it does not move along the load."""
    repaired = repaired_motion(cones, motion)
    if repaired is None or repaired @ load <= WITNESS * float(np.linalg.norm(load)):
        return None
    return repaired / (repaired @ load)


def squeezed_cones(cones: ForceCones) -> list[int]:
    """Cones that have N > 0 in some x with maps @ x = 0: they can push against each other, and nothing says how much.

    Most of sum s with 0 <= s <= 1, s <= N: s is 1 for all of these, since x may be multiplied.
    """
    count, width = len(cones.sizes), cones.maps.shape[1]
    if not count:
        return []
    one = np.eye(count)
    heads = np.zeros((count, width))
    heads[np.arange(count), cones.starts] = 1.0
    no = np.zeros((count, count))
    maps = np.block(
        [
            [cones.maps, np.zeros((len(cones.maps), 4 * count))],
            [np.zeros((count, width)), one, one, no, no],  # s + slack = 1
            [heads, -one, no, -one, no],  # N - s - slack = 0
            [heads, no, no, no, one],  # N + slack = cap
        ]
    )
    sides = np.concatenate(
        [np.zeros(len(cones.maps)), -np.ones(count), np.zeros(count), -_SQUEEZE_CAP * np.ones(count)]
    )
    sizes = np.concatenate([cones.sizes, np.ones(4 * count, dtype=np.int64)])
    widened = ForceCones(maps, sizes, np.full(len(sizes), np.nan))
    cost = np.concatenate([np.zeros(width), -np.ones(count), np.zeros(3 * count)])
    solved = solve_cones(widened, np.zeros((len(maps), 0)), sides, cost)
    return [i for i in range(count) if solved.x[width + i] > CARRIES]
