"""The one pipeline: layout -> contacts -> groups -> verdicts.

Geometry is asked only for layouts that have elements or bodies; a layout of contacts alone loads neither Drake nor
trimesh nor scipy.optimize.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from fixture_design.analysis import (
    Restraint,
    accessible,
    admissible_displacements,
    admissible_forces,
    bidirectional_contacts,
    deterministic,
    displacements_in_world,
    force_closure,
    forces_in_world,
    form_closure,
    strongly_accessible,
)
from fixture_design.cones.kernel import NAME as KERNEL
from fixture_design.contacts import Contact, Scale, scale_of, unit_normal
from fixture_design.errors import ConeError, ContactError, FileFormatError
from fixture_design.layout import (
    Answer,
    Finding,
    Group,
    GroupVerdict,
    Layout,
    RequirementVerdict,
    Verdict,
    groups_of,
)
from fixture_design.tolerances import DEFAULT, Tolerances
from fixture_design.verification.checker import sum_up
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.linked import bracketed
from fixture_design.verification.use import with_use
from fixture_design.verification.weight import weight_notes
from fixture_design.version import VERSION

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry, Polygon

#: The questions this version answers about every group, in the order they are reported.
QUESTIONS = {
    "deterministic": deterministic,
    "accessible": accessible,
    "strongly_accessible": strongly_accessible,
    "form_closure": form_closure,
    "force_closure": force_closure,
}

#: Names in one note before it says "and so many more".
_NAMES_SHOWN = 5


@runtime_checkable
class GroupJudge(Protocol):
    """How one group is judged: `group_verdict`, or something that remembers what it said."""

    def __call__(
        self, group: Group, report: Scale, notes: list[str], tolerances: Tolerances, sets: bool
    ) -> GroupVerdict: ...


def verify(
    layout: Layout,
    tolerances: Tolerances = DEFAULT,
    found: FoundContacts | None = None,
    sets: bool = True,
    judge: GroupJudge | None = None,
) -> Verdict:
    """Contacts, findings and requirements of a layout.

    Args:
        found: the layout's contacts, where they are known already (`contacts_of`).
        sets: whether the admissible sets are wanted, which no answer needs.
        judge: in place of `group_verdict`.

    Raises:
        InputError: the layout has no contacts at all, its geometry cannot be used, or an element is off the surface.
    """
    found = found or contacts_of(layout)
    notes = list(found.notes) + coincident_notes(found.contacts, found.report)
    groups = groups_of(layout, found.contacts)
    verdicts = group_verdicts(groups, found.report, notes, tolerances, sets, judge)
    verdicts = {group.name: with_use(verdicts[group.name], layout, group, found, tolerances) for group in groups}
    notes += [*weight_notes(layout, groups, found), *_preload_notes(layout)]
    requirements = tuple(_requirement_verdicts(groups, verdicts, notes))
    return Verdict(
        name=layout.name,
        source=None if layout.source is None else str(layout.source),
        space=layout.space,
        satisfied=sum_up([requirement.answer for requirement in requirements]),
        groups=verdicts,
        contacts=found.contacts,
        requirements=requirements,
        notes=tuple(notes),
        reference=found.report.reference,
        length=found.report.length,
        run={"version": VERSION, "kernel": KERNEL, "tolerances": tolerances.as_dict()},
    )


def contacts_of(layout: Layout, geometry: PartGeometry | Polygon | None = None) -> FoundContacts:
    """Every contact of a layout: those of its elements in file order, of its bodies, then those given outright.

    Args:
        geometry: of the layout's part, where it is loaded already.

    Raises:
        ContactError: there are none.  FileFormatError: the part's file is not there.  GeometryError and
            others: from the geometry.
    """
    if not (layout.elements or layout.bodies):
        if not layout.contacts:
            problem = "the layout has no contacts: give `elements`, `bodies` or `contacts`"
            raise ContactError(problem, source=layout.source)
        _check_part_file(layout)
        return FoundContacts(layout.contacts, scale_of(layout.contacts), ())
    from fixture_design.geometry import contacts_of_elements  # noqa: PLC0415 - Drake only where there is geometry

    found = contacts_of_elements(layout, geometry)
    contacts = (*found.contacts, *layout.contacts)
    return FoundContacts(contacts, Scale(found.box_center, found.half_diagonal), found.notes, found.geometry)


def _check_part_file(layout: Layout) -> None:
    """A part that nothing touches is not read, but whoever names its file means one that is there."""
    if layout.part is None or layout.part.file is None:
        return
    from fixture_design.geometry import unreadable  # noqa: PLC0415 - not for layouts without a part

    if problem := unreadable(layout.part.file, f"{layout.part.kind} file"):
        raise FileFormatError(
            f"{problem}: {str(layout.part.file)!r:.200}", source=layout.source, place=layout.places.get(("part",)),
            expected="an existing file",
        )  # fmt: skip


def group_verdicts(
    groups: Sequence[Group],
    report: Scale,
    notes: list[str],
    tolerances: Tolerances,
    sets: bool = True,
    judge: GroupJudge | None = None,
) -> dict[str, GroupVerdict]:
    """The verdict of every group; groups with the same contacts are looked at once."""
    sharing: dict[tuple[str, ...], list[Group]] = {}
    for group in groups:
        sharing.setdefault(tuple(contact.name for contact in group.contacts), []).append(group)
    verdicts: dict[str, GroupVerdict] = {}
    for alike in sharing.values():
        names = [group.name for group in alike]
        joint = replace(alike[0], name=" and ".join(names))
        found = (judge or group_verdict)(joint, report, notes, tolerances, sets)
        verdicts |= {name: replace(found, name=name) for name in names}
    return {group.name: verdicts[group.name] for group in groups}


def group_verdict(
    group: Group, report: Scale, notes: list[str], tolerances: Tolerances, sets: bool = True
) -> GroupVerdict:
    """Every question asked of one group; all answers are None for an empty one."""
    names = tuple(contact.name for contact in group.contacts)
    if not group.contacts:
        return GroupVerdict(group.name, names, {question: Finding(None) for question in QUESTIONS})
    restraint = Restraint.of(group.contacts, report, tolerances)
    findings = {name: question(restraint) for name, question in QUESTIONS.items()}
    if any(contact.linked in names for contact in group.contacts):
        findings = bracketed(findings, group.contacts, report, tolerances, QUESTIONS)
        notes.append(
            f"{group.name}: edges touch along parallel edges; the sets listed are those of their ends, too large"
        )
    unmeasured = [name for name, f in findings.items() if f.margin is None and f.answer is not Answer.UNDECIDED]
    if unmeasured:
        notes.append(f"{group.name}: too many contacts or alternatives for the margin of {', '.join(unmeasured)}")
    if not sets:
        return GroupVerdict(group.name, names, findings)
    try:
        displacements = admissible_displacements(restraint)
        forces = admissible_forces(displacements, tolerances)
    except ConeError as error:
        notes.append(f"{group.name}: the admissible sets are not listed: {error}")
        return GroupVerdict(group.name, names, findings, bidirectional=bidirectional_contacts(restraint))
    if not (forces.certain and all(cone.certain for cone in displacements)):
        notes.append(f"{group.name}: the admissible sets have values in the undecided band; their form may be another")
    scale = restraint.constraints.scale
    return GroupVerdict(
        group.name,
        names,
        findings,
        tuple(displacements_in_world(cone, scale) for cone in displacements),
        forces_in_world(forces, scale),
        bidirectional_contacts(restraint),
    )


def coincident_notes(contacts: Sequence[Contact], report: Scale) -> list[str]:
    """A note for contacts in one point with the same normals: given twice, they add nothing."""
    points = np.array([contact.point for contact in contacts])
    notes, named = [], set[int]()
    for index, contact in enumerate(contacts):
        if index in named:
            continue
        near = np.linalg.norm(points - contact.point, axis=1) <= DEFAULT.tie * report.length
        later = [other for other in np.flatnonzero(near).tolist() if other > index]
        twins = [other for other in later if _same_normals(contact, contacts[other])]
        if twins:
            named.update(twins)
            names = [repr(contacts[other].name) for other in (index, *twins)]
            if len(names) > _NAMES_SHOWN:
                names = [*names[:_NAMES_SHOWN], f"{len(names) - _NAMES_SHOWN} more"]
            notes.append(f"contacts {', '.join(names[:-1])} and {names[-1]} coincide")
    return notes


def _same_normals(first: Contact, second: Contact) -> bool:
    if [len(clause) for clause in first.clauses] != [len(clause) for clause in second.clauses]:
        return False
    pairs = zip(first.normals, second.normals, strict=True)
    return all(np.allclose(unit_normal(a), unit_normal(b), rtol=0, atol=DEFAULT.tie) for a, b in pairs)


def _preload_notes(layout: Layout) -> list[str]:
    """A preload beyond the limits is taken as it is: limits bind design."""
    return [
        f"clamp {e.name}: its preload of {e.preload:g} N is outside of its limits"
        for e in layout.elements
        if e.preload is not None and e.limits is not None and not e.limits[0] <= e.preload <= e.limits[1]
    ]


def _requirement_verdicts(
    groups: Sequence[Group], verdicts: dict[str, GroupVerdict], notes: list[str]
) -> list[RequirementVerdict]:
    found = []
    for group in groups:
        for require in group.require:
            if not group.contacts:
                notes.append(f"{group.name}: {require} is required of a group without contacts: not satisfied")
                found.append(RequirementVerdict(group.name, require, None))
            else:
                found.append(RequirementVerdict(group.name, require, verdicts[group.name].findings[require].answer))
    return found
