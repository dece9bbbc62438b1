"""The contact modes of a configuration by the cones: motions that keep some of its contacts and leave the others.

Every pair that touches gives a face vector d (3-34, 3-35). Where an apex is within a facet, d . dq <= 0; each face of
the cone of such rows is one mode (`cones.kernel.faces_of`). At the end of a facet the apex may also pass beyond, and
both signs occur: the cones of all sign patterns together cover all motions, also where the admissible ones are a union
(2-9). Which of the modes exist the geometry tells (`following`): here none is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from fixture_design.arrays import Indices, Mask, Rows, Vector, Weights
from fixture_design.assembly.point_motions import PointMotions
from fixture_design.cones import convert_rows
from fixture_design.cones.kernel import faces_of
from fixture_design.errors import UnsupportedError
from fixture_design.tolerances import DEPENDENT, Tolerances

#: Solved configurations carry the rounding of the equations, not that of input data.
_ROUNDED = Tolerances(tie=1e-7)

#: Contacts at facets' ends are not combined in all their signs if there are more choices than 2 to this.
MOST_SIGNS = 13

#: More contacts that depend on each other than this are not dropped in all combinations.
_MOST_DROPPED = 6


@dataclass(frozen=True, eq=False)
class Mode:
    """A motion and the contacts that it keeps.

    Attributes:
        displacement: shape (d,), unit; zero on the face vectors of the contacts kept, to first order.
        kept: shape (m,), of the contacts given.
    """

    displacement: Vector
    kept: Mask


def contact_modes(
    face_vectors: Rows, at_end: Mask, free: Mask, turns: Mask, points: Sequence[PointMotions] | None = None
) -> list[Mode]:
    """All modes of contacts with these face vectors.

    Args:
        face_vectors: shape (m, d), with angles multiplied by a length.
        at_end: shape (m,), contacts whose apex is at the end of its facet.
        free: shape (d,), displacements that are allowed.  turns: shape (d,), those that are angles.
        points: what each point with contacts at ends admits, by places among these contacts; None: anything.

    Where the face vectors of contacts that a motion keeps depend on each other, the first order does not tell whether
    it keeps them (slip 2 of (3-29)): every choice of contacts to drop is a mode of its own then, if each point may keep
    what is left of its own.

    Raises:
        UnsupportedError: more than 2 ^ `MOST_SIGNS` choices of signs.
    """
    rows = face_vectors[:, free]
    rows = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    modes = _Modes(rows, free, _placed(points or (), np.flatnonzero(at_end)))
    for signs in _signs(rows[at_end], points):
        turned = signs != 0
        signed = rows.copy()
        signed[at_end] *= np.where(turned, -signs, 1.0)[:, None]
        equal = np.flatnonzero(at_end)[~turned]
        modes.add(*_of_one_cone(signed, modes, turns[free], equal))
    return list(modes.found.values())


class _Modes:
    """The modes found so far, each once: those on the border of two sign patterns come from both."""

    def __init__(self, rows: Rows, free: Mask, points: Sequence[PointMotions]) -> None:
        self.rows, self.free, self.points = rows, free, points
        self.found: dict[bytes, Mode] = {}
        self._depend: dict[bytes, bool] = {}
        self._fewer: dict[bytes, list[tuple[Mask, bytes]]] = {}
        self._may: dict[tuple[int, bytes], bool] = {}

    def add(self, displacements: Rows, kept: np.ndarray) -> None:
        """Takes modes in, and where the contacts of one depend on each other those with some of them dropped.

        Args:
            displacements: of the freedoms that are free, shape (k, f).  kept: shape (k, m).
        """
        if not len(displacements):
            return
        rates = displacements @ self.rows.T
        patterns = np.where(np.abs(rates) <= DEPENDENT, 0.0, np.sign(rates)).astype(np.int8)
        moving = np.any(patterns, axis=1)
        directions = np.round(displacements, 3)
        full = np.zeros((len(displacements), len(self.free)))
        full[:, self.free] = displacements
        packed = np.packbits(kept, axis=1)
        for k, (displacement, moves) in enumerate(zip(full, moving.tolist(), strict=True)):
            own = packed[k].tobytes()
            pattern, direction = patterns[k].tobytes(), directions[k].tobytes()
            # where contacts depend on each other, the first order does not tell all motions apart
            doubtful = not moves or self.dependent(kept[k], own)
            if not self._new(pattern + own + (direction if doubtful else b""), displacement, kept[k]):
                continue
            for fewer, key in self._dropped(kept[k], own):
                doubtful = not moves or self.dependent(fewer, key)
                self._new(pattern + key + (direction if doubtful else b""), displacement, fewer)

    def _new(self, key: bytes, displacement: Vector, kept: Mask) -> bool:
        if key in self.found:
            return False
        self.found[key] = Mode(displacement, kept)
        return True

    def _dropped(self, kept: Mask, key: bytes) -> list[tuple[Mask, bytes]]:
        """What is left of contacts that depend on each other with some of them dropped."""
        if key not in self._fewer:
            some = self.dependent(kept, key) and np.count_nonzero(kept) <= _MOST_DROPPED
            fewer = _with_dropped(kept, self._in_circuits(kept)) if some else ()
            self._fewer[key] = [(f, np.packbits(f).tobytes()) for f in fewer if self._possible(f)]
        return self._fewer[key]

    def _possible(self, kept: Mask) -> bool:
        """Whether each point may keep what is left of its own contacts."""
        for number, point in enumerate(self.points):
            own = kept[point.pairs]
            key = number, own.tobytes()
            if key not in self._may:
                self._may[key] = point.may_keep(own)
            if not self._may[key]:
                return False
        return True

    def _in_circuits(self, kept: Mask) -> Indices:
        """Contacts kept whose face vectors depend on others': any other can be left alone by the first order."""
        left, values, _ = np.linalg.svd(self.rows[kept])
        rank = int(np.count_nonzero(values > DEPENDENT))
        return np.flatnonzero(kept)[(np.abs(left[:, rank:]) > DEPENDENT).any(axis=1)]

    def dependent(self, kept: Mask, key: bytes) -> bool:
        """Whether the face vectors of some contacts depend on each other; ``key``: the contacts, packed."""
        if key not in self._depend:
            self._depend[key] = _dependent(self.rows[kept])
        return self._depend[key]


