"""From a hand in a place to a grasp: what it runs into, what it touches, whether that closes, and how well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.errors import GeometryError, format_length
from fixture_design.geometry import PartGeometry, mass_of
from fixture_design.geometry.features import features_of
from fixture_design.geometry.surface import SolidSurface
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.friction_use import friction_used, is_tight
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.quality import Quality, quality
from fixture_design.grasp.result import Grasp
from fixture_design.grasp.robustness import PoseError, robust_share
from fixture_design.grasp.spots import feature
from fixture_design.grasp.stops import Travel
from fixture_design.grasp.torques import Drives
from fixture_design.grasp.touching import Touching, runs_into, touching
from fixture_design.grasp.weakest import weakest
from fixture_design.layout import Answer, Layout, Part, element_name
from fixture_design.tolerances import CLOSING_LEFT, FINGER_GAP
from fixture_design.verification import contacts_of, verify
from fixture_design.verification.found import FoundContacts

#: What `obstacle` says of the table.
INTO_TABLE = "the hand runs into the table"


@dataclass(frozen=True, eq=False)
class Site:
    """Where grasps are looked for.

    Attributes:
        surface: of the part's geometry.
        center: centre of mass in W [m].
        table: height of a table in W that the hand must stay above [m]; None without one.
    """

    part: Part
    geometry: PartGeometry
    surface: SolidSurface
    center: Point
    table: float | None = None

    @classmethod
    def of(cls, part: Part, geometry: PartGeometry, table: float | None = None) -> Site:
        # the centre is the same however heavy the part is
        mass = mass_of(part if part.mass is not None else replace(part, mass=1.0), geometry)
        assert mass is not None
        center = mass.center
        return cls(part, geometry, SolidSurface(geometry), part.pose.points(center[None])[0], table)


@dataclass(frozen=True, eq=False)
class Draft:
    """A grasp before its verdict: closed as far as numbers tell."""

    posture: Posture
    touching: Touching
    found: FoundContacts
    features: tuple[str, ...]
    quality: Quality


def obstacle(posture: Posture, site: Site, tips: Sequence[Fingertip]) -> str | None:
    """What a hand runs into: itself, the table, or the part with a link; None if nothing.

    Links of the fingertips that are to touch may do so.
    """
    pair = posture.model.collides_with_itself(posture.q)
    if pair is not None:
        return "the hand runs into itself"
    if site.table is not None and lowest(posture) < site.table - FINGER_GAP:
        return INTO_TABLE
    poses = posture.links()
    X_PW, solid = site.part.pose.inverse(), features_of(site.geometry).solid
    for name, link in posture.model.links.items():
        if runs_into(link, composed(X_PW, poses[name]), solid, FINGER_GAP):
            return "a fingertip is in the part" if name in {tip.link for tip in tips} else f"{name} runs into the part"
    return None


def lowest(posture: Posture) -> float:
    """The height in W of the lowest point of a hand [m]."""
    poses, links = posture.links(), posture.model.links
    return min(float(poses[name].points(link.geometry.vertices)[:, 2].min()) for name, link in links.items())


def drafted(posture: Posture, site: Site, tips: Sequence[Fingertip]) -> Draft | str:
    """The grasp that a hand makes with its fingertips where it is, or why it is none.

    Args:
        tips: those that are to touch; contacts of their links count where a tip itself is no element, of others none.
    """
    found = _with_fingertips(touching(posture, site.part, site.geometry), {tip.link for tip in tips})
    if not (found.layout.elements or found.layout.contacts):
        return found.notes[0] if found.notes else "nothing touches"
    try:
        contacts = contacts_of(found.layout, site.geometry)
    except GeometryError as error:
        return error.problem
    measured = quality(contacts.contacts, contacts.report.reference, contacts.report.length)
    if measured.epsilon == 0:
        few = len(contacts.contacts) == 2 and not any(contact.torsion for contact in contacts.contacts)
        return "two hard points leave a spin about the line between them" if few else "the contacts do not close"
    drives = Drives.of(posture, contacts.contacts, found.links, site.center)
    if not drives.squeezes:
        return f"nothing squeezes: {drives.stopped.in_words(posture.model)}"
    return Draft(posture, found, contacts, _features(found, site), measured)


def _short(posture: Posture, tips: Sequence[Fingertip]) -> Iterator[str]:
    """What there is to say of fingertips that can hardly close any further."""
    for tip in tips:
        left = Travel.of(posture, tip).closing
        if left <= FINGER_GAP:
            yield f"fingertip {tip.name!r} can close no further: its joints are at stops"
        elif left < CLOSING_LEFT:
            yield f"fingertip {tip.name!r} can close by only {format_length(left)} more, then its joints are at stops"


def _with_fingertips(found: Touching, links: Set[str]) -> Touching:
    """What touches, without the links that are no fingertips': near is not held, and a search is for fingertips."""
    contacts = tuple(one for one in found.layout.contacts if found.links[one.name] in links)
    kept = {one.name for one in (*found.layout.elements, *contacts)}
    others = sorted({link for name, link in found.links.items() if name not in kept})
    notes = tuple(f"{link} touches the part too, and is not counted" for link in others)
    return replace(
        found,
        layout=replace(found.layout, contacts=contacts),
        links={name: link for name, link in found.links.items() if name in kept},
        notes=(*found.notes, *notes),
    )


