"""What a hand does where it is: no search, but the same questions.

A grasp is proven closed only if the hand can be there (its links in nothing, itself among them) and its drives hold the
load that was asked for. It is no grasp, by proof, where a link is in the part or the table, or where nothing touches; a
hull in place of a link's own mesh proves nothing, as it is fatter.
"""

from __future__ import annotations

from dataclasses import replace

from fixture_design.arrays import Vector
from fixture_design.errors import GeometryError, format_length
from fixture_design.geometry import PartGeometry
from fixture_design.grasp.judging import Draft, Site, judged, with_load, with_weakest
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.quality import quality
from fixture_design.grasp.result import Grasp, GraspResult
from fixture_design.grasp.robustness import PoseError
from fixture_design.grasp.touching import Touching, touching
from fixture_design.layout import Answer, Part
from fixture_design.tolerances import FINGER_GAP
from fixture_design.verification import contacts_of


def grasp_at(posture: Posture, part: Part, geometry: PartGeometry, load: Vector | None = None) -> Grasp:
    """The grasp that a hand makes at given joint positions and pose, whatever it is worth.

    What overlaps is said in its notes; `posed` answers whether it is a grasp at all.

    Raises:
        ContactError: nothing touches.
    """
    return _grasp(posture, Site.of(part, geometry), touching(posture, part, geometry), load)


def posed(
    posture: Posture, part: Part, geometry: PartGeometry, load: Vector | None = None, table: float | None = None
) -> GraspResult:
    """Whether a hand where it is has a grasp of the part.

    Args:
        load: wrench on the part about its centre of mass that the drives are to hold, shape (6,) [N, N m].
        table: height in W of a table that the hand is to be above [m]; None without one.

    Returns:
        Yes: it is closed, by proof, in nothing's way, and holds the load. No: a link is in the part or the table,
        nothing touches, or the contacts do not close. Undecided: all else; the reason says what.
    """
    found, notes = touching(posture, part, geometry), (*posture.model.notes, *geometry.notes)
    proven, doubted = _in_the_way(posture, found, table)
    if not (found.layout.elements or found.layout.contacts):
        reason = "; ".join([*proven, *doubted, *found.notes]) or "nothing touches the part"
        sure = proven or not (doubted or found.notes or _hulls(posture))
        return GraspResult(Answer.NO if sure else Answer.UNDECIDED, (), reason=reason, notes=notes)
    try:
        grasp = _grasp(posture, Site.of(part, geometry, table), found, load)
    except GeometryError as error:
        return GraspResult(Answer.NO if proven else Answer.UNDECIDED, (), reason=error.problem, notes=notes)
    if proven:
        return GraspResult(Answer.NO, (grasp,), reason="; ".join(proven), notes=notes)
    doubts = [*doubted, *_doubts(grasp, found, load)]
    answer = Answer.UNDECIDED if doubts else grasp.closed
    return GraspResult(answer, (grasp,), reason="; ".join(doubts) or None, notes=notes)


def _grasp(posture: Posture, site: Site, found: Touching, load: Vector | None) -> Grasp:
    contacts = contacts_of(found.layout, site.geometry)
    measured = quality(contacts.contacts, contacts.report.reference, contacts.report.length)
    inside = tuple(_inside(name, depth) for name, depth in found.overlaps.items())
    draft = Draft(posture, replace(found, notes=(*found.notes, *inside)), contacts, (), measured)
    return with_weakest(with_load(judged(draft, site, PoseError(), 0), load))


def _inside(name: str, depth: float) -> str:
    return f"{name} is {format_length(depth)} inside the part"


def _hulls(posture: Posture) -> set[str]:
    """Links that are not known as they are: hulls of meshes, shapes left out."""
    return {name for name, link in posture.model.links.items() if link.notes}


def _in_the_way(posture: Posture, found: Touching, table: float | None) -> tuple[list[str], list[str]]:
    """What keeps the hand from being there, by proof; and what may."""
    proven, doubted, hulls = [], [], _hulls(posture)
    of_tip = {tip.name: tip.link for tip in posture.model.fingertips}
    for name, depth in found.overlaps.items():
        (doubted if of_tip.get(name, name) in hulls else proven).append(_inside(name, depth))
    if table is not None:
        poses = posture.links()
        for name, link in posture.model.links.items():
            depth = table - float(poses[name].points(link.geometry.vertices)[:, 2].min())
            if depth > FINGER_GAP:
                (doubted if name in hulls else proven).append(f"{name} is {format_length(depth)} inside the table")
    if pair := posture.model.collides_with_itself(posture.q):
        doubted.append(f"{pair[0]} and {pair[1]} seem to be in each other, by the hulls of their shapes")
    return proven, doubted


def _doubts(grasp: Grasp, found: Touching, load: Vector | None) -> list[str]:
    """Why a grasp that nothing is in the way of is neither proven nor disproven."""
    if grasp.closed is Answer.NO:
        # what touches but made no contact might close it
        return list(found.notes)
    if grasp.closed is Answer.UNDECIDED:
        return [grasp.doubt or "its verdict is undecided"]
    drives = grasp.drives()
    if not drives.squeezes:
        return [f"the contacts close, but nothing squeezes: {drives.stopped.in_words(grasp.posture.model)}"]
    return ["the drives do not hold the load that was asked for"] if load is not None and grasp.held is None else []
