"""One place of contact between two solids: the tangent cones there, and the clauses that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from fixture_design.arrays import Indices, Point, Rows, cross_products
from fixture_design.contacts import Clause, Provenance, unit_normal
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.geometry.local import LocalSurface, facets_at, local_surface
from fixture_design.geometry.nearest import touched_at_each, touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.round_meeting import RoundPlace
from fixture_design.geometry.shapes import Directions, Vector3
from fixture_design.geometry.walls import is_wall
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, SQUARED_ANGLE

#: How far off a wall it is looked for material, in widths of an edge [-].
_STEP_OFF = 10.0
#: Sine up to which a normal is that of a round surface there: points are off it by what its facets are [-].
_SAME_ROUND = 1e-3


@dataclass(frozen=True, eq=False)
class Touch:
    """A place of contact, in the part's frame P.

    Attributes:
        point: of the part, shape (3,) [m].  other: of the body, within the gap [m].
        clauses: AND of ORs of normals out of the part, into the body.
        features: what touches what there: of the part, of the body.
        provenance: of the normals, the worst of both sides.
        twin: for an end of a segment with alternatives, the point of its other end; else None.
        slips: for each normal the motions about P's origin that move its surface along itself, of the part or of the
            body; empty where they are not known.
    """

    point: Vector3
    other: Vector3
    clauses: tuple[Clause, ...]
    features: tuple[str, str]
    provenance: Provenance
    twin: Vector3 | None = None
    slips: tuple[Rows, ...] = ()

    @property
    def distance(self) -> float:
        """Gap along the first normal, negative where the solids overlap [m]."""
        return float((self.other - self.point) @ unit_normal(self.clauses[0][0]))


@dataclass(frozen=True, eq=False)
class _Side:
    """What one solid is like at a point: its local surface, and the normals of the cylinders and balls that meet."""

    local: LocalSurface
    round_normals: tuple[Vector3, ...]


#: What there is to be said about a pair of sides: the clauses, where their normals are from, and along what their
#: surfaces move (`Touch.slips`); None if nothing is.
_Meeting = tuple[tuple[Clause, ...], Provenance, tuple[Rows, ...]] | None


class Tangents:
    """The local surfaces of a part and a body, each looked at once; the body in the part's frame.

    Along an edge and all over a face they are the same, and so is what follows from a pair of them.
    """

    def __init__(self, part: PartGeometry, body: PartGeometry) -> None:
        self.part, self.body = part, body
        self._touched: dict[tuple[str, bytes], Indices] = {}
        self._known: dict[tuple[str, bytes], _Side] = {}
        self._alike: dict[tuple[object, ...], _Side] = {}
        self._meetings: dict[tuple[int, int], _Meeting] = {}

    def expect(self, points: Directions, others: Directions) -> None:
        """Get ready for pairs of points: all that they touch is looked for in one go."""
        for side, geometry, at in (("part", self.part, points), ("body", self.body, others)):
            found = touched_at_each(geometry, at, geometry.on_edge)
            keys = [(side, point.tobytes()) for point in at]
            self._touched.update(zip(keys, found, strict=True))

    def touch(self, point: Vector3, other: Vector3) -> Touch | None:
        """The contact at a pair of points; None where nothing is excluded.

        Cones that overlap already are of features that pass each other within the gap: penetration beyond it was
        looked for before (`penetration`).
        """
        at, at_other = self._touched_at("part", point), self._touched_at("body", other)
        if _is_buried(self.part, point, at) or _is_buried(self.body, other, at_other):
            return None
        mine, theirs = self._side("part", point), self._side("body", other)
        key = (id(mine), id(theirs))
        if key not in self._meetings:
            self._meetings[key] = _meeting(mine, theirs)
        meeting = self._meetings[key]
        if meeting is None:
            return None
        clauses, provenance, slips = meeting
        return Touch(point, other, clauses, (mine.local.feature, theirs.local.feature), provenance, slips=slips)

    def at_round(self, place: RoundPlace, mine_is_round: bool, sharp: bool = False) -> Touch | None:
        """The contact of a round surface with a flat or round one, or (``sharp``) with an edge or vertex.

        Args:
            mine_is_round: the first point of the place is the part's; else it is the body's.
        """
        point, other = (place.point, place.other) if mine_is_round else (place.other, place.point)
        normal = place.normal if mine_is_round else -place.normal
        names = (place.name, place.other_name) if mine_is_round else (place.other_name, place.name)
        clauses: tuple[Clause, ...] | None = ((normal,),)
        if sharp:
            local = self._side("part" if mine_is_round else "body", place.point).local
            pieces, half = local.clauses, [[-place.normal]]
            clauses = polyhedral_clauses(*((pieces, half) if mine_is_round else (half, pieces)), COPLANAR_ANGLE)
            names = (local.feature, names[1]) if mine_is_round else (names[0], local.feature)
        if not clauses:
            return None
        error = place.error if place.error > DEFAULT.zero else 0.0
        alone = [len(clause) for clause in clauses] == [1]
        return Touch(point, other, clauses, names, Provenance("fitted", error), slips=(place.slips,) if alone else ())

    def _geometry(self, side: str) -> PartGeometry:
        return self.part if side == "part" else self.body

    def _touched_at(self, side: str, point: Vector3) -> Indices:
        key = (side, point.tobytes())
        if key not in self._touched:
            geometry = self._geometry(side)
            self._touched[key] = touched_triangles(geometry, point, geometry.on_edge)
        return self._touched[key]

    def _side(self, side: str, point: Vector3) -> _Side:
        """One and the same for all points where it is alike."""
        geometry = self._geometry(side)
        key = (side, np.round(point / geometry.on_edge).tobytes())
        if key not in self._known:
            local = local_surface(geometry, point, touched=self._touched_at(side, point))
            found = _Side(local, _round_normals(geometry, local, point))
            normals = tuple(tuple(normal.tobytes() for normal in clause) for clause in local.clauses)
            rounds = tuple(normal.tobytes() for normal in found.round_normals)
            content = (side, local.feature, local.facets, local.provenance, normals, rounds)
            self._known[key] = self._alike.setdefault(content, found)
        return self._known[key]


def _meeting(mine: _Side, theirs: _Side) -> _Meeting:
    """The clauses of two local surfaces that touch."""
    theirs_snapped = _snapped(theirs.local, mine.local)
    clauses = polyhedral_clauses(mine.local.clauses, theirs_snapped, COPLANAR_ANGLE, pass_by=True)
    # between two round surfaces contact is along lines or all around, not at the vertices that stand for them
    sides = (mine.round_normals, theirs.round_normals)
    clauses = tuple(c for c in clauses or () if not all(_among(c, side) for side in sides))
    if not clauses:
        return None
    ours, others = mine.local.provenance, theirs.local.provenance
    provenance = ours if _all_of(clauses, mine.local) else Provenance.worst([ours, others])
    turned = _turn(clauses, mine.local, theirs.local)
    doubt = max(provenance.normal_error, turned, _crossing_error(clauses, mine.local, theirs.local))
    # what placing the body has rounded is covered by every tie
    provenance = replace(provenance, normal_error=doubt if doubt > DEFAULT.zero else 0.0)
    return clauses, provenance, _slips(clauses, ((mine.local, mine.local.clauses), (theirs.local, theirs_snapped)))


def _is_buried(geometry: PartGeometry, point: Vector3, touched: Indices) -> bool:
    """Whether a point is on a wall between solids that touch or overlap, with material on both sides."""
    if geometry.is_one_shell:
        return False
    wall = is_wall(geometry, point, touched) if len(touched) else None
    if wall is not None:
        return wall
    normals = list(geometry.facet_units[facets_at(geometry, touched)])
    # out of a concave corner lead only directions between its normals
    outward = [sum(chosen, np.zeros(3)) for size in (3, 2, 1) for chosen in combinations(normals, size)]
    steps = [_STEP_OFF * geometry.on_edge * unit_normal(way) for way in outward if np.linalg.norm(way) > _SAME_ROUND]
    return bool(normals) and bool(geometry.inside(point + np.array(steps)).all())


def _round_normals(geometry: PartGeometry, local: LocalSurface, point: Vector3) -> tuple[Vector3, ...]:
    """The normals of the cylinders and balls that meet at a point."""
    surfaces = (geometry.surface_of_facet(facet) for facet in local.facets)
    return tuple(s.normal(point) for s in surfaces if s is not None and s.kind in ("cylinder", "sphere"))


def _among(clause: Clause, normals: Sequence[Vector3]) -> bool:
    """Whether all normals of a clause are among some unit normals, either way round."""
    sines = [min((np.linalg.norm(np.cross(unit_normal(n), other)) for other in normals), default=1.0) for n in clause]
    return bool(max(sines) <= _SAME_ROUND)


def _all_of(clauses: tuple[Clause, ...], surface: LocalSurface) -> bool:
    """Whether all normals are the surface's own: then those of the other side, and their errors, play no part."""
    own = {id(normal) for clause in surface.clauses for normal in clause}
    return all(id(normal) in own for clause in clauses for normal in clause)


