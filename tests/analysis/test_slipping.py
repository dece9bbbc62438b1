"""Motions that all touched surfaces share: found within the errors of the fits, and only then; forged ones are seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from fixture_design.analysis import Restraint, deterministic, form_closure
from fixture_design.contacts import Contact, Provenance, scale_of
from fixture_design.layout import Answer, Group, Motion
from fixture_design.verification.checker import check_group
from fixture_design.verification.verify import group_verdict


def on_shaft(angle: float, height: float, axis_off: float, error: float) -> Contact:
    """A contact on a shaft around z through (axis_off, 0, 0), with what is known of how the shaft slips."""
    normal = np.array([np.cos(angle), np.sin(angle), 0.0])
    axis = np.array([0.0, 0.0, 1.0])
    center = np.array([axis_off, 0.0, 0.0])
    slips = np.vstack([np.concatenate([np.cross(center, axis), axis]), np.concatenate([axis, np.zeros(3)])])
    point = center + 0.01 * normal + height * axis
    return Contact(
        f"C{angle:.3f}_{height:.3f}",
        "locator",
        point,
        ((normal,),),
        provenance=Provenance("fitted", error),
        feature=f"cylinder {1 + (height > 0.02)}",
        slips=(slips,),
    )


def shaft(axis_off: float, error: float) -> list[Contact]:
    """Twelve contacts on two diameters whose axes were fitted ``axis_off`` apart."""
    return [on_shaft(0.5 + 0.9 * k, 0.003 * k, axis_off if k > 6 else 0.0, error) for k in range(12)]


def test_axes_within_the_error_are_one() -> None:
    restraint = Restraint.of(shaft(1e-9, 1e-6))
    closure, located = form_closure(restraint), deterministic(restraint)
    assert (closure.answer, located.answer) == (Answer.NO, Answer.NO)
    assert isinstance(closure.evidence, Motion)
    assert closure.evidence.rule is not None
    assert closure.evidence.rule.name == "common slip"
    assert closure.margin is not None
    assert closure.margin <= 0
    verdict = group_verdict(Group("all", restraint.contacts, ()), restraint.report, [], restraint.tolerances)
    assert check_group(verdict, restraint.contacts) == []


@pytest.mark.parametrize(("axis_off", "error"), [(1e-4, 1e-6), (1e-9, 1e-3)])
def test_axes_that_differ_are_two_and_vague_normals_show_nothing(axis_off: float, error: float) -> None:
    finding = form_closure(Restraint.of(shaft(axis_off, error)))
    rule = finding.evidence.rule if isinstance(finding.evidence, Motion) else None
    assert rule is None


def test_contacts_that_know_no_slips_are_not_slipped() -> None:
    contacts = shaft(0.0, 1e-6)
    assert Restraint.of([*contacts[1:], replace(contacts[0], slips=())]).slip is None


@pytest.mark.parametrize(
    "forge",
    [
        lambda c: replace(c, slips=()),
        lambda c: replace(c, slips=(np.zeros((1, 6)),)),
        lambda c: replace(c, slips=(np.eye(6),)),
        lambda c: replace(c, slips=(c.slips[0][1:],)),
        lambda c: replace(c, provenance=Provenance("fitted", 1e-3)),
        lambda c: replace(c, clauses=((np.array([0.0, 0.0, 1.0]),),)),
    ],
    ids=["unknown", "none", "everything", "along the axis only", "vague", "another normal"],
)
def test_forged_slips_are_refused(forge: Callable[[Contact], Contact]) -> None:
    restraint = Restraint.of(shaft(1e-9, 1e-6))
    verdict = group_verdict(Group("all", restraint.contacts, ()), restraint.report, [], restraint.tolerances)
    found = verdict.findings["form_closure"]
    assert isinstance(found.evidence, Motion)
    spin = replace(found, evidence=replace(found.evidence, motion=np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])))
    closure = replace(verdict, findings={"form_closure": spin})
    assert check_group(closure, restraint.contacts) == []
    assert check_group(closure, [forge(restraint.contacts[0]), *restraint.contacts[1:]]) != []


def test_a_motion_that_is_no_slip_is_refused() -> None:
    restraint = Restraint.of(shaft(1e-9, 1e-6))
    verdict = group_verdict(Group("all", restraint.contacts, ()), restraint.report, [], restraint.tolerances)
    found = verdict.findings["form_closure"]
    assert isinstance(found.evidence, Motion)
    for motion in (np.array([1.0, 0, 0, 0, 0, 0]), np.array([0, 0, 0, 0, 1.0, 0]), np.zeros(6), np.zeros(3)):
        forged = replace(found, evidence=replace(found.evidence, motion=motion))
        assert check_group(replace(verdict, findings={"form_closure": forged}), restraint.contacts) != []


def tilted_prism(tilt: float, error: float) -> list[Contact]:
    """32 contacts on the four long sides of a prism along x, eight a side, half of them tilted towards each end."""
    contacts = []
    for base in np.vstack([np.eye(3)[1:], -np.eye(3)[1:]]):
        across = np.cross([1.0, 0.0, 0.0], base)
        for sense, along, aside in product((1, -1), (1, -1), (0.8, -0.8)):
            point, normal = base + along * np.eye(3)[0] + aside * across, base + sense * tilt * np.eye(3)[0]
            plane = np.linalg.svd(normal[None])[2][1:]
            slips = np.vstack([np.hstack([plane, np.zeros((2, 3))]), np.concatenate([np.cross(point, normal), normal])])
            provenance = Provenance("fitted", error)
            name = f"C{len(contacts)}"
            contacts.append(Contact(name, "locator", point, ((normal,),), provenance=provenance, slips=(slips,)))
    return contacts


def test_surfaces_that_cannot_share_a_motion_do_not() -> None:
    """Tilted by more than their errors, they close whatever the errors are: never answered by a slide."""
    restraint = Restraint.of(tilted_prism(tilt=2e-5, error=1e-5))
    assert restraint.slip is None
    assert form_closure(restraint).answer is not Answer.NO
    assert deterministic(restraint).answer is Answer.YES
    far = Restraint.of(tilted_prism(tilt=4e-4, error=1e-5))
    assert form_closure(far).answer is Answer.YES


def test_surfaces_that_may_share_a_motion_do() -> None:
    restraint = Restraint.of(tilted_prism(tilt=5e-6, error=1e-5))
    assert form_closure(restraint).answer is deterministic(restraint).answer is Answer.NO
    assert restraint.slip is not None
    np.testing.assert_allclose(np.abs(restraint.slip), np.eye(6)[0], atol=1e-5)


@pytest.mark.parametrize(("part", "shared"), [(0.5, False), (0.9, True)])
def test_the_worst_surface_counts(part: float, shared: bool) -> None:
    """Nine axes agree and one is 2e-8 m off: one line is within 9e-9 m of all, though not the one best on average."""
    contacts = [on_shaft(0.5 + 0.9 * k, 0.003 * k, -1e-8 if k else 1e-8, 0.0) for k in range(10)]
    spins = [replace(contact, slips=(contact.slips[0][:1],)) for contact in contacts]
    provenance = Provenance("fitted", part * 1e-8 / scale_of(spins).length)
    restraint = Restraint.of([replace(contact, provenance=provenance) for contact in spins])
    assert (restraint.slip is not None) is shared


def pinned_plate(error: float) -> list[Contact]:
    """A plate on three rests, with two pins in bores whose fitted axes are off z by ``error``."""
    contacts = []
    for k, (x, y) in enumerate([(0.0, 0.0), (0.1, 0.0), (0.0, 0.08)]):
        point, up = np.array([x, y, 0.0]), np.array([0.0, 0.0, -1.0])
        contacts.append(Contact(f"R{k}", "locator", point, ((up,),), feature="facet 1"))
    tilt = np.array([error / 3, -error / 2, 1.0])
    for k, (x, y) in enumerate([(0.02, 0.03), (0.08, 0.05)]):
        centre = np.array([x, y, 0.01])
        slips = np.vstack([np.concatenate([np.cross(centre, tilt), tilt]), np.concatenate([tilt, np.zeros(3)])])
        for turn, angle in enumerate(np.arange(4) * np.pi / 2 + 0.3 + k):
            normal = np.array([np.cos(angle), np.sin(angle), error / 2])
            contacts.append(
                Contact(
                    f"P{k}#{turn}",
                    "locator",
                    centre - 0.004 * normal,
                    ((normal,),),
                    provenance=Provenance("fitted", error),
                    feature=f"cylinder {k}",
                    slips=(slips,),
                )
            )
    return contacts


def test_a_plate_lifts_off_its_rests_along_its_pins() -> None:
    """Undecided by the normals alone: opposed normals in a bore are tied only up to what the fit is off."""
    restraint = Restraint.of(pinned_plate(1e-6))
    finding = form_closure(restraint)
    assert finding.answer is Answer.NO
    assert isinstance(finding.evidence, Motion)
    assert finding.evidence.rule is not None
    assert finding.evidence.rule.name == "slip or leave"
    np.testing.assert_allclose(finding.evidence.motion / finding.evidence.motion[2], [0, 0, 1, 0, 0, 0], atol=1e-5)
    verdict = group_verdict(Group("all", restraint.contacts, ()), restraint.report, [], restraint.tolerances)
    assert check_group(verdict, restraint.contacts) == []


def test_a_clamp_on_the_plate_keeps_it_from_lifting() -> None:
    clamp = Contact("K", "clamp", np.array([0.05, 0.04, 0.02]), ((np.array([0.0, 0.0, 1.0]),),), feature="facet 2")
    finding = form_closure(Restraint.of([*pinned_plate(1e-6), clamp]))
    assert not isinstance(finding.evidence, Motion)


def test_a_motion_that_leaves_too_little_is_refused() -> None:
    """Leaving counts only beyond what the slips may be off; and what neither slips nor leaves is named."""
    restraint = Restraint.of(pinned_plate(1e-6))
    verdict = group_verdict(Group("all", restraint.contacts, ()), restraint.report, [], restraint.tolerances)
    found = verdict.findings["form_closure"]
    assert isinstance(found.evidence, Motion)
    for motion in ([0, 0, -1.0, 0, 0, 0], [1.0, 0, 1.0, 0, 0, 0], [0, 0, 1e-7, 1.0, 0, 0]):
        forged = replace(found, evidence=replace(found.evidence, motion=np.array(motion)))
        assert check_group(replace(verdict, findings={"form_closure": forged}), restraint.contacts) != []
    vague = [replace(contact, slips=()) for contact in restraint.contacts]
    assert check_group(replace(verdict, findings={"form_closure": found}), vague) != []
