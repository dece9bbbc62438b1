"""A contact: a point of the part and the facets it may not enter, as an AND of ORs of normals.

The normal is the part's outward normal, pointing into the fixture. A motion q of the part is admissible at the contact
if, in every clause, at least one of its normals n has d . q <= 0, with d the face vector of n (2-5, 2-6):

* a tip on a facet           one clause with one normal
* a tip on a convex edge     one clause, its facets as alternatives (the OR of 2.2.1)
* a tip in a concave edge    one clause for each facet (the AND of 2.2.1)

Normals are kept as they come, not normalised: (1, -1) is exact, (0.7071, -0.7071) is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Literal

import numpy as np

from fixture_design.arrays import ArrayLike, Point, Rows, read_only
from fixture_design.errors import ContactError, DimensionError
from fixture_design.tolerances import FARTHEST, MOST_FRICTION

#: What an element or contact is for. Supports come up after clamping and locate nothing.
Role = Literal["locator", "support", "clamp", "finger"]
ROLES: tuple[Role, ...] = ("locator", "support", "clamp", "finger")
#: What is closed, in its place, while the part is loaded; and what is open or down then.
STANDING: tuple[Role, ...] = ("locator", "finger")
OPENED: tuple[Role, ...] = ("clamp", "support")

#: One clause: the normals of which at least one must not be entered. `Contact` itself checks their shape.
Clause = tuple[np.ndarray, ...]


@dataclass(frozen=True)
class Provenance:
    """Where a contact's normals come from, and how far off they may be.

    Attributes:
        kind: "exact" (decimals of a file, vertices of a facet), "fitted" (a smooth surface fitted to facets) or
            "approximate" (a facet that stands for a piece of a curved surface).
        normal_error: largest angle between the normal given and the true one [rad].
        slip_error: how far off the motions are that move the surface along itself [rad]; None: as far as the normal. On
            a turned surface whose profile is not known normals are off, but only in the plane through its axis.
    """

    kind: Literal["exact", "fitted", "approximate"] = "exact"
    normal_error: float = 0.0
    slip_error: float | None = None

    @property
    def off_slip(self) -> float:
        """How far off the motions are that move the surface along itself [rad]."""
        return self.normal_error if self.slip_error is None else self.slip_error

    @staticmethod
    def worst(origins: Sequence[Provenance]) -> Provenance:
        """The least certain kind of some origins, at least one, with their largest error."""
        doubtful = max(origins, key=lambda origin: ("exact", "fitted", "approximate").index(origin.kind))
        slips = [origin.slip_error for origin in origins]
        known = None if all(slip is None for slip in slips) else max(origin.off_slip for origin in origins)
        return Provenance(doubtful.kind, max(origin.normal_error for origin in origins), known)


@dataclass(frozen=True, eq=False)
class Contact:
    """One contact of a layout, in the world frame.

    Attributes:
        name: unique in its layout.  role: what it is for.
        point: p_WC, shape (3,) or planar (2,) [m].
        clauses: AND over the outer tuple, OR over each inner one; normals of any length, same shape as ``point``.
        friction: Coulomb coefficient, >= 0.
        provenance: of the normals.
        distance: signed distance between surface and tip as it was found [m], None for contacts given outright.
        feature: name of the facet, edge or apex touched, None for contacts given outright.
        torsion: of a soft tip in space, c >= 0 [m]: with friction mu it also carries moments about the normal, up to
            mu c a newton (`limit_surface`).
        clearance: of a pin in its hole [m]: it touches at nominal, but does not keep the part in while it is open.
        slips: for each normal, clause after clause, the motions [v; w] about W's origin that move its surface along
            itself, shape (k, 6), one to three of them; empty where they are not known.
        linked: for one end of a segment on which a convex edge touches a parallel one, the contact at its other end.

    Raises:
        ContactError: no normal, zero or non-finite normal, non-finite or absurdly far point, negative friction, torsion
            or clearance, torsion in the plane.
        DimensionError: point and normals of different or unusable length.

    Example:
        >>> Contact.on_facet("P1", "locator", [1, 1], [0, 1]).dimension
        3
    """

    name: str
    role: Role
    point: np.ndarray
    clauses: tuple[Clause, ...]
    friction: float = 0.0
    provenance: Provenance = field(default_factory=Provenance)
    distance: float | None = None
    feature: str | None = None
    torsion: float = 0.0
    clearance: float = 0.0
    linked: str | None = None
    slips: tuple[np.ndarray, ...] = ()

    def __post_init__(self) -> None:
        point = read_only(self.point)
        clauses = tuple(tuple(read_only(normal) for normal in clause) for clause in self.clauses)
        object.__setattr__(self, "point", point)
        object.__setattr__(self, "clauses", clauses)
        if point.shape not in ((2,), (3,)):
            raise DimensionError(f"contact {self.name!r}: a point has 2 or 3 coordinates, not shape {point.shape}")
        # a few numbers are checked one by one sooner than as an array
        if not all(abs(value) <= FARTHEST for value in point.tolist()):
            raise ContactError(f"contact {self.name!r}: the point must be finite and within {FARTHEST:g} m: {point}")
        if not clauses or not all(clauses):
            raise ContactError(f"contact {self.name!r} has no normal")
        for normal in self.normals:
            if normal.shape != point.shape:
                raise DimensionError(f"contact {self.name!r}: normal {normal.tolist()} for point {point.tolist()}")
            values = normal.tolist()
            if not all(map(isfinite, values)):
                raise ContactError(f"contact {self.name!r}: a normal is not finite: {values}")
            if not any(values):
                raise ContactError(f"contact {self.name!r}: a normal has zero length")
        if not 0 <= self.friction <= MOST_FRICTION:
            limits = f"between 0 and {MOST_FRICTION:g}"
            raise ContactError(f"contact {self.name!r}: friction must be a number {limits}, not {self.friction}")
        for what, length in (("torsion", self.torsion), ("clearance", self.clearance)):
            if not 0 <= length <= FARTHEST:
                raise ContactError(f"contact {self.name!r}: {what} must be a length >= 0, not {length}")
        if self.torsion and len(point) == 2:
            raise ContactError(f"contact {self.name!r}: there is no torsion in the plane")

    @classmethod
    def of(
        cls,
        name: str,
        role: Role,
        point: ArrayLike,
        clauses: Sequence[Sequence[ArrayLike]],
        friction: float = 0.0,
    ) -> Contact:
        """A contact from lists: an AND of ORs of normals."""
        normals = tuple(tuple(read_only(normal) for normal in clause) for clause in clauses)
        return cls(name, role, read_only(point), normals, friction)

    @classmethod
    def on_facet(cls, name: str, role: Role, point: ArrayLike, normal: ArrayLike, friction: float = 0.0) -> Contact:
        """A contact with a single normal."""
        return cls.of(name, role, point, [[normal]], friction)

    @property
    def normals(self) -> tuple[Point, ...]:
        """All normals, clause after clause."""
        return tuple(normal for clause in self.clauses for normal in clause)

    @property
    def dimension(self) -> int:
        """Dimension of its face vectors: 3 in the plane, 6 in space."""
        return 3 if len(self.point) == 2 else 6


def unit_normal(normal: np.ndarray) -> np.ndarray:
    """Normals, shape (..., p), at length one; in two steps, since the square of 1e-200 is zero."""
    scaled = normal / np.maximum.reduce(np.abs(normal), axis=-1, keepdims=True)
    return scaled / np.sqrt(np.add.reduce(scaled * scaled, axis=-1, keepdims=True))


def matching(first: Clause, second: Clause, within: float) -> bool:
    """Whether two clauses have the same alternatives, whatever their order and length."""
    if len(first) != len(second):
        return False
    ones, others = _units(first), _units(second)
    near = np.linalg.norm(ones[:, None] - others[None], axis=2) <= within
    return bool(near.any(axis=1).all() and near.any(axis=0).all())


def _units(clause: Clause) -> Rows:
    return np.array([unit_normal(normal) for normal in clause])
