"""What is to be computed of layouts that are alike: which numbers are points and normals, which groups there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices
from fixture_design.batch.alike.structure import Path
from fixture_design.contacts import Contact
from fixture_design.layout import Group, Layout, groups_of

#: Questions that are decided here; layouts that ask others are left to `verify`.
QUESTIONS = ("deterministic", "accessible", "strongly_accessible", "form_closure", "force_closure")
#: More branches or contacts in a group than this are left to `verify`.
MOST_BRANCHES, MOST_CONTACTS = 16, 24


@dataclass(frozen=True, eq=False)
class GroupPlan:
    """Groups with the same contacts, which have the same answers.

    Attributes:
        names: of the groups.  contacts: places in the layout, shape (c,); none for empty groups.
        owners: shape (b, r), the contact of each normal of each branch, by its place in the layout.
        normals: shape (b, r), likewise the normal: a branch has one alternative of every clause.
    """

    names: tuple[str, ...]
    contacts: Indices
    owners: Int[np.ndarray, "b r"]
    normals: Int[np.ndarray, "b r"]


@dataclass(frozen=True, eq=False)
class Plan:
    """How to compute layouts of one structure.

    Attributes:
        layout: one of them, for all that is not a number.  groups: as `groups_of` gives them.
        points: columns of the contacts' points among the numbers, shape (c, p).
        normals: columns of the normals, shape (k, p).  frictions: column of each contact's friction, -1 for none.
        coefficients: all columns of coefficients of friction, also those that no contact has.
        plans: the groups, those with the same contacts together.
        notes: what `contacts_of` has to say about them.
    """

    layout: Layout
    groups: tuple[Group, ...]
    points: Int[np.ndarray, "c p"]
    normals: Int[np.ndarray, "k p"]
    frictions: Indices
    coefficients: Indices
    plans: tuple[GroupPlan, ...]
    notes: tuple[str, ...] = ()

    @property
    def dimension(self) -> int:
        return 3 if self.points.shape[1] == 2 else 6


def plan_of(layout: Layout, paths: Sequence[Path]) -> Plan | None:
    """The plan for layouts like this one; None if `verify` has to look at them one by one.

    Args:
        paths: where each of their numbers stands in the text.
    """
    simple = not (layout.elements or layout.bodies or layout.part or layout.sweep is not None)
    if not simple or not layout.contacts or len(layout.contacts) > MOST_CONTACTS:
        return None
    groups = groups_of(layout, layout.contacts)
    if any(require not in QUESTIONS for group in groups for require in group.require):
        return None
    columns = {path: column for column, path in enumerate(paths)}
    points = [_column_row(columns, ("contacts", k, "point")) for k in range(len(layout.contacts))]
    normals = [row for k in range(len(layout.contacts)) for row in _normal_columns(columns, k)]
    frictions = [columns.get(("contacts", k, "friction"), columns.get(("friction",), -1)) for k in range(len(points))]
    coefficients = [column for path, column in columns.items() if path[-1] == "friction"]
    used = {column for row in (*points, *normals) for column in row} | set(coefficients)
    if used != set(columns.values()):
        return None  # loads, gravity, key features: numbers that somebody has to check
    plans = _group_plans(groups, layout.contacts)
    if plans is None:
        return None
    return Plan(layout, groups, np.array(points), np.array(normals), _indices(frictions), _indices(coefficients), plans)


def _indices(values: Sequence[int]) -> Indices:
    return np.array(values, dtype=np.int64)


def paths_of(contacts: Sequence[Contact]) -> tuple[Path, ...]:
    """Where the numbers of contacts would stand in a text: for layouts that come from none, in `row_of`'s order."""
    return tuple(
        path
        for k, contact in enumerate(contacts)
        for path in (
            *(("contacts", k, "point", j) for j in range(len(contact.point))),
            *(
                ("contacts", k, "normals", clause, alternative, j)
                for clause, normals in enumerate(contact.clauses)
                for alternative in range(len(normals))
                for j in range(len(contact.point))
            ),
            ("contacts", k, "friction"),
        )
    )


def row_of(contacts: Sequence[Contact]) -> list[float]:
    """The numbers of contacts, in the order of `paths_of`."""
    return [
        number
        for contact in contacts
        for number in (
            *contact.point.tolist(),
            *(value for normal in contact.normals for value in normal.tolist()),
            contact.friction,
        )
    ]


def _column_row(columns: dict[Path, int], path: Path) -> list[int]:
    """Columns of the coordinates at a path."""
    row = []
    while (*path, len(row)) in columns:
        row.append(columns[(*path, len(row))])
    return row


def _normal_columns(columns: dict[Path, int], contact: int) -> list[list[int]]:
    """Of one contact's normals, in the order of `Contact.normals`."""
    start: Path = ("contacts", contact)
    if row := _column_row(columns, (*start, "normal")):
        return [row]
    for key in ("any_of", "all_of"):
        if rows := _column_rows(columns, (*start, key)):
            return rows
    rows, clause = [], 0
    while clauses := _column_rows(columns, (*start, "normals", clause)):
        rows, clause = rows + clauses, clause + 1
    return rows


def _column_rows(columns: dict[Path, int], path: Path) -> list[list[int]]:
    rows: list[list[int]] = []
    while row := _column_row(columns, (*path, len(rows))):
        rows.append(row)
    return rows


def _group_plans(groups: Sequence[Group], contacts: Sequence[Contact]) -> tuple[GroupPlan, ...] | None:
    place = {contact.name: k for k, contact in enumerate(contacts)}
    firsts = np.cumsum([0, *(len(contact.normals) for contact in contacts)])
    sharing: dict[tuple[int, ...], list[str]] = {}
    for group in groups:
        sharing.setdefault(tuple(place[contact.name] for contact in group.contacts), []).append(group.name)
    plans = []
    for members, names in sharing.items():
        options: list[list[tuple[int, int]]] = []
        for member in members:
            normal = int(firsts[member])
            for clause in contacts[member].clauses:
                options.append([(member, normal + k) for k in range(len(clause))])
                normal += len(clause)
        if np.prod([len(option) for option in options], initial=1.0) > MOST_BRANCHES:
            return None
        choices = list(product(*options))
        branches = np.array(choices, dtype=np.int64).reshape(len(choices), len(options), 2)
        plans.append(GroupPlan(tuple(names), np.array(members, dtype=np.int64), branches[..., 0], branches[..., 1]))
    return tuple(plans)
