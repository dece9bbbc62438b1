"""One place of contact between two solids: the tangent cones there, and the clauses that follow from them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Clause, Provenance, unit_normal
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.geometry.local import LocalSurface, local_surface
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Vector3
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT


@dataclass(frozen=True, eq=False)
class Touch:
    """A place of contact, in the part's frame P.

    Attributes:
        point: of the part, shape (3,) [m].  other: of the body, within the gap [m].
        clauses: AND of ORs of normals out of the part, into the body.
        features: what touches what there: of the part, of the body.
        provenance: of the normals, the worst of both sides.
        twin: for an end of a segment with alternatives, the point of its other end; else None.
    """

    point: Vector3
    other: Vector3
    clauses: tuple[Clause, ...]
    features: tuple[str, str]
    provenance: Provenance
    twin: Vector3 | None = None

    @property
    def distance(self) -> float:
        """Gap along the first normal, negative where the solids overlap [m]."""
        return float((self.other - self.point) @ unit_normal(self.clauses[0][0]))


class Tangents:
    """The local surfaces of a part and a body, each looked at once; the body in the part's frame."""

    def __init__(self, part: PartGeometry, body: PartGeometry) -> None:
        self.part, self.body = part, body
        self._known: dict[tuple[str, bytes], LocalSurface] = {}

    def touch(self, point: Vector3, other: Vector3) -> Touch | None:
        """The contact at a pair of points; None where nothing is excluded, or the cones overlap already.

        Overlapping cones within the gap come from features that pass each other there; real penetration is measured
        elsewhere (`penetration`).
        """
        mine, theirs = self._local("part", self.part, point), self._local("body", self.body, other)
        theirs_snapped = _snapped(theirs, mine)
        clauses = polyhedral_clauses(mine.clauses, theirs_snapped, COPLANAR_ANGLE)
        if not clauses:
            return None
        provenance = mine.provenance if _all_of(clauses, mine) else _worse(mine.provenance, theirs.provenance)
        if provenance.normal_error <= DEFAULT.zero:
            # what placing the body has rounded; every tie covers that
            provenance = replace(provenance, normal_error=0.0)
        return Touch(point, other, clauses, (mine.feature, theirs.feature), provenance)

    def _local(self, side: str, geometry: PartGeometry, point: Vector3) -> LocalSurface:
        key = (side, np.round(point / geometry.on_edge).tobytes())
        if key not in self._known:
            self._known[key] = local_surface(geometry, point)
        return self._known[key]


def _all_of(clauses: tuple[Clause, ...], surface: LocalSurface) -> bool:
    """Whether all normals are the surface's own: then those of the other side, and their errors, play no part."""
    own = {id(normal) for clause in surface.clauses for normal in clause}
    return all(id(normal) in own for clause in clauses for normal in clause)


def _worse(first: Provenance, second: Provenance) -> Provenance:
    kind = next((kind for kind in ("approximate", "fitted") if kind in {first.kind, second.kind}), "exact")
    return Provenance(kind, max(first.normal_error, second.normal_error))


def _snapped(surface: LocalSurface, other: LocalSurface) -> tuple[tuple[Point, ...], ...]:
    """The pieces of one side, its normals turned to be opposed to those of the other side where they nearly are.

    Faces that lie on each other are parallel, however the pose was rounded.
    """
    within = COPLANAR_ANGLE + surface.provenance.normal_error + other.provenance.normal_error
    opposed = [-normal for clause in other.clauses for normal in clause]

    def turned(normal: Point) -> Point:
        off = [float(np.linalg.norm(unit_normal(normal) - unit_normal(candidate))) for candidate in opposed]
        best = int(np.argmin(off))
        return opposed[best] if off[best] <= within else normal

    return tuple(tuple(turned(normal) for normal in clause) for clause in surface.clauses)
