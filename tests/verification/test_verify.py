"""The pipeline: groups, stages, requirements, and notes."""

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance
from fixture_design.errors import ContactError, UnknownNameError
from fixture_design.layout import Answer, Layout, Stage
from fixture_design.verification import check, verify
from tests.problems import figure_8

LOCATORS = tuple(figure_8(("P2", "P3", "P4")))
CLAMP = Contact.on_facet("K1", "clamp", [1, 1], [0, 1])
STOP = Contact.on_facet("K2", "clamp", [3, 0], [1, 0])


def layout(**more: object) -> Layout:
    return replace(Layout("test", "planar", contacts=(*LOCATORS, CLAMP, STOP)), **more)


def test_groups_and_their_contacts() -> None:
    verdict = verify(layout(stages=(Stage("seated", ("locator",)), Stage("one clamp", ("locator", "K1")))))
    assert {name: group.contacts for name, group in verdict.groups.items()} == {
        "locators": ("P2", "P3", "P4"),
        "all": ("P2", "P3", "P4", "K1", "K2"),
        "seated": ("P2", "P3", "P4"),
        "one clamp": ("P2", "P3", "P4", "K1"),
    }
    assert verdict.satisfied is None
    assert check(verdict) == []


def test_requirements_are_asked_of_their_group() -> None:
    verdict = verify(layout(require={"locators": ("deterministic", "strongly_accessible"), "all": ("form_closure",)}))
    assert [(r.group, r.require, r.answer) for r in verdict.requirements] == [
        ("locators", "deterministic", Answer.YES),
        ("locators", "strongly_accessible", Answer.YES),
        ("all", "form_closure", Answer.YES),
    ]
    assert verdict.satisfied is Answer.YES


def test_one_requirement_that_fails() -> None:
    verdict = verify(layout(require={"locators": ("form_closure",), "all": ("form_closure",)}))
    assert verdict.satisfied is Answer.NO


def test_what_is_undecided_says_why() -> None:
    verdict = verify(layout(require={"locators": ("seated",)}))
    assert verdict.requirements[0].answer is Answer.UNDECIDED
    assert verdict.satisfied is Answer.UNDECIDED
    assert "nothing presses" in (verdict.groups["locators"].findings["seated"].reason or "")


def test_an_empty_group_has_no_answers_and_satisfies_nothing() -> None:
    contacts = tuple(replace(contact, role="clamp") for contact in LOCATORS)
    verdict = verify(layout(contacts=contacts, require={"locators": ("deterministic",)}))
    findings = verdict.groups["locators"].findings.values()
    assert [finding.answer for finding in findings] == [None] * 5
    assert verdict.groups["locators"].admissible_displacements is None
    assert verdict.satisfied is Answer.NO


def test_no_contacts_at_all() -> None:
    with pytest.raises(ContactError, match="no contacts"):
        verify(Layout("empty"))


def test_a_stage_that_names_nobody() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'locator'"):
        verify(layout(stages=(Stage("s", ("locater",)),)))


def test_coincident_contacts_are_noted() -> None:
    twin = replace(CLAMP, name="K9", clauses=((np.array([0.0, 5.0]),),))
    verdict = verify(layout(contacts=(*LOCATORS, CLAMP, twin)))
    assert any("'K1' and 'K9' coincide" in note for note in verdict.notes)


def test_verdicts_that_flip_within_a_normal_error_are_undecided() -> None:
    """Facet normals on a tessellated round part: the closure they suggest is within their error."""
    angles = 2 * np.pi * (np.arange(8) + 0.5) / 8
    tilt = 0.05 * (-1.0) ** np.arange(8)
    normals = np.column_stack([np.cos(angles + tilt), np.sin(angles + tilt)])
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    exact = [Contact.on_facet(f"C{i}", "locator", p, n) for i, (p, n) in enumerate(zip(points, normals, strict=True))]
    rough = tuple(replace(contact, provenance=Provenance("approximate", 0.1)) for contact in exact)
    assert (
        verify(Layout("facets", "planar", contacts=tuple(exact))).groups["all"].findings["form_closure"].answer == "yes"
    )
    verdict = verify(Layout("facets", "planar", contacts=rough))
    assert verdict.groups["all"].findings["form_closure"].answer is Answer.UNDECIDED
    assert verdict.groups["all"].findings["accessible"].answer is Answer.UNDECIDED
    assert check(verdict) == []


def test_unions_too_large_to_list_are_still_decided() -> None:
    """Ten apices: 1024 cones, and one motion or a few weights settle them."""
    apices = [Contact.of(f"A{i}", "locator", [-2 - i, 0], [[[-1, 1], [-1, -1]]]) for i in range(10)]
    verdict = verify(layout(contacts=(*LOCATORS, CLAMP, STOP, *apices)))
    assert verdict.groups["all"].findings["form_closure"].answer is Answer.YES
    assert verdict.groups["all"].admissible_displacements is None
    assert check(verdict) == []