def _features(found: Touching, site: Site) -> tuple[str, ...]:
    """What the fingers touch: one name for each element, and for each link with contacts where their middle is."""
    places = [element.at for element in found.layout.elements]
    for link in dict.fromkeys(found.links[contact.name] for contact in found.layout.contacts):
        own = [contact.point for contact in found.layout.contacts if found.links[contact.name] == link]
        places.append(np.mean(own, axis=0))
    X_PW, names = site.part.pose.inverse(), []
    for place in places:
        facets = site.surface.facets_at(site.surface.foot(X_PW.points(place[None])[0])[1])
        names.append(feature(site.geometry, int(facets[0])))
    return tuple(sorted(names))


def judged(draft: Draft, site: Site, error: PoseError | None, seed: int) -> Grasp:
    """The grasp with its verdict, and how robust it is.

    Args:
        error: of the part's pose; None: robustness is not asked for.
    """
    posture, layout = draft.posture, draft.touching.layout
    verdict = verify(layout, found=draft.found, sets=False)
    tips = _closing_tips(posture, layout, draft.touching.links)
    robust = None if error is None else robust_share(posture, site.part.pose, site.surface, tips, error, seed)
    grasp = Grasp(
        posture, layout, verdict, draft.touching.links, draft.features, draft.quality, site.center, robust,
        notes=(*draft.touching.notes, *_short(posture, tips)),
    )  # fmt: skip
    return replace(grasp, tight=grasp.closed is Answer.YES and is_tight(grasp))


def with_told_robustness(grasp: Grasp, site: Site, error: PoseError, seed: int) -> Grasp:
    """The grasp with its robustness at poses by which it was not chosen."""
    tips = _closing_tips(grasp.posture, grasp.layout, grasp.links)
    posture, X_WP = grasp.posture, site.part.pose
    return replace(grasp, robust=robust_share(posture, X_WP, site.surface, tips, error, seed, told=True))


def _closing_tips(posture: Posture, layout: Layout, links: Mapping[str, str]) -> list[Fingertip]:
    """Fingertips that are elements of a layout, or whose links have contacts there."""
    # a pad that lies on the part in part only is no element: its link has contacts instead
    made = {element_name(one.name) for one in layout.elements} | {one.name for one in layout.contacts}
    touching_links = {links[name] for name in made}
    return [tip for tip in posture.model.fingertips if tip.name in made or tip.link in touching_links]


def with_load(grasp: Grasp, load: Vector | None) -> Grasp:
    """The grasp with what its drives do for a load.

    Args:
        load: a wrench on the part about its centre of mass, shape (6,) [N, N m]; None without one.
    """
    if load is None:
        return grasp
    held = grasp.drives().least_effort(load)
    notes = () if held is not None else ("the drives do not hold the load that was asked for",)
    return replace(grasp, held=held, notes=(*grasp.notes, *notes))


def with_weakest(grasp: Grasp) -> Grasp:
    """The grasp with what its drives hold in the worst direction, and what its squeeze takes where that is much."""
    used = (
        (f"squeezing alone takes {friction_used(grasp):.0%} of the friction: little is left for loads",)
        if grasp.tight
        else ()
    )
    return replace(grasp, weakest=weakest(grasp.drives()), notes=(*grasp.notes, *used))


def better_first(grasps: Sequence[Grasp]) -> list[Grasp]:
    """Closed ones first, then those that leave friction, then by robustness, in steps of a tenth, then by epsilon."""

    def worth(grasp: Grasp) -> tuple[bool, bool, float, float]:
        robust = 0.0 if grasp.robust is None else float(np.round(grasp.robust, 1))
        size = grasp.quality.least_weight if grasp.quality.epsilon is None else grasp.quality.epsilon
        return grasp.closed == "yes", not grasp.tight, robust, size

    return sorted(grasps, key=worth, reverse=True)
