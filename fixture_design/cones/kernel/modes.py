"""All contact modes of a set of contacts: which stay in contact and which separate, with a motion for each.

The motions that contacts admit are the cone face{d_1..d_m}. A motion keeps the contacts with d_i . u = 0 and separates
the others; the sets that occur are those of the cone's faces, one for each (the lineality space, where all stay, among
them). In space n contacts in general position have at most 6 n^2 - 36 n + 64 modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Incidence, Rows
from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.exact import Rational, exact_double_description
from fixture_design.errors import ConeError

#: More modes than this are refused: they would not be looked at either.
MAX_FACES = 2_000_000


@dataclass(frozen=True, eq=False)
class Faces:
    """The faces of a cone, those with most rows first.

    Attributes:
        rows: shape (f, m), whether row . u = 0 for all u of the face: the contacts that stay.
        witnesses: shape (f, d), a unit vector of each face's relative interior: zero on those rows, negative on the
            others; zero for the lineality space.
    """

    rows: Incidence
    witnesses: Rows

    def __len__(self) -> int:
        return len(self.rows)


def faces_of(lines: int, rays: Rows, incidence: Incidence, ambient: int, most: int = MAX_FACES) -> Faces:
    """All faces of a cone that is converted.

    Args:
        lines: dimension of the lineality space.
        rays: shape (k, d), unit.  incidence: shape (k, m), the rows that each lies on.
        ambient: dimension of the space that the equalities leave.
        most: more faces than this are refused.

    Raises:
        ConeError: more than ``most`` faces.
    """
    native = compiled(rays.shape[1], incidence.shape[1])
    if native is not None:
        return Faces(*native.faces(lines, rays, incidence, ambient, most))
    return _by_intersections(rays, incidence, most)


def exact_faces(rows: Sequence[Sequence[Rational]] | np.ndarray, *, dimension: int, most: int = MAX_FACES) -> Faces:
    """All faces of {u : rows . u <= 0} for rational rows; the sets are exact, the witnesses rounded."""
    cone = exact_double_description(rows, dimension=dimension)
    rays = np.array([[value / max(map(abs, ray)) for value in ray] for ray in cone.rays]).reshape(-1, dimension)
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return faces_of(len(cone.lines), rays, cone.incidence, cone.ambient, most)


def _by_intersections(rays: Rows, incidence: Incidence, most: int) -> Faces:
    """The intersections of the rays' row sets, as bits; each face's witness is the sum of its rays."""
    count = incidence.shape[1]
    sets = [int("".join(map(str, row[::-1].astype(int))) or "0", 2) for row in incidence]
    everything = (1 << count) - 1
    known = {everything}
    for own in sets:
        known |= {other & own for other in known}
        if len(known) > most:
            raise ConeError(f"the cone has more than {most} faces")
    ordered = sorted(known, key=lambda rows: (-rows.bit_count(), rows))
    table = np.array([[bool(rows >> k & 1) for k in range(count)] for rows in ordered], dtype=bool)
    table = table.reshape(len(ordered), count)
    witnesses = np.zeros((len(ordered), rays.shape[1]))
    for place, rows in enumerate(ordered):
        if rows != everything:  # no ray lies on every row: its opposite would be in the cone too
            witnesses[place] = rays[[not rows & ~own for own in sets]].sum(axis=0)
    lengths = np.linalg.norm(witnesses, axis=1, keepdims=True)
    return Faces(table, witnesses / np.where(lengths > 0, lengths, 1.0))
