"""Candidates: what may become an element of the fixture, as arrays.

A candidate has one point and one unit normal; an element that a start layout brings may have several (a pad, a pin).
Rows are face vectors [n; (x - center) X n / length], scaled to length one: a candidate *stops* a motion u if one of its
rows has d . u > 0, and candidates close if together they stop every motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Point, Points, Rows, Vector, Weights
from fixture_design.contacts import (
    Contact,
    Provenance,
    Scale,
    Side,
    face_vectors,
    limit_directions,
    tangents,
    torsion_of_patch,
    unit_normal,
)
from fixture_design.layout import Element, PointTip, SoftTip, Tip
from fixture_design.tolerances import DEFAULT, KNOWN_WELL, Tolerances

#: For each candidate its points, normals or rows, as many for each: shape (n, k, ...); unused ones are zero.
Several = Float[np.ndarray, "n k _"]

#: Edges of the pyramids inside friction cones, while searching [-]; the verdict on the result refines them.
EDGES = 8


@runtime_checkable
class Spots(Protocol):
    """Points on a part's surface with outward unit normals, as `geometry.SurfacePoints` has them."""

    @property
    def points(self) -> Points: ...
    @property
    def normals(self) -> Points: ...
    @property
    def features(self) -> tuple[str, ...]: ...
    @property
    def provenance(self) -> tuple[Provenance, ...]: ...


@dataclass(frozen=True, eq=False)
class Make:
    """What a new element would be: its tip, and of a pin the axis, in W."""

    tip: Tip
    axis: Point | None = None