def _slips(clauses: tuple[Clause, ...], sides: Sequence[tuple[LocalSurface, tuple[Clause, ...]]]) -> tuple[Rows, ...]:
    """For each normal the motions of its surface; empty if one is no surface's own, but of edges that cross.

    ``sides``: each local surface with its normals as they went into the clauses, opposed or not.
    """
    own = {
        tuple(sign * unit_normal(normal)): slips
        for surface, used in reversed(sides)
        if surface.slips
        for normal, slips in zip((n for clause in used for n in clause), surface.slips, strict=True)
        for sign in (1.0, -1.0)
    }
    found = [own.get(tuple(unit_normal(normal))) for clause in clauses for normal in clause]
    known = tuple(slips for slips in found if slips is not None)
    return known if len(known) == len(found) else ()


def _turn(clauses: tuple[Clause, ...], mine: LocalSurface, theirs: LocalSurface) -> float:
    """How far apart normals are that were taken for one another [rad]; 0 within what a pose's digits may leave."""
    given = _facing(mine, theirs)
    within = 3 * COPLANAR_ANGLE + mine.provenance.normal_error + theirs.provenance.normal_error
    off = np.array([np.linalg.norm(given - unit_normal(normal), axis=1) for clause in clauses for normal in clause])
    worst = float(np.where(off <= within, off, 0.0).max())
    return worst if worst > SQUARED_ANGLE else 0.0


