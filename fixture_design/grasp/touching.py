"""What a hand in a place touches: the layout that its fingers make of the part.

Fingertips that are within the gap of the surface are elements of role `finger`: pads as patches where they lie flat, as
lines on cylinders; balls and points as they are, or with the patch of a soft skin. All other links that touch give the
contacts that rigid bodies have. Everything from there on is as for any layout.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.contacts import Contact, unit_normal
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry import PartGeometry
from fixture_design.geometry.bodies import moved_geometry, touches_between
from fixture_design.geometry.contact import contacts_on
from fixture_design.geometry.features import Features, features_of
from fixture_design.geometry.separation import Separation, Solid, separation
from fixture_design.geometry.surface import SolidSurface
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.link_geometry import Ball, LinkGeometry
from fixture_design.grasp.posture import Posture
from fixture_design.layout import Element, Layout, LineTip, PadTip, Part, PointTip, Pose, SoftTip, SphereTip, Tip
from fixture_design.tolerances import FINGER_GAP, FLAT_ENOUGH, NEARLY_ACROSS


@dataclass(frozen=True, eq=False)
class Touching:
    """What a hand does to the part where it is.

    Attributes:
        layout: the part with an element for each fingertip that touches, and the contacts of other links; requires
            force closure.
        links: by element or contact, the link that it belongs to.
        overlaps: by link or fingertip, how deep it is in the part [m]; empty where nothing is deeper than the gap.
        notes: for people.
    """

    layout: Layout
    links: Mapping[str, str]
    overlaps: Mapping[str, float]
    notes: tuple[str, ...]


def touching(posture: Posture, part: Part, geometry: PartGeometry, gap: float = FINGER_GAP) -> Touching:
    """The layout that a hand in a place makes of the part.

    Args:
        geometry: of the part.
        gap: fingertips and links this near touch, and this deep do not overlap [m].
    """
    surface = SolidSurface(geometry)
    elements: list[Element] = []
    links: dict[str, str] = {}
    overlaps: dict[str, float] = {}
    notes: list[str] = []
    poses = posture.links()
    for tip in posture.model.fingertips:
        distance, element, note = tip_element(tip, poses[tip.link], part, surface, gap)
        notes += [f"fingertip {tip.name!r} {note}"] if note else []
        if distance < -gap:
            overlaps[tip.name] = -distance
        if element is not None:
            elements.append(element)
            links[element.name] = tip.link
    contacts: list[Contact] = []
    of_tips = set(links.values())  # their contacts are the elements, but no more of them may be in the part
    for name, link in posture.model.links.items():
        X_PL = composed(part.pose.inverse(), poses[name])
        found = clearance(link, X_PL, features_of(geometry).solid, gap)
        if found.distance < -gap:
            overlaps[name] = -found.distance
        elif found.distance <= gap and name not in of_tips:
            own, problem = _link_contacts(link, X_PL, part, geometry, posture.model.hand.friction, gap)
            links |= {contact.name: name for contact in own}
            contacts += own
            notes += [] if own else [f"link {name!r} touches in no way that contacts can be made of{problem}"]
    layout = Layout(
        name=f"{posture.model.name} on {part.name}",
        part=part,
        friction=posture.model.hand.friction,
        surface_gap=gap,
        elements=tuple(elements),
        contacts=tuple(contacts),
        require={"all": ("force_closure",)},
    )
    return Touching(layout, links, overlaps, tuple(notes))


def clearance(link: LinkGeometry, X_PL: Pose, part: Solid, gap: float) -> Separation:
    """How far a link is from the part, as far as it is nearer than ``gap`` [m]; else the gap's double."""
    far = 2 * gap
    if not _may_touch(link, X_PL, part, gap):
        return Separation(far, None)
    if link.only_balls:
        return min((_ball_clearance(ball, X_PL, part) for ball in link.balls), key=lambda found: found.distance)
    return separation(link.solid, part, X_PL, limit=far)


def runs_into(link: LinkGeometry, X_PL: Pose, part: Solid, allowed: float) -> bool:
    """Whether a link is deeper in the part than allowed [m]; sooner told than how deep."""
    if not _may_touch(link, X_PL, part, -allowed):
        return False
    if link.only_balls:
        return clearance(link, X_PL, part, allowed).distance < -allowed
    return separation(link.solid, part, X_PL, limit=-allowed, enough=-allowed).point is not None


