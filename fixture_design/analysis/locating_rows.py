"""The rows of the locators, and how far each may be off: what errors of place start from.

The part rests where d_i . q = s_i, with s_i the error of contact i along its normal. An element's position is off by
some vector u with |u| <= radius, the same for all its contacts: s_i = n_i . u. So a pad is one error and not one a
corner, a pin between opposed walls is off within a disc (tolerance plus half the clearance) and never within a square,
and the surface's own deviation is one more number a contact. With weights c that make a feature's row, g = sum c_i d_i,
element e moves the feature by up to

    share = radius |sum over its contacts of c_i n_i| + form * (sum over its contacts of |c_i|)

Two contacts of one element that are opposed keep the part on both sides and are one row; the deviation of such walls
only adds to the radius.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice, product
from math import prod

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, Points, Rows, Vector, Weights
from fixture_design.contacts import Contact, Scale, face_vectors, scale_of, unit_normal
from fixture_design.layout import element_name
from fixture_design.tolerances import OPPOSED_WALLS, Tolerances

#: Branches of contacts with alternatives that are looked at before the answer is given up as undecided.
MAX_BRANCHES = 64

#: A contact and which of its normals.
Place = tuple[Contact, int]


@dataclass(frozen=True, eq=False)
class LocatingRows:
    """One branch of the locators.

    Attributes:
        rows: dimensionless, [n; (x - reference) X n / length], shape (m, d).  normals: at length one, shape (m, p).
        places: (contact, index of its normal) of each row.  elements: all there are.  owner: of each row, an index.
        both: rows that keep the part on both sides.
        radius: of each element [m].  form: of each row [m].
        doubt: how far each row may be off by its normal's error [-].  tilt: the normal's error [rad].
    """

    rows: Rows
    normals: Points
    places: tuple[tuple[str, int], ...]
    elements: tuple[str, ...]
    owner: Indices
    both: Mask
    radius: Weights
    form: Weights
    doubt: Weights
    tilt: Weights
    scale: Scale

    def target(self, point: Point, direction: Point) -> Vector:
        """The row of a feature: its displacement along ``direction`` is target . q [m], q as in `rows` [m]."""
        row = face_vectors((point - self.scale.reference)[None], direction[None])[0]
        row[len(point) :] /= self.scale.length
        return row

    def names(self, rows: Sequence[int] | Indices) -> tuple[str, ...]:
        """The contacts of some rows, each once."""
        return tuple(dict.fromkeys(self.places[row][0] for row in rows))

    @cached_property
    def _by_element(self) -> tuple[np.ndarray, np.ndarray]:
        """Normals and form errors, sorted into columns of their elements: shapes (m, e, p) and (m, e)."""
        count = len(self.owner)
        normals = np.zeros((count, len(self.elements), self.normals.shape[1]))
        form = np.zeros((count, len(self.elements)))
        normals[np.arange(count), self.owner] = self.normals
        form[np.arange(count), self.owner] = self.form
        return normals, form

    def pulls(self, weights: np.ndarray) -> np.ndarray:
        """For weights (..., m): sum of c_i n_i of each element, shape (..., e, p)."""
        normals = self._by_element[0]
        count, elements, plane = normals.shape
        flat = weights @ normals.reshape(count, elements * plane)
        return flat.reshape(*weights.shape[:-1], elements, plane)

    def shares(self, weights: np.ndarray) -> np.ndarray:
        """For weights (..., m): what each element moves the feature by at most, shape (..., e) [m]."""
        pulls = np.sqrt(np.sum(self.pulls(weights) ** 2, axis=-1))
        return pulls * self.radius + np.abs(weights) @ self._by_element[1]


def locating_branches(
    contacts: Sequence[Contact], errors: Mapping[str, float], form: float, tolerances: Tolerances
) -> list[LocatingRows] | None:
    """One for each choice of alternatives; None where there are more than MAX_BRANCHES.

    Args:
        contacts: locators, at least one.  errors: of each element's position [m].  form: of the surface [m].
    """
    scale = scale_of(contacts)
    clauses = [
        [(contact, first + k) for k in range(len(clause))]
        for contact in contacts
        for first, clause in zip(_firsts(contact), contact.clauses, strict=True)
    ]
    if prod(len(options) for options in clauses) > MAX_BRANCHES:
        return None
    branches = islice(product(*clauses), MAX_BRANCHES)
    near = tolerances.at_offset(scale.offset).near
    return [_branch(places, scale, errors, form, near) for places in branches]


def _firsts(contact: Contact) -> list[int]:
    """Index of the first normal of each clause."""
    firsts = [0]
    for clause in contact.clauses[:-1]:
        firsts.append(firsts[-1] + len(clause))
    return firsts


def _branch(
    places: Sequence[Place], scale: Scale, errors: Mapping[str, float], form: float, near: float
) -> LocatingRows:
    names = [element_name(contact.name) for contact, _ in places]
    elements = tuple(dict.fromkeys(names))
    owner = np.array([elements.index(name) for name in names], dtype=np.int64)
    normals = np.array([unit_normal(contact.normals[k]) for contact, k in places])
    levers = np.array([contact.point for contact, _ in places]) - scale.reference
    rows = face_vectors(levers, normals)
    rows[:, normals.shape[1] :] /= scale.length
    kept, both = _merged(rows, owner, near)
    walls = np.array([both[kept & (owner == e)].all() for e in range(len(elements))])
    tilt = np.array([contact.provenance.normal_error for contact, _ in places])
    doubt = tilt * np.hypot(1.0, np.linalg.norm(levers, axis=1) / scale.length)
    return LocatingRows(
        rows=rows[kept],
        normals=normals[kept],
        places=tuple((contact.name, k) for (contact, k), keep in zip(places, kept.tolist(), strict=True) if keep),
        elements=elements,
        owner=owner[kept],
        both=both[kept],
        radius=np.array([errors[name] for name in elements]) + np.where(walls, form, 0.0),
        form=np.where(walls[owner[kept]], 0.0, form),
        doubt=doubt[kept],
        tilt=tilt[kept],
        scale=scale,
    )


def _merged(rows: Rows, owner: Indices, near: float) -> tuple[Mask, Mask]:
    """Which rows stay, and which of these keep the part on both sides: parallel rows of one element are one."""
    kept, both = np.ones(len(rows), dtype=bool), np.zeros(len(rows), dtype=bool)
    alike = owner[:, None] == owner
    same = alike & (np.abs(rows[:, None] - rows).max(axis=2) <= near)
    opposed = alike & (np.abs(rows[:, None] + rows).max(axis=2) <= OPPOSED_WALLS)
    for row in range(len(rows)):
        if not kept[row]:
            continue
        twins = same[row] | opposed[row]
        both[row] = opposed[row].any()
        kept[twins] = False
        kept[row] = True
    return kept, both
