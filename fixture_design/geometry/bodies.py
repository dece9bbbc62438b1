"""The contacts of fixture bodies (V-blocks, jaws, nests, dowels) with the part: every one that there is counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fixture_design.arrays import read_only
from fixture_design.contacts import Contact, matching
from fixture_design.errors import PenetrationError, UnsupportedError, format_length, looking_at
from fixture_design.geometry.contact import moved_with
from fixture_design.geometry.features import Features, features_of
from fixture_design.geometry.load import load_part
from fixture_design.geometry.local import facets_at, feature_name
from fixture_design.geometry.meeting import meeting_points, running_edges
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.patches import essential
from fixture_design.geometry.penetration import deepest
from fixture_design.geometry.piece import SmoothPatch
from fixture_design.geometry.polygon import Polygon
from fixture_design.geometry.round_meeting import round_on_flat, round_on_round, sharp_on_round
from fixture_design.geometry.round_unmade import unmade
from fixture_design.geometry.separation import separation
from fixture_design.geometry.touch import Tangents, Touch
from fixture_design.layout import Body, Layout, Part, Pose
from fixture_design.tolerances import COPLANAR_ANGLE, ROUND_OFF

#: Places of contact looked at for one body; a soft jaw that copies a curved surface has more.
MOST_PLACES = 20_000


def contacts_of_bodies(layout: Layout, geometry: PartGeometry | Polygon) -> tuple[tuple[Contact, ...], tuple[str, ...]]:
    """All contacts of a layout's bodies with its part, in W, body after body, and notes about them.

    A body's contacts are called BODY#1, BODY#2, ... in the order of their coordinates, and have its role and friction.
    Places that follow from others are left out: of a face on a face the corners of the overlap stay. Two ends of a
    segment along which convex edges touch are ``linked``. A body that touches nothing is a note with its distance.

    Raises:
        PenetrationError: a body is deeper in the part than ``layout.surface_gap``.
        UnsupportedError: planar layouts; what `load_part` and `local_surface` do not take.
        GeometryError: a body's geometry cannot be used.
    """
    found: list[Contact] = []
    notes: list[str] = []
    for body in layout.bodies:
        if layout.part is None or isinstance(geometry, Polygon):
            text = f"body {body.name!r}: bodies are URDF, which has no planar form"
            raise UnsupportedError(text, source=layout.source, expected="`contacts` or `elements` in planar layouts")
        with looking_at(layout.source, layout.places.get(("bodies", body.name))):
            contacts, its_notes = contacts_of_body(body, layout.part, geometry, layout.friction, layout.surface_gap)
        found += contacts
        notes += its_notes
    return tuple(found), tuple(notes)


def contacts_of_body(
    body: Body, part: Part, geometry: PartGeometry, friction: float, surface_gap: float
) -> tuple[tuple[Contact, ...], tuple[str, ...]]:
    """The contacts of one body and notes about it; see `contacts_of_bodies`."""
    placed = placed_geometry(body, part.pose)
    mine, theirs = features_of(geometry), Features(placed)
    _check_room(body, part, mine, theirs, surface_gap)
    touches = touches_between(mine, theirs, surface_gap)
    notes = tuple(f"body {body.name!r}: {note}" for note in placed.read_notes)
    if not touches:
        apart = separation(mine.solid, theirs.solid, Pose.identity(3))
        if apart.distance <= surface_gap:
            place = apart.point if apart.point is not None else geometry.box_center
            at = np.round(part.pose.points(place[None])[0], 6).tolist()
            text = f"body {body.name!r} touches the part near {at} m, in no way that contacts can be made of"
            raise UnsupportedError(
                text, expected=f"contact on facets, edges or apices, or a clearance above {surface_gap:g} m"
            )
        return (), (*notes, f"body {body.name!r} does not touch the part: it is {format_length(apart.distance)} away")
    missed = unmade(mine, theirs, np.array([touch.point for touch in touches]), surface_gap)
    if missed is not None:
        at = np.round(part.pose.points(missed[0][None])[0], 6).tolist()
        text = f"{missed[1]} of the part touches {missed[2]} of body {body.name!r} near {at} m: not evaluated"
        raise UnsupportedError(text, expected="no cones or tori where round surfaces touch; or clearance there")
    return _named(body, part.pose, touches, friction), notes


def placed_geometry(body: Body, X_WP: Pose) -> PartGeometry:
    """A body's geometry in the part's frame P."""
    geometry = load_part(Part(body.name, "urdf", body.file, None, 1.0, body.pose))
    X_PW = X_WP.inverse()
    rotation = X_PW.rotation @ body.pose.rotation
    translation = X_PW.points(body.pose.translation[None])[0]
    if np.array_equal(rotation, np.eye(3)) and not translation.any():
        return geometry
    return moved_geometry(geometry, Pose(read_only(rotation), read_only(translation)))


def moved_geometry(geometry: PartGeometry, X_PB: Pose) -> PartGeometry:
    """A geometry given in B, in P."""
    vertices = X_PB.points(geometry.vertices)
    # a product of rotations leaves 1e-17 where it should leave nothing
    vertices = np.where(np.abs(vertices) <= 4 * ROUND_OFF * geometry.half_diagonal, 0.0, vertices)
    rounding = geometry.rounding + 4 * ROUND_OFF * np.abs(vertices).max(axis=1)
    given = tuple(_placed_patch(patch, X_PB) for patch in geometry.given)
    return replace(geometry, vertices=read_only(vertices), rounding=read_only(rounding), given=given)


def _placed_patch(patch: SmoothPatch, X_PB: Pose) -> SmoothPatch:
    return replace(patch, point=X_PB.points(patch.point[None])[0], axis=X_PB.vectors(patch.axis[None])[0])


def touches_between(part: Features, body: Features, gap: float) -> tuple[Touch, ...]:
    """The places of contact of two solids in one frame, those that follow from others left out."""
    blur = max(part.geometry.on_edge, body.geometry.on_edge)
    pairs = meeting_points(part, body, gap)
    segments = running_edges(part, body, gap)
    if len(pairs.part) + len(segments.part) > MOST_PLACES:
        text = f"{part.geometry.name!r} and {body.geometry.name!r} meet in {len(pairs.part)} places"
        raise UnsupportedError(text, expected=f"at most {MOST_PLACES}; a coarser mesh where they touch")
    tangents = Tangents(part.geometry, body.geometry)
    tangents.expect(pairs.part, pairs.body)
    tangents.expect(segments.part.mean(axis=1), segments.body.mean(axis=1))
    touches: list[Touch] = []
    for start, other_start in zip(segments.part, segments.body, strict=True):
        touches += _along(tangents, start, other_start)
    touches += _round_touches(tangents, part, body, gap)
    for beside in (False, True):
        # what only passes by within the gap counts where nothing else is
        settled = np.array([touch.point for touch in touches]).reshape(-1, 3)
        for point, other in _distinct(pairs.part[pairs.beside == beside], pairs.body[pairs.beside == beside], blur):
            if beside and (np.linalg.norm(settled - point, axis=1) <= 4 * gap).any():
                continue
            touch = tangents.touch(point, other)
            touches += [touch] if touch else []
    return essential(touches, gap, blur)


def _round_touches(tangents: Tangents, part: Features, body: Features, gap: float) -> list[Touch]:
    """The contacts of round surfaces, of either side."""
    found = [tangents.at_round(place, True) for place in round_on_round(part, body, gap)]
    for mine, theirs, mine_is_part in ((part, body, True), (body, part, False)):
        found += [tangents.at_round(place, mine_is_part) for place in round_on_flat(mine, theirs, gap)]
        found += [tangents.at_round(place, mine_is_part, sharp=True) for place in sharp_on_round(mine, theirs, gap)]
    return [touch for touch in found if touch is not None]


def _along(tangents: Tangents, mine: np.ndarray, theirs: np.ndarray) -> list[Touch]:
    """Both ends of a segment on which two edges run along each other; with alternatives, as twins."""
    middle = tangents.touch(mine.mean(axis=0), theirs.mean(axis=0))
    if middle is None:
        return []
    return [
        replace(
            middle,
            point=mine[end],
            other=theirs[end],
            clauses=(clause,),
            twin=mine[1 - end] if len(clause) > 1 else None,
        )
        for clause in middle.clauses
        for end in (0, 1)
    ]


def _distinct(points: np.ndarray, others: np.ndarray, blur: float) -> Sequence[tuple[np.ndarray, np.ndarray]]:
    """Pairs of points, those that are one within the blur only once."""
    if not len(points):
        return []
    _, first = np.unique(np.round(np.hstack([points, others]) / blur), axis=0, return_index=True)
    return [(points[index], others[index]) for index in np.sort(first)]


def _check_room(body: Body, part: Part, mine: Features, theirs: Features, gap: float) -> None:
    found = deepest(mine, theirs, gap)
    if found is None:
        return
    inside, outside = (mine, theirs) if found.of == 0 else (theirs, mine)
    names = (part.name, body.name) if found.of == 0 else (body.name, part.name)
    place = part.pose.points(found.point[None])[0]
    raise PenetrationError(
        body.name,
        found.depth,
        place.tolist(),
        f"{nearest_feature(inside.geometry, found.point)} of {names[0]!r}",
        f"{nearest_feature(outside.geometry, found.point)} of {names[1]!r}",
        gap,
    )


def nearest_feature(geometry: PartGeometry, point: np.ndarray) -> str:
    """The name of the facet, edge or apex of the surface that is nearest to a point."""
    _, nearest = geometry.surface.at(point)
    return feature_name(geometry, facets_at(geometry, touched_triangles(geometry, nearest, geometry.on_edge)))


def _named(body: Body, X_WP: Pose, touches: Sequence[Touch], friction: float) -> tuple[Contact, ...]:
    """The contacts in W, named in the order of their coordinates, twins linked by name."""
    points = X_WP.points(np.array([touch.point for touch in touches]))
    order = np.lexsort(np.round(points, 9).T[::-1]).tolist()
    names = {index: f"{body.name}#{number}" for number, index in enumerate(order, start=1)}
    return tuple(
        Contact(
            names[index],
            body.role,
            points[index],
            tuple(tuple(X_WP.vectors(np.array(clause))) for clause in touches[index].clauses),
            friction if body.friction is None else body.friction,
            touches[index].provenance,
            touches[index].distance,
            f"{touches[index].features[0]} on {touches[index].features[1]} of {body.name}",
            linked=_twin_name(touches, index, names),
            slips=tuple(moved_with(X_WP, slips) for slips in touches[index].slips),
        )
        for index in order
    )


def _twin_name(touches: Sequence[Touch], index: int, names: dict[int, str]) -> str | None:
    """The name of the other end of a segment: the touch whose point and twin are this one's, exchanged."""
    twin = touches[index].twin
    if twin is None:
        return None
    for other, touch in enumerate(touches):
        same = (
            touch.twin is not None
            and np.array_equal(touch.point, twin)
            and np.array_equal(touch.twin, touches[index].point)
        )
        if same and matching(touch.clauses[0], touches[index].clauses[0], COPLANAR_ANGLE):
            return names[other]
    raise AssertionError("an end of a segment without the other one")