def _placed(points: Sequence[PointMotions], places: Indices) -> list[PointMotions]:
    """With places among all contacts, not only those at ends."""
    return [replace(point, pairs=places[point.pairs]) for point in points]


def _signs(rows: Rows, points: Sequence[PointMotions] | None) -> Iterator[np.ndarray]:
    """The signs of d . dq of contacts at ends of facets for each of the cones; 0: it has to be zero."""
    if points is None:
        lines, sides = _lines(rows)
        count = int(lines.max(initial=-1)) + 1
        _refuse_too_many(float(2**count))
        yield from (np.array(signs)[lines] * sides for signs in product((-1.0, 1.0), repeat=count))
        return
    _refuse_too_many(float(np.prod([len(point.signs) for point in points])))
    for chosen in product(*(point.signs for point in points)):
        signs = np.zeros(len(rows))
        for point, own in zip(points, chosen, strict=True):
            signs[point.pairs] = own
        yield signs


def _refuse_too_many(choices: float) -> None:
    if choices > 2**MOST_SIGNS:
        raise UnsupportedError(
            f"{choices:.0f} choices of signs of contacts at ends of facets at once, more than {2**MOST_SIGNS}"
        )


def _lines(rows: Rows) -> tuple[Indices, Weights]:
    """For each row the number of its line and its side of it: rows along one line have their signs together."""
    lines, sides = np.zeros(len(rows), dtype=int), np.ones(len(rows))
    firsts: list[np.ndarray] = []
    for k, row in enumerate(rows):
        along = [float(row @ first) for first in firsts]
        near = [i for i, cosine in enumerate(along) if abs(cosine) > 1 - DEPENDENT**2]
        lines[k] = near[0] if near else len(firsts)
        sides[k] = np.sign(along[near[0]]) if near else 1.0
        if not near:
            firsts.append(row)
    return lines, sides


def _of_one_cone(signed: Rows, modes: _Modes, turns: Mask, equal: Indices) -> tuple[Rows, np.ndarray]:
    """Motions along the faces of a cone, and the contacts that each keeps."""
    cone = convert_rows(signed, signed[equal], _ROUNDED)
    faces = faces_of(len(cone.lines), cone.vectors, cone.incidence, signed.shape[1])
    # along the lineality space nothing is left to first order: its own directions stand for it
    along = [*cone.lines, *-cone.lines]
    least = _turned_least(np.array(faces.witnesses), cone.lines, turns) if len(cone.lines) else None
    motions: list[Vector] = []
    kept: list[Mask] = []
    for k, (own, witness) in enumerate(zip(faces.rows, faces.witnesses, strict=True)):
        here = [witness] if witness.any() else along
        if witness.any() and least is not None and modes.dependent(own, np.packbits(own).tobytes()):
            here = [witness, least[k]]
        motions += here
        kept += [own] * len(here)
    shape = len(motions), signed.shape[1]
    return np.array(motions).reshape(shape), np.array(kept, dtype=bool).reshape(len(motions), len(signed))


def _turned_least(witnesses: Rows, lines: Rows, turns: Mask) -> Rows:
    """Of each face the motion that turns least: facets along each other keep their contacts only while they stay so."""
    inverse = np.linalg.pinv(lines[:, turns].T, rcond=max(lines.shape) * np.finfo(float).eps)
    least = witnesses - witnesses[:, turns] @ inverse.T @ lines
    return least / np.maximum(np.linalg.norm(least, axis=1, keepdims=True), np.finfo(float).tiny)


def _with_dropped(kept: Mask, places: Indices) -> Iterator[Mask]:
    for choice in product((False, True), repeat=len(places)):
        if not all(choice):
            fewer = kept.copy()
            fewer[places] = choice
            yield fewer


def _dependent(rows: Rows) -> bool:
    if not len(rows):
        return False
    return len(rows) > rows.shape[1] or bool(np.linalg.svd(rows, compute_uv=False)[-1] <= DEPENDENT)
