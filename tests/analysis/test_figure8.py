"""Section 2.7 from its layout files: every verdict, set and witness that the thesis gives."""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.cones import PolyhedralConvexCone, element, equal, interior, union_element
from fixture_design.cones.union import ConeUnion
from fixture_design.io import read_layout
from fixture_design.layout import Answer, GroupVerdict, Motion
from fixture_design.verification import check, verify
from tests.problems import FIGURE_8_FACE_VECTORS, FIGURE_8_VERDICTS, Figure8Verdict

FIGURE_8 = Path(__file__).resolve().parents[2] / "urdf" / "figure8"
FILES = {
    ("P1", "P2", "P3", "P4"): "p1234",
    ("P1", "P2", "P3", "P4", "P5"): "p12345",
    ("P2", "P3", "P4"): "p234",
    ("P1", "P3", "P4"): "p134_friction",
    ("P1", "P3", "P4", "P5"): "p1345",
}


def group_of(name: str) -> GroupVerdict:
    verdict = verify(read_layout(FIGURE_8 / f"{name}.layout.yaml"))
    assert check(verdict) == []
    return verdict.groups["all"]


def displacements(group: GroupVerdict) -> ConeUnion:
    assert group.admissible_displacements is not None
    return ConeUnion.of(group.admissible_displacements)


@pytest.mark.parametrize("known", FIGURE_8_VERDICTS, ids=lambda known: "-".join(known.contacts) + f"-{known.friction}")
def test_verdicts(known: Figure8Verdict) -> None:
    group = group_of(FILES[known.contacts])
    for claim in ("form_closure", "accessible", "strongly_accessible", "force_closure"):
        expected = getattr(known, claim)
        if expected is not None:
            assert group.findings[claim].answer is Answer.of(expected), claim
    if known.in_a is not None:
        assert union_element(known.in_a, displacements(group))
    if known.in_interior is not None:
        faces = [cone for cone in displacements(group) if element(known.in_interior, cone) and interior(cone)]
        assert any(np.all(cone.faces @ known.in_interior < 0) for cone in faces)
    if known.force_set_faces is not None:
        assert group.admissible_forces is not None
        assert equal(group.admissible_forces, PolyhedralConvexCone.from_faces(known.force_set_faces))


def test_force_set_in_both_forms() -> None:
    """(2-75) and (2-77) are the same cone, and F is it."""
    forces = group_of("p1234").admissible_forces
    assert forces is not None
    d = {name: np.array(vector) for name, vector in FIGURE_8_FACE_VECTORS.items()}
    span_form = PolyhedralConvexCone.from_span([d["d11"], d["d34"], d["d44"], [-1, 0, 0]])  # (2-77)
    face_form = PolyhedralConvexCone.from_faces([[1, 0, 0]])  # (2-75)
    assert equal(span_form, face_form)
    assert equal(forces, span_form)


def test_escape_is_the_one_of_the_thesis() -> None:
    evidence = group_of("p1234").findings["form_closure"].evidence
    assert isinstance(evidence, Motion)
    assert evidence.motion / np.abs(evidence.motion).max() == pytest.approx([1, 0, 0])  # A_1 holds [1, 0, 0]


def test_branches_without_p1_have_interior() -> None:
    group = group_of("p234")
    assert group.findings["strongly_accessible"].answer is Answer.YES
    assert group.findings["strongly_accessible"].margin == pytest.approx(-group.findings["form_closure"].margin)


def test_bidirectional_contacts() -> None:
    """2.8.3, without P1 being removed (slip 10): d11, d34 and d44 constrain both ways, d55 does not."""
    assert group_of("p1345").bidirectional == ("P1", "P3", "P4")


def test_elements_on_the_polygon_give_the_same_contacts() -> None:
    given, found = group_of("p12345"), group_of("polygon_p12345")
    assert {c: f.answer for c, f in given.findings.items()} == {c: f.answer for c, f in found.findings.items()}


@pytest.mark.parametrize("friction", [1e-1, 1e-3, 1e-5, 1e-6])
def test_any_friction_closes_without_p2(friction: float) -> None:
    """'if coefficient mu is positive' (2.7 (c)); below 1e-7 the margin falls into the undecided band."""
    from dataclasses import replace

    layout = read_layout(FIGURE_8 / "p134_friction.layout.yaml")
    contacts = tuple(replace(contact, friction=friction) for contact in layout.contacts)
    finding = verify(replace(layout, contacts=contacts)).groups["all"].findings["force_closure"]
    assert finding.answer is Answer.YES


def test_no_friction_does_not() -> None:
    from dataclasses import replace

    layout = read_layout(FIGURE_8 / "p134_friction.layout.yaml")
    contacts = tuple(replace(contact, friction=0.0) for contact in layout.contacts)
    assert verify(replace(layout, contacts=contacts)).groups["all"].findings["force_closure"].answer is Answer.NO