def _facing(mine: LocalSurface, theirs: LocalSurface) -> Rows:
    """The unit normals of both sides, those of the other one reversed."""
    own = [unit_normal(normal) for clause in mine.clauses for normal in clause]
    return np.array([*own, *(-unit_normal(normal) for clause in theirs.clauses for normal in clause)])


def _crossing_error(clauses: tuple[Clause, ...], mine: LocalSurface, theirs: LocalSurface) -> float:
    """Error of the normals that are cross products of edges [rad].

    An edge is off by the errors of its facets over the sine of the angle between them, the product by those of both
    edges over the sine of the angle at which they cross.
    """
    if mine.provenance.normal_error == theirs.provenance.normal_error == 0:
        return 0.0
    given, worst = _facing(mine, theirs), 0.0
    for normal in (unit_normal(normal) for clause in clauses for normal in clause):
        if np.linalg.norm(given - normal, axis=1).min() <= COPLANAR_ANGLE:
            continue
        for edge, error in _edges_of(mine):
            for other, other_error in _edges_of(theirs):
                product = cross_products(edge, other)
                sine = float(np.linalg.norm(product))
                if sine > COPLANAR_ANGLE and abs(float(product @ normal)) >= (1 - COPLANAR_ANGLE) * sine:
                    worst = max(worst, (error + other_error) / sine)
    return worst


def _edges_of(surface: LocalSurface) -> list[tuple[Vector3, float]]:
    """Unit directions of the lines in which facets at a point meet, and their errors [rad]."""
    units = [unit_normal(normal) for clause in surface.clauses for normal in clause]
    edges = []
    for first, second in combinations(units, 2):
        line = cross_products(first, second)
        sine = float(np.linalg.norm(line))
        if sine > COPLANAR_ANGLE:
            edges.append((line / sine, 2 * surface.provenance.normal_error / sine))
    return edges


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
