"""Which seats a part may rest on: those that carry what presses it, and touch as far as they can."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.seats import Seats, solved
from fixture_design.arrays import Indices, Mask, Rows, Vector
from fixture_design.tolerances import Tolerances


@dataclass(frozen=True, eq=False)
class Resting:
    """What a part may rest on.

    Attributes:
        kept: the seats, shape (n,).  elements: that each seat rests on, shape (n, e).
        pressed: whether a wrench that they carry is known.  assumed: whether more seats carry it than are kept.
    """

    kept: Mask
    elements: np.ndarray
    pressed: bool
    assumed: bool


def resting(
    rows: Rows, owner: Indices, both: Mask, seats: Seats, wrench: Vector | None, tolerances: Tolerances
) -> Resting:
    """The seats that a part may rest on under a wrench, without friction.

    A contact pushes the part along -d_i, so that a seat carries w = sum N_i d_i with N_i >= 0, of any sign for rows
    that keep the part on both sides. Nothing is known of elements that the wrench leaves idle (all of them, where it is
    not known or no seat carries it): of seats that load the same elements those are kept that rest on most.

    Args:
        owner: the element of each row.  wrench: dimensionless like the rows, of any size, shape (d,).
    """
    elements = _elements(owner, seats, np.ones(seats.members.shape, dtype=bool))
    forces = _forces(rows, seats, wrench, tolerances)
    carry, loaded = np.ones(len(elements), dtype=bool), np.zeros_like(elements)
    if forces is not None:
        limits = tolerances.near * np.abs(forces).max(axis=1, keepdims=True)
        carrying = np.all((forces >= -limits) | both[seats.members], axis=1)
        if carrying.any():
            carry, loaded = carrying, _elements(owner, seats, np.abs(forces) > limits)
    kept = carry.copy()
    counts = elements.sum(axis=1)
    _, alike = np.unique(loaded, axis=0, return_inverse=True)
    for group in np.unique(alike[carry]):
        members = carry & (alike.ravel() == group)
        kept &= ~members | (counts == counts[members].max())
    return Resting(kept, elements, bool(loaded.any()), bool(np.any(kept != carry)))


def _forces(rows: Rows, seats: Seats, wrench: Vector | None, tolerances: Tolerances) -> np.ndarray | None:
    """N_i of each seat's rows for the wrench at length one; None where it is not known or the rows do not span it."""
    if wrench is None or not np.any(wrench):
        return None
    unit = wrench / np.linalg.norm(wrench)
    if np.linalg.norm(unit - (unit @ seats.basis.T) @ seats.basis) > tolerances.zero:
        return None
    return solved(rows, seats, unit[None])[:, 0]


def _elements(owner: Indices, seats: Seats, chosen: np.ndarray) -> np.ndarray:
    """The elements of the chosen rows of each seat, shape (n, e); ``chosen``: shape (n, r)."""
    found = np.zeros((len(seats.members), int(owner.max()) + 1), dtype=bool)
    seat, place = np.nonzero(chosen)
    found[seat, owner[seats.members[seat, place]]] = True
    return found
