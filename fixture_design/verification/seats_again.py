"""Seats and what they bound, worked out again from points and normals for the proofs about locating errors.

Independent of `analysis.seats`: rows that depend on each other are found from fundamental circuits, one basis and the
rows expressed in it, instead of a projector; two rows are in one group if such a circuit has both.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations, islice, product

import numpy as np

from fixture_design.analysis.lightest import lightest
from fixture_design.analysis.seat_errors import MAX_COMPARED
from fixture_design.analysis.seats import MAX_SEATS
from fixture_design.arrays import Point, Points, Rows, Vector
from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import element_name
from fixture_design.tolerances import DEFAULT, OPPOSED_WALLS, SEATED
from fixture_design.verification.proofs import Case


@dataclass(frozen=True, eq=False)
class BranchAgain:
    """One choice of alternatives: rows, their unit normals, (contact, normal) and element; see `LocatingRows`."""

    rows: Rows
    normals: Points
    places: tuple[tuple[str, int], ...]
    owners: tuple[str, ...]
    doubt: np.ndarray
    tilt: np.ndarray
    both: np.ndarray
    near: float

    @property
    def elements(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(self.owners))

    def touched(self, seats: SeatsAgain) -> list[frozenset[str]]:
        """The elements that each seat rests on."""
        return [frozenset(self.owners[i] for i in members) for members in seats.members.tolist()]

    def walls(self, element: str) -> bool:
        """Whether an element's rows all keep the part on both sides."""
        return all(both for both, owner in zip(self.both, self.owners, strict=True) if owner == element)

    def lightest(self, weights: np.ndarray, errors: Mapping[str, float], form: float) -> np.ndarray:
        """The weights that `analysis.lightest` suggests: bounds as good as any, whose rows are checked."""
        elements = self.elements
        owner = np.array([elements.index(name) for name in self.owners], dtype=np.int64)
        radius = np.array([errors[name] + form * self.walls(name) for name in elements])
        return lightest(weights, self.rows, self.normals, self.both, owner, radius)

    def shares(self, weights: np.ndarray, errors: Mapping[str, float], form: float) -> np.ndarray:
        """What each element moves a feature of these row weights (..., m) by, shape (..., e)."""
        found = []
        for element in self.elements:
            own = np.array([owner == element for owner in self.owners])
            pull = np.linalg.norm(weights[..., own] @ self.normals[own], axis=-1)
            walls = self.walls(element)
            found.append(
                pull * (errors[element] + form * walls) + np.abs(weights[..., own]).sum(-1) * form * (not walls)
            )
        return np.stack(found, axis=-1)


def branches_again(case: Case) -> Iterator[BranchAgain]:
    """Every choice of one alternative a clause."""
    clauses = []
    for contact in case.contacts:
        numbers = iter(range(len(contact.normals)))
        clauses += [[(contact, next(numbers)) for _ in clause] for clause in contact.clauses]
    for places in product(*clauses):
        yield _branch(case, places)


def _branch(case: Case, places: tuple[tuple[Contact, int], ...]) -> BranchAgain:
    units = [unit_normal(contact.normals[k]) for contact, k in places]
    rows = np.vstack([case.rows(c, unit[None]) for (c, _), unit in zip(places, units, strict=True)])
    owners = [element_name(contact.name) for contact, _ in places]
    kept: list[int] = []
    both: list[bool] = []
    for i, row in enumerate(rows):
        others = [rows[j] for j in range(len(rows)) if owners[j] == owners[i]]
        if any(owners[j] == owners[i] and _one_row(rows[j], row, case.near) for j in kept):
            continue
        kept.append(i)
        both.append(any(np.abs(other + row).max() <= OPPOSED_WALLS for other in others))
    return BranchAgain(
        rows=rows[kept],
        normals=np.array(units)[kept],
        places=tuple((places[i][0].name, places[i][1]) for i in kept),
        owners=tuple(owners[i] for i in kept),
        doubt=np.array([case.error(places[i][0]) for i in kept]),
        tilt=np.array([places[i][0].provenance.normal_error for i in kept]),
        both=np.array(both),
        near=case.near,
    )


def _one_row(first: Vector, second: Vector, near: float) -> bool:
    """Whether two rows of one element are the same, or opposed."""
    return bool(np.abs(first - second).max() <= near or np.abs(first + second).max() <= OPPOSED_WALLS)


@dataclass(frozen=True, eq=False)
class SeatsAgain:
    """All seats of a branch.

    Attributes:
        members: shape (n, r).  inverses: of the seats' rows in the coordinates of ``basis``, shape (n, r, r).
        basis: orthonormal rows, shape (r, d).  smallest: singular value of each, shape (n,).
    """

    members: np.ndarray
    inverses: np.ndarray
    basis: Rows
    smallest: np.ndarray

    def weights(self, targets: Rows, count: int) -> np.ndarray:
        """Of each seat for each target, on all rows: shape (n, k, count)."""
        found = np.zeros((len(self.members), len(targets), count))
        for seat, (members, inverse) in enumerate(zip(self.members, self.inverses, strict=True)):
            found[seat][:, members] = (targets @ self.basis.T) @ inverse
        return found


