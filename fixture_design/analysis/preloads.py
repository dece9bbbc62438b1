"""The least preloads: the smallest sum of what clamps push with, within their limits, that holds all loads.

One cone program for all loads together: each load has forces of its own, and all have the preloads in common. A load
path has many rows of which few matter, so the program starts with one and adds the row that is held worst, until all
are. The loads are taken a little further than they go, and the preloads found are then verified like any others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.analysis.acting import LoadRow
from fixture_design.analysis.balancing import ForceBranch, branches_of
from fixture_design.analysis.contact_forces import ContactForces, contact_forces
from fixture_design.analysis.holding import factor_ranges, held_loads
from fixture_design.analysis.loads import solve_cones
from fixture_design.arrays import Vector, Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.contacts import Contact
from fixture_design.layout import Answer, element_name
from fixture_design.tolerances import FORCES_SOLVED, LOAD_TIE, ZERO_ROW, Tolerances

#: How much further than they go the loads are taken, one after the other until the preloads found are verified [-].
MARGINS = (1e-4, 1e-3, 1e-2)

#: Rows of load paths in one program.
_MOST_ROWS = 60


def least_preloads(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    limits: Mapping[str, tuple[float, float]],
    constant: Vector,
    rows: Sequence[LoadRow],
    tolerances: Tolerances,
) -> dict[str, float] | None:
    """The preloads of the clamps with limits [N], the others' as given; None where none were found that hold.

    Args:
        preloads: of elements that push with a given force [N].  limits: of those whose preload may be chosen [N].
    """
    chosen = [name for name in limits if any(element_name(c.name) == name for c in contacts)]
    if not chosen or any(len(clause) > 1 for contact in contacts for clause in contact.clauses):
        return None
    within = {name: limits[name] for name in chosen}
    for margin in MARGINS:
        found = _with_cuts(contacts, preloads, within, constant, rows, margin, tolerances)
        if found is not None:
            return {name: found[name] for name in chosen}
    return None


def _with_cuts(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    limits: Mapping[str, tuple[float, float]],
    constant: Vector,
    rows: Sequence[LoadRow],
    margin: float,
    tolerances: Tolerances,
) -> dict[str, float] | None:
    """Preloads that are verified to hold all rows; the row that they hold worst joins the program."""
    used = [int(np.argmax([np.linalg.norm(row.wrench) for row in rows]))]
    while len(used) <= _MOST_ROWS:
        least = _program(contacts, preloads, limits, constant, [rows[i] for i in used], margin, tolerances)
        if least is None:
            return None
        pushing = {**preloads, **least}
        worst = _worst(contacts, pushing, constant, rows, tolerances)
        if worst is None:
            verdicts = held_loads(contacts, pushing, constant, rows, tolerances)
            return least if all(verdict.answer is Answer.YES for verdict in verdicts) else None
        if worst in used:
            return None
        used.append(worst)
    return None


def _worst(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    constant: Vector,
    rows: Sequence[LoadRow],
    tolerances: Tolerances,
) -> int | None:
    """The row that is furthest from a balance; None if all have one."""
    branches, _ = branches_of(contacts, preloads, tolerances)
    acting = [index for index, row in enumerate(rows) if np.abs(row.wrench).max() > ZERO_ROW]
    wrenches = np.array([rows[index].wrench for index in acting]).reshape(-1, len(constant))
    ranges = factor_ranges(branches[0], constant, wrenches)
    # how far 1 is beyond the factors that are held, as a part of the load
    beyond = [max(1 - found.reserve[0], found.needed[1] - 1) for found in ranges]
    if not beyond or max(beyond) <= 0:
        return None
    return acting[int(np.argmax(beyond))]


def _program(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    limits: Mapping[str, tuple[float, float]],
    constant: Vector,
    rows: Sequence[LoadRow],
    margin: float,
    tolerances: Tolerances,
) -> dict[str, float] | None:
    """The least sum for some rows, each at (1 - margin) and (1 + margin) of its size; None where none was found."""
    fixed = {name: force for name, force in preloads.items() if name not in limits}
    # whoever may be chosen pushes with 1 here, so as to be passive for nobody
    branch = branches_of(contacts, fixed | dict.fromkeys(limits, 1.0), tolerances)[0][0]
    wrenches = [constant + factor * row.wrench for row in rows for factor in (1 - margin, 1 + margin)]
    free = _with_free_preloads(contacts, fixed, branch)
    unit = max(branch.unit_for(*wrenches), *(high for _, high in limits.values()))
    free = free.in_units_of(unit)
    names = list(limits)
    pushing = np.array([[element_name(contacts[i].name) == name for i, _ in free.owners] for name in names])
    cones, columns, sides = _joined(free, [free.applied(w) + free.given for w in wrenches], pushing)
    low = np.array([limits[name][0] for name in names]) / unit
    high = np.array([limits[name][1] for name in names]) / unit
    cones, columns, sides = _bounded(cones, columns, sides, low, high)
    cost = np.concatenate([np.zeros(cones.maps.shape[1]), np.ones(len(names))])
    solved = solve_cones(cones, columns, sides, cost)
    if not solved.found:
        return None
    # rounded up a little, and what is nothing but rounding down to nothing
    wanted = np.where(solved.y > FORCES_SOLVED, solved.y * (1 + LOAD_TIE), 0.0)
    values = np.clip(wanted, low, high) * unit
    return {name: float(value) for name, value in zip(names, values, strict=True)}


def _with_free_preloads(contacts: Sequence[Contact], fixed: Mapping[str, float], branch: ForceBranch) -> ContactForces:
    """The inner forces of a branch, with the heads of clamps whose preload is sought free."""
    rough = {c.name for c in contacts if c.friction and element_name(c.name) in branch.squeezed}
    return contact_forces(contacts, fixed, smooth=frozenset(rough), scale=branch.inner.scale)


def _joined(
    forces: ContactForces, targets: Sequence[Weights], pushing: np.ndarray
) -> tuple[ForceCones, np.ndarray, Weights]:
    """The balances of all targets side by side, each with rows  sum N - preload = 0  of its own."""
    heads = np.zeros((len(pushing), forces.cones.maps.shape[1]))
    heads[:, forces.cones.starts] = pushing
    block = np.vstack([forces.cones.maps, heads])
    share = np.vstack([np.zeros((len(forces.cones.maps), len(pushing))), -np.eye(len(pushing))])
    count = len(targets)
    cones = ForceCones(
        np.kron(np.eye(count), block), np.tile(forces.cones.sizes, count), np.tile(forces.cones.heads, count)
    )
    sides = np.concatenate([np.append(target, np.zeros(len(pushing))) for target in targets])
    return cones, np.tile(share, (count, 1)), sides


def _bounded(
    cones: ForceCones, columns: np.ndarray, sides: Weights, low: Weights, high: Weights
) -> tuple[ForceCones, np.ndarray, Weights]:
    """low <= y <= high, with slacks as cones of size 1."""
    count, height = len(low), len(cones.maps)
    one, width = np.eye(count), cones.maps.shape[1]
    slacks = np.block([[-one, np.zeros((count, count))], [np.zeros((count, count)), one]])
    maps = np.block([[cones.maps, np.zeros((height, 2 * count))], [np.zeros((2 * count, width)), slacks]])
    more = ForceCones(
        maps,
        np.append(cones.sizes, np.ones(2 * count, dtype=np.int64)),
        np.append(cones.heads, np.full(2 * count, np.nan)),
    )
    return more, np.vstack([columns, one, one]), np.concatenate([sides, -low, -high])