def _may_touch(link: LinkGeometry, X_PL: Pose, part: Solid, gap: float) -> bool:
    center = X_PL.points(link.around.center[None])
    return bool(part.distances(center)[0] - link.around.radius <= gap)


def _ball_clearance(ball: Ball, X_PL: Pose, part: Solid) -> Separation:
    center = X_PL.points(ball.center[None])
    return Separation(float(part.distances(center)[0]) - ball.radius, center[0])


def tip_element(
    tip: Fingertip, X_WL: Pose, part: Part, surface: SolidSurface, gap: float
) -> tuple[float, Element | None, str | None]:
    """How far a fingertip is from the part [m], the element that it is where it touches, and what is odd about it."""
    at, facing = X_WL.points(tip.at[None])[0], X_WL.vectors(tip.facing[None])[0]
    middle, p_PC = surface.nearest(part.pose.inverse().points(at[None])[0])
    distance = middle - tip.radius
    if abs(distance) > gap:
        return distance, None, None
    normals = part.pose.vectors(np.array([unit_normal(n) for clause in surface.local(p_PC).clauses for n in clause]))
    angle = float(np.arccos(np.clip((-normals @ facing).max(), -1.0, 1.0)))
    allowed = FLAT_ENOUGH if tip.pad is not None else tip.spread
    if angle > allowed:
        return (
            distance,
            None,
            f"looks {np.degrees(angle):.1f} degrees past the surface that it is at, and holds nothing",
        )
    element = Element(tip.name, "finger", read_only(part.pose.points(p_PC[None])[0]), friction=tip.friction)
    problem = None
    for kind in _kinds(tip, X_WL, part, surface, p_PC):
        tried = replace(element, tip=kind)
        try:
            contacts_on(tried, surface, part.pose, 0.0, gap, part.name)
        except (GeometryError, UnsupportedError) as error:
            problem = error.problem
            continue
        return distance, tried, None
    return distance, None, f"cannot touch there: {problem}"


def _kinds(tip: Fingertip, X_WL: Pose, part: Part, surface: SolidSurface, p_PC: Point) -> list[Tip]:
    """What a fingertip may be where it touches, best first."""
    local = surface.local(p_PC)
    point: Tip = PointTip() if tip.ball is None else SphereTip(tip.ball)
    if tip.soft is not None and local.shape == "flat":
        point = SoftTip(tip.soft)
    if tip.pad is None:
        return [point]
    assert tip.along is not None  # pads have one
    along = X_WL.vectors(tip.along[None])[0]
    shape = surface.geometry.surface_of_facet(local.facets[0]) if local.facets else None
    if shape is None:
        return [PadTip(tip.pad[0], tip.pad[1], read_only(along)), point]
    if shape.shape.kind != "cylinder":
        return [point]
    axis = part.pose.vectors(shape.shape.axis[None])[0]
    cosine, sine = abs(axis @ along), float(np.linalg.norm(np.cross(axis, along)))
    length = min(tip.pad[0] / max(cosine, NEARLY_ACROSS), tip.pad[1] / max(sine, NEARLY_ACROSS))
    return [LineTip(length, read_only(axis)), point]


def _link_contacts(
    link: LinkGeometry, X_PL: Pose, part: Part, geometry: PartGeometry, friction: float, gap: float
) -> tuple[list[Contact], str]:
    """The contacts of a link that is no fingertip, as rigid bodies have them, in W; given outright in the layout.

    And where there are none because they are of a kind that nothing here knows, that in words.
    """
    placed = moved_geometry(link.geometry, X_PL)
    try:
        touches = touches_between(features_of(geometry), Features(placed), gap)
    except UnsupportedError as error:
        return [], f": {error.problem}"
    points = part.pose.points(np.array([touch.point for touch in touches]).reshape(-1, 3))
    own = [
        Contact(
            f"{link.name} {number}",
            "finger",
            point,
            tuple(tuple(part.pose.vectors(np.array(clause))) for clause in touch.clauses),
            friction,
        )
        for number, (point, touch) in enumerate(zip(points, touches, strict=True), start=1)
    ]
    return own, ""