@dataclass(frozen=True, eq=False)
class Candidates:
    """n candidates in W.

    Attributes:
        points, normals: shape (n, k, p) [m, -]; a zero normal says nothing.
        features: what each of them touches.
        errors: how far the normals may be off [rad].
        friction: coefficient of each, used only where rows with friction are asked for.
        torsion: of soft tips, likewise: the moment about the normal of a force of 1, for a coefficient of 1 [m].
        vague: whether each may do more than its rows say: where alternatives, or normals, are open.
        elements: the element that a candidate is already; None for those that are none yet.
        scale: reference point and length of the rows.
        places: where an element is asked to stand, shape (n, p) [m].
        makes: what an element there would be, for those that are none yet.
        plane: whether what each touches is plane, and no surface that was fitted.
    """

    points: Several
    normals: Several
    features: tuple[str, ...]
    errors: Weights
    friction: Weights
    torsion: Weights
    vague: Mask
    elements: tuple[Element | None, ...]
    scale: Scale
    places: Points
    makes: tuple[Make | None, ...]
    plane: Mask

    @classmethod
    def of(cls, spots: Spots, scale: Scale, friction: float = 0.0, make: Make | None = None) -> Candidates:
        """One candidate a spot, for a tip that touches in a point; a point by default."""
        count = len(spots.points)
        errors = np.array([origin.normal_error for origin in spots.provenance], dtype=np.float64)
        points, normals = np.array(spots.points)[:, None, :], np.array(spots.normals)[:, None, :]
        nothing = (None,) * count
        makes = (make or Make(PointTip()),) * count
        places = np.array(spots.points)
        plane = np.array([origin.kind == "exact" for origin in spots.provenance], dtype=bool)
        soft = make.tip if make is not None and isinstance(make.tip, SoftTip) and points.shape[2] == 3 else None
        torsion = np.full(count, 0.0 if soft is None else torsion_of_patch(soft.radius))
        rubbing = np.full(count, friction)
        certain = np.zeros(count, dtype=bool)
        return cls(
            points, normals, spots.features, errors, rubbing, torsion, certain, nothing, scale, places, makes, plane
        )

    @classmethod
    def touching(
        cls, found: Sequence[tuple[Element, Sequence[Contact]]], scale: Scale, friction: float = 0.0
    ) -> Candidates:
        """New elements of any kind, with the contacts that they would have; at least one."""
        points, normals = _packed(found)
        return cls(
            points,
            normals,
            tuple(contacts[0].feature or "the surface" for _, contacts in found),
            np.array([max(c.provenance.normal_error for c in one) for _, one in found], dtype=np.float64),
            np.full(len(found), friction),
            np.array([max(c.torsion for c in one) for _, one in found]),
            np.array([any(len(clause) > 1 for c in one for clause in c.clauses) for _, one in found], dtype=bool),
            (None,) * len(found),
            scale,
            np.array([element.at for element, _ in found]),
            tuple(Make(element.tip, element.axis) for element, _ in found),
            np.array([all(c.provenance.kind == "exact" for c in one) for _, one in found], dtype=bool),
        )

    def and_also(self, others: Candidates) -> Candidates:
        """These, then others, of the same scale."""
        most = max(self.points.shape[1], others.points.shape[1])
        mine, theirs = _widened(self, most), _widened(others, most)
        return Candidates(
            np.concatenate([mine[0], theirs[0]]),
            np.concatenate([mine[1], theirs[1]]),
            (*self.features, *others.features),
            np.append(self.errors, others.errors),
            np.append(self.friction, others.friction),
            np.append(self.torsion, others.torsion),
            np.append(self.vague, others.vague),
            (*self.elements, *others.elements),
            self.scale,
            np.concatenate([self.places, others.places]),
            (*self.makes, *others.makes),
            np.append(self.plane, others.plane),
        )

    def __len__(self) -> int:
        return len(self.points)

    @property
    def dimension(self) -> int:
        """3 in the plane, 6 in space."""
        return 3 if self.points.shape[2] == 2 else 6

    @cached_property
    def rows(self) -> Several:
        """Unit face vectors of the normals, shape (n, k, d)."""
        return _of_length_one(self.pushes(rough=False))

    @cached_property
    def rows_with_friction(self) -> Several:
        """Unit face vectors of the edges of the friction cones, shape (n, k e, d); exact in the plane, inside else."""
        return _of_length_one(self.pushes(rough=True))

    @cached_property
    def rows_around_friction(self) -> Several:
        """The same with pyramids around the cones: what does not close with them does not close."""
        return _of_length_one(self.pushes(rough=True, outer=True))

    def pushes(self, *, rough: bool, outer: bool = False) -> Several:
        """Face vectors [e; (x - reference) X e / length] of forces e with a normal part of 1, shape (n, k, d).

        Args:
            rough: the edges of a pyramid in each friction cone, shape (n, k e, d), of soft tips with moments about
                their normals; else the normals.
            outer: the pyramid around the cone instead.
        """
        if not rough:
            return self._faces(self.points, self.normals)
        n, _, p = self.normals.shape
        first, second, around = self._across(), np.zeros_like(self.normals), np.array([[1.0, 0, 0], [-1, 0, 0]])
        if p == 3:
            second, around = np.cross(self.normals, first), self._around("outer" if outer else "inner")
        turned = around[:, :1] * first[:, :, None] + around[:, 1:2] * second[:, :, None]
        edges = self.normals[:, :, None] + self.friction[:, None, None, None] * turned
        points = np.broadcast_to(self.points[:, :, None], edges.shape)
        faces = self._faces(points.reshape(n, -1, p), edges.reshape(n, -1, p))
        if self.torsion.any():
            # a soft tip on a surface that may be round has none for certain
            torsion = self.torsion if outer else np.where(self.plane, self.torsion, 0.0)
            spins = (self.friction * torsion / self.scale.length)[:, None, None, None] * around[:, 2:]
            faces[..., 3:] += (spins * self.normals[:, :, None]).reshape(n, -1, 3)
        return faces

    def _across(self) -> Several:
        """A unit tangent at each point."""
        if self.normals.shape[2] == 2:
            return np.stack([-self.normals[..., 1], self.normals[..., 0]], axis=-1)
        first = np.zeros_like(self.normals)
        said = self.normals.any(axis=2)
        first[said] = tangents(self.normals[said])[0]
        return first

    def _around(self, side: Side) -> Points:
        """Corners of a polygon in or around the unit circle, or with soft tips of a polytope in or around the ball."""
        if self.torsion.any():
            return limit_directions(EDGES, side)
        angles = 2 * np.pi * np.arange(EDGES) / EDGES
        size = 1.0 / np.cos(np.pi / EDGES) if side == "outer" else 1.0
        return size * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(EDGES)])

    def chosen(self, which: Indices | Mask) -> Candidates:
        """Some of them, in that order."""
        numbers = np.arange(len(self))[which]
        return replace(
            self,
            points=self.points[numbers],
            normals=self.normals[numbers],
            features=tuple(self.features[number] for number in numbers),
            errors=self.errors[numbers],
            friction=self.friction[numbers],
            torsion=self.torsion[numbers],
            vague=self.vague[numbers],
            elements=tuple(self.elements[number] for number in numbers),
            places=self.places[numbers],
            makes=tuple(self.makes[number] for number in numbers),
            plane=self.plane[numbers],
        )

    def with_elements(
        self, found: Sequence[tuple[Element, Sequence[Contact]]], known_to: float = KNOWN_WELL
    ) -> Candidates:
        """These, and elements with the contacts they have: appended, so that indices stay.

        Alternatives (a tip on a convex edge) stop nothing for certain, whichever the part takes; they count as no row.
        Nor do normals that are known less well than ``known_to`` [rad] and the candidates' own: they would blur these.
        """
        if not found:
            return self
        there = Candidates.touching(found, self.scale)
        blurred = there.errors > max(float(self.errors.max(initial=0.0)), known_to)
        there = replace(
            there,
            normals=np.where(blurred[:, None, None], 0.0, there.normals),
            errors=np.where(blurred, 0.0, there.errors),
            vague=there.vague | blurred,
        )
        return self.and_also(
            replace(
                there,
                features=tuple(contacts[0].feature or element.name for element, contacts in found),
                friction=np.array([contacts[0].friction for _, contacts in found]),
                elements=tuple(element for element, _ in found),
                makes=(None,) * len(found),
            )
        )

    def with_friction(self, friction: float) -> Candidates:
        """The same, where those that are no elements yet have this coefficient, and elements without one too."""
        bare = np.array([e is None or e.friction is None for e in self.elements])
        return replace(self, friction=np.where(bare, friction, self.friction))

    @cached_property
    def tolerances(self) -> Tolerances:
        """What counts as zero: a row may be off by what its normal may be, times sqrt(2) at the edge of the part."""
        error = float(self.errors.max(initial=0.0)) * float(np.sqrt(2))
        return Tolerances(max(DEFAULT.tie, error / DEFAULT.band), DEFAULT.band)

    @cached_property
    def freedoms(self) -> int:
        """How many motions they can notice at all: 6 in space, 5 for a shaft, 3 for a ball."""
        values = np.linalg.svd(self.rows.reshape(-1, self.dimension), compute_uv=False)
        return int((values > self.tolerances.near * values[0]).sum())

    @cached_property
    def locating(self) -> Several:
        """Rows by which each one locates, shape (n, k, d): independent ones, the others are zero.

        Of the corners of a pad on a facet three are independent, however many there are.
        """
        rows = self.rows.copy()
        several = np.flatnonzero(rows.any(axis=2).sum(axis=1) > 1)
        rest, kept = rows[several], np.zeros((len(several), rows.shape[1]), dtype=bool)
        each = np.arange(len(several))
        for _ in range(min(rows.shape[1:])):
            lengths = np.where(kept, 0.0, np.linalg.norm(rest, axis=2))
            best = np.argmax(lengths, axis=1)
            far = lengths[each, best] > self.tolerances.near
            kept[each[far], best[far]] = True
            directions = rest[each, best] / np.where(far, lengths[each, best], 1.0)[:, None]
            rest = np.where(far[:, None, None], rest - (rest @ directions[:, :, None]) * directions[:, None], rest)
        rows[several] = np.where(kept[:, :, None], rows[several], 0.0)
        return rows

    def _faces(self, points: Several, normals: Several) -> Several:
        n, k, p = normals.shape
        rows = face_vectors((points - self.scale.reference).reshape(-1, p), normals.reshape(-1, p))
        rows[:, p:] /= self.scale.length
        return rows.reshape(n, k, -1)