def seats_again(branch: BranchAgain) -> SeatsAgain | str:
    """All seats of a branch, or why they are not known."""
    _, values, right = np.linalg.svd(branch.rows, full_matrices=False)
    if np.any((values <= SEATED) & (values > branch.near)) and np.sum(values > SEATED) < branch.rows.shape[1]:
        return "the rank is neither one nor the next"
    rank = int(np.sum(values > SEATED))
    basis = right[:rank]
    inside = branch.rows @ basis.T
    groups = _groups(inside)
    options = [list(combinations(group, size)) for group, size in groups]
    listed = list(islice(product(*options), MAX_SEATS + 1))
    if len(listed) > MAX_SEATS:
        return "there are too many seats to look at all of them"
    sets = np.array([sorted(sum(parts, ())) for parts in listed], dtype=np.int64)
    smallest = np.linalg.svd(inside[sets], compute_uv=False)[:, -1]
    good = smallest > SEATED
    return SeatsAgain(sets[good], np.linalg.inv(inside[sets[good]]), basis, smallest[good])


def _groups(rows: Rows) -> list[tuple[tuple[int, ...], int]]:
    """Rows that depend on each other through fundamental circuits, with how many of them are independent."""
    basis: list[int] = []
    for i in range(len(rows)):
        if len(basis) < rows.shape[1] and np.linalg.svd(rows[[*basis, i]], compute_uv=False)[-1] > SEATED:
            basis.append(i)
    groups = [{i} for i in basis]
    for i in sorted(set(range(len(rows))) - set(basis)):
        parts = rows[i] @ np.linalg.inv(rows[basis])
        circuit = {i, *(basis[k] for k in np.flatnonzero(np.abs(parts) > SEATED))}
        joined = circuit.union(*(group for group in groups if group & circuit))
        groups = [*(group for group in groups if not group & circuit), joined]
    return [(tuple(sorted(group)), len(group & set(basis))) for group in groups]


def kept_again(branch: BranchAgain, seats: SeatsAgain, wrench: Vector | None) -> tuple[np.ndarray, bool]:
    """Seats that carry a dimensionless wrench, and whether one is known that some carry.

    w = sum N_i d_i with N_i >= 0 but for both-sided rows; of those that load the same elements the ones on most.
    """
    loads = _loads(branch, seats, wrench)
    pressed = any(load is not None for load in loads)
    if not pressed:
        loads = [frozenset() for _ in loads]
    on = branch.touched(seats)
    most: dict[frozenset[str], int] = {}
    for load, elements in zip(loads, on, strict=True):
        if load is not None:
            most[load] = max(most.get(load, 0), len(elements))
    kept = [load is not None and len(elements) == most[load] for load, elements in zip(loads, on, strict=True)]
    return np.array(kept), pressed


def _loads(branch: BranchAgain, seats: SeatsAgain, wrench: Vector | None) -> list[frozenset[str] | None]:
    """The elements that each seat carries a wrench with; None for seats that do not."""
    nothing: list[frozenset[str] | None] = [None] * len(seats.members)
    if wrench is None or not np.any(wrench):
        return nothing
    unit = wrench / np.linalg.norm(wrench)
    if np.linalg.norm(unit - unit @ seats.basis.T @ seats.basis) > branch.near / DEFAULT.band**2:
        return nothing
    loads = nothing
    for seat, forces in enumerate(seats.weights(unit[None], len(branch.rows))[:, 0]):
        limit = branch.near * np.abs(forces).max()
        if np.all((forces >= -limit) | branch.both):
            loads[seat] = frozenset(branch.owners[i] for i in np.flatnonzero(np.abs(forces) > limit))
    return loads


def bounds_again(branch: BranchAgain, seats: SeatsAgain, weights: np.ndarray, own: np.ndarray) -> np.ndarray:
    """On each seat the smallest bound that holds there on both sides, shape (n, k)."""
    if not 1 < len(own) <= MAX_COMPARED:
        return own
    found = np.zeros_like(own)
    outside = np.array(
        [
            [i not in members and not both for i, both in enumerate(branch.both)]
            for members in map(set, seats.members.tolist())
        ]
    )
    for k in range(own.shape[1]):
        limit = branch.near / DEFAULT.band**2 * np.abs(weights[:, k]).max(axis=1, keepdims=True)
        sides = []
        for sign in (1, -1):
            wrong = sign * weights[:, k] < -limit
            sides.append([own[~wrong[:, free].any(axis=1), k].min() for free in outside])
        found[:, k] = np.max(sides, axis=0)
    return found


def target_again(case: Case, point: Point, direction: Point) -> Vector:
    """The row of a feature at a point."""
    return case.rows(Contact.on_facet("feature", "locator", point, direction), direction[None])[0]
