"""Rocking: contacts that locate more often than once, and what the part does between its seats.

Dependent rows have weights with sum a_i d_i = 0, and errors that do not obey sum a_i s_i = 0 leave a gap somewhere:
resting on all contacts of a circuit but j, the part is off contact j by up to the shares of the weights a / a_j. Errors
that always obey it (the corners of one pad, the walls of one pin) do not rock.
"""

from __future__ import annotations

import numpy as np

from fixture_design.analysis.locating_rows import LocatingRows
from fixture_design.analysis.seats import Seats
from fixture_design.arrays import Vector
from fixture_design.contacts import motion_about_origin
from fixture_design.layout import Rocking
from fixture_design.tolerances import Tolerances


def rockings(rows: LocatingRows, seats: Seats, tolerances: Tolerances) -> tuple[Rocking, ...]:
    """One for each group of dependent rows whose errors can differ: the largest rocking over its circuits."""
    found = []
    for group in seats.groups:
        rocking = _largest(rows, seats, group, tolerances)
        if rocking is not None:
            found.append(rocking)
    return tuple(found)


def _largest(rows: LocatingRows, seats: Seats, group: tuple[int, ...], tolerances: Tolerances) -> Rocking | None:
    """Over the seats and the group's rows that each leaves out."""
    members = np.array(group)
    count = len(rows.rows)
    square = rows.rows[seats.members] @ seats.basis.T
    left_out = rows.rows[members] @ seats.basis.T
    # d_j = sum a_i d_i over the seat's rows, for each seat and each row j of the group
    parts = np.linalg.solve(square.transpose(0, 2, 1), np.broadcast_to(left_out.T, (len(square), *left_out.T.shape)))
    weights = np.zeros((len(square), len(members), count))
    where = np.broadcast_to(seats.members[:, None], (len(square), len(members), seats.members.shape[1]))
    np.put_along_axis(weights, where, -parts.transpose(0, 2, 1), axis=2)
    weights[:, np.arange(len(members)), members] += 1.0
    gaps = rows.shares(weights).sum(axis=-1)
    seat, place = np.unravel_index(int(np.argmax(gaps)), gaps.shape)
    size = float(gaps[seat, place])
    if size <= tolerances.zero * float((rows.radius[rows.owner] + rows.form).max(initial=0.0)):
        return None
    return Rocking(rows.names(group), _tipping(rows, seats, int(seat), weights[seat, place], size), size)


def _tipping(rows: LocatingRows, seats: Seats, seat: int, circuit: np.ndarray, size: float) -> Vector:
    """The motion that leaves the seat's row of largest weight and all others where they are, up to the row left out."""
    members = seats.members[seat]
    leaving = int(np.argmax(np.abs(circuit[members])))
    change = np.zeros(len(members))
    # d_j . q = sum a_i d_i . q = size with only one row of the seat moving
    change[leaving] = size / -circuit[members[leaving]]
    motion = np.linalg.solve(rows.rows[members] @ seats.basis.T, change) @ seats.basis
    return motion_about_origin(motion, rows.scale.reference, rows.scale.length)