def _of_length_one(rows: Several) -> Several:
    """Rows of length one; what says nothing stays zero."""
    lengths = np.linalg.norm(rows, axis=2, keepdims=True)
    return np.divide(rows, lengths, out=np.zeros_like(rows), where=lengths > 0)


def _packed(found: Sequence[tuple[Element, Sequence[Contact]]]) -> tuple[Several, Several]:
    """Points and normals of the contacts of each, shape (n, k, p); alternatives count as none."""
    several = [[(c.point, n) for c in contacts for n in _certain(c)] for _, contacts in found]
    most, p = max(1, *map(len, several)), len(found[0][0].at)
    points, normals = np.zeros((len(found), most, p)), np.zeros((len(found), most, p))
    for index, ((element, _), given) in enumerate(zip(found, several, strict=True)):
        points[index] = element.at
        for place, (point, normal) in enumerate(given):
            points[index, place], normals[index, place] = point, normal
    return points, normals


def _widened(candidates: Candidates, most: int) -> tuple[Several, Several]:
    wider = ((0, 0), (0, most - candidates.points.shape[1]), (0, 0))
    return np.pad(candidates.points, wider, mode="edge"), np.pad(candidates.normals, wider)


def _certain(contact: Contact) -> list[Point]:
    """The unit normals that the part may not enter, whatever alternatives it takes."""
    return [unit_normal(clause[0]) for clause in contact.clauses if len(clause) == 1]


def stops(rows: Several, motion: Vector, zero: float) -> Mask:
    """Which candidates stop a unit motion, by more than ``zero``: shape (n,)."""
    return (rows @ motion).max(axis=1) > zero


def flat(rows: Several, which: Sequence[int] | Indices) -> Rows:
    """The rows of some candidates, one under the other."""
    return np.ascontiguousarray(rows[np.asarray(which, dtype=np.int64)].reshape(-1, rows.shape[2]))
