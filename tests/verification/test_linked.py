"""Convex edges along parallel convex edges: answers that hold for both brackets, and those that do not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fixture_design.contacts import Contact, Scale
from fixture_design.layout import Answer, Group, GroupVerdict, Motion
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.checker import check_group
from fixture_design.verification.proofs import Case, motion_fault
from fixture_design.verification.verify import group_verdict

SCALE = Scale(np.zeros(3), 1.0)
X, Y, Z = np.eye(3)


def segment(slope: float = 1.0) -> list[Contact]:
    """An edge of the part along y, from -1 to 1, on a ridge below it."""
    clause = ((X - slope * Z, -X - slope * Z),)
    ends = {"e#1": -Y, "e#2": Y}
    names = list(ends)
    return [
        Contact(name, "locator", point, clause, linked=names[1 - k]) for k, (name, point) in enumerate(ends.items())
    ]


def verdict_of(contacts: Sequence[Contact]) -> GroupVerdict:
    notes: list[str] = []
    verdict = group_verdict(Group("all", tuple(contacts), ()), SCALE, notes, DEFAULT)
    assert check_group(verdict, contacts) == []
    assert any("parallel edges" in note for note in notes)
    return verdict


def facet(name: str, point: np.ndarray, normal: np.ndarray) -> Contact:
    return Contact.on_facet(name, "locator", point, normal)


def all_but_turning_and_sinking() -> list[Contact]:
    """Holds x and y at the origin, roll and pitch and rising; leaves turning about z, and -z to the ridge."""
    sides = [facet(f"{n}{s}", 0 * X, s * axis) for n, axis in (("x", X), ("y", Y)) for s in (-1.0, 1.0)]
    tops = [facet(f"t{k}", p, Z) for k, p in enumerate((X + Y, -X + Y, -Y))]
    return [*sides, *tops]


def test_turning_on_a_ridge_is_undecided() -> None:
    """At each end another face is left, so the ends alone let the part turn and sink; its middle would enter."""
    verdict = verdict_of([*segment(), *all_but_turning_and_sinking()])
    closure = verdict.findings["form_closure"]
    assert closure.answer is Answer.UNDECIDED
    assert "convex edges" in (closure.reason or "")
    assert verdict.findings["accessible"].answer is Answer.UNDECIDED


def test_what_holds_for_the_ends_alone_holds() -> None:
    stops = [facet("s-", X, -Y), facet("s+", X, Y)]
    verdict = verdict_of([*segment(), *all_but_turning_and_sinking(), *stops])
    assert verdict.findings["form_closure"].answer is Answer.YES
    assert verdict.findings["accessible"].answer is Answer.NO


def test_a_motion_that_leaves_both_ends_by_one_face_is_a_motion() -> None:
    verdict = verdict_of(segment())
    assert verdict.findings["strongly_accessible"].answer is Answer.YES
    assert verdict.findings["form_closure"].answer is Answer.NO
    assert verdict.findings["deterministic"].answer is Answer.NO


def test_unlinked_ends_are_taken_as_they_stand() -> None:
    contacts = [Contact(c.name, c.role, c.point, c.clauses) for c in segment()]
    verdict = group_verdict(Group("all", (*contacts, *all_but_turning_and_sinking()), ()), SCALE, [], DEFAULT)
    assert verdict.findings["form_closure"].answer is Answer.NO


def test_ends_with_one_feature_are_two_contacts_to_the_checker() -> None:
    named = [replace(contact, feature="edge on edge") for contact in segment()]
    assert verdict_of(named).findings["form_closure"].answer is Answer.NO


def test_ends_with_other_alternatives_leave_the_answer_open() -> None:
    first, second = segment()
    differing = [first, replace(second, clauses=((X - 2 * Z, -X - 2 * Z),))]
    finding = verdict_of([*differing, *all_but_turning_and_sinking()]).findings["form_closure"]
    assert finding.answer is Answer.UNDECIDED
    assert "different alternatives" in (finding.reason or "")


def test_many_segments_still_have_their_first_choices() -> None:
    """Seven ridges have 128 choices; the part lifts off by any of them."""
    many = [
        replace(end, name=f"{k}{end.name}", linked=f"{k}{end.linked}", point=end.point + k * X)
        for k in range(7)
        for end in segment()
    ]
    assert verdict_of(many).findings["strongly_accessible"].answer is Answer.YES


def test_a_motion_that_leaves_the_ends_by_different_faces_is_no_proof() -> None:
    turning = Motion(np.array([0, 0, -0.1, 0, 0, 1.0]), 0.0)
    unlinked = [replace(contact, linked=None) for contact in segment()]
    assert motion_fault(turning, Case(unlinked, 6), strict=False, friction=False) is None
    assert motion_fault(turning, Case(segment(), 6), strict=False, friction=False) is not None
