"""Verdicts of layouts moved far away: confirmed by the checker, and their margins moved along."""

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance, Scale
from fixture_design.layout import Answer, Group, Layout, Pose
from fixture_design.tolerances import DEFAULT
from fixture_design.verification import check, verify
from fixture_design.verification.checker import check_group
from fixture_design.verification.verify import group_verdict
from tests.generated import KINDS, GeneratedLayout, generate


def moved(contact: Contact, pose: Pose) -> Contact:
    clauses = tuple(tuple(pose.vectors(n[None, :])[0] for n in clause) for clause in contact.clauses)
    return replace(contact, point=pose.points(contact.point[None, :])[0], clauses=clauses)


def pose_at(distance: float, plane: int, rng: np.random.Generator) -> Pose:
    place = rng.normal(size=plane)
    place *= distance / np.linalg.norm(place)
    return Pose.from_xy_theta(place, rng.normal()) if plane == 2 else Pose.from_xyz_rpy(place, rng.normal(size=3))


@pytest.mark.parametrize("layout", list(generate(len(KINDS), 11)), ids=str)
def test_verdicts_of_moved_layouts_are_confirmed(layout: GeneratedLayout) -> None:
    """One of every kind, at 13, 127 or 10,000 times its size from the origin."""
    away = (13.0, 127.0, 1e4)[layout.number % 3]
    rng = np.random.default_rng(layout.number)
    spread = float(np.ptp([c.point for c in layout.contacts], axis=0).max()) or 1.0
    pose = pose_at(away * spread, len(layout.contacts[0].point), rng)
    for friction in (None, 0.3):
        contacts = [moved(c, pose) for c in layout.contacts]
        contacts = contacts if friction is None else [replace(c, friction=friction) for c in contacts]
        assert check(verify(Layout("moved", layout.space, contacts=tuple(contacts)))) == []


@pytest.mark.parametrize("away", [0.0, 13.0, 127.0])
@pytest.mark.parametrize("seed", range(6))
def test_small_features_of_large_parts_with_normal_errors(seed: int, away: float) -> None:
    """Margins are measured by the part, ten to a thousand times as large as the contacts' spread."""
    rng = np.random.default_rng([seed, int(away)])
    spread, error = 10.0 ** rng.uniform(-4, -2), 10.0 ** rng.uniform(-3, -1.3)
    pose = pose_at(away, 3, rng)
    contacts = []
    for i in range(int(rng.integers(6, 10))):
        normal, point = rng.normal(size=3), 0.05 + spread * rng.normal(size=3)
        contact = Contact.on_facet(f"C{i}", "locator", point, normal, 0.3 * (seed % 2))
        contacts.append(replace(moved(contact, pose), provenance=Provenance("exact", error)))
    report = Scale(pose.points(np.zeros((1, 3)))[0], 0.1)
    verdict = group_verdict(Group("all", tuple(contacts), ()), report, [], DEFAULT)
    assert check_group(verdict, contacts) == []


def fingers() -> list[Contact]:
    """Degenerate for tangents: two opposed pairs, one pair in line with the centroid, and an apex."""
    places = [([1, 0, 0], [1, 0, 0]), ([-1, 0, 0], [-1, 0, 0]), ([0.2, 1, 0.1], [0, 1, 0]), ([0.1, -1, 0], [0, -1, 0])]
    return [Contact.on_facet(f"F{i}", "finger", p, n, 0.2 + 0.1 * i) for i, (p, n) in enumerate(places)]


def scattered(seed: int) -> list[Contact]:
    rng = np.random.default_rng(seed)
    return [
        Contact.on_facet(f"F{i}", "finger", p, p + 0.3 * rng.normal(size=3), 0.4)
        for i, p in enumerate(rng.normal(size=(5, 3)))
    ]


@pytest.mark.parametrize(
    "contacts", [fingers(), scattered(0), scattered(1), scattered(2)], ids=["pairs", "0", "1", "2"]
)
def test_force_closure_and_its_margin_move_with_the_layout(contacts: list[Contact]) -> None:
    before = verify(Layout("here", "spatial", contacts=tuple(contacts))).groups["all"].findings["force_closure"]
    assert before.margin is not None
    rng = np.random.default_rng(5)
    for unit in [1.0, 1e-3, *(8 * [None])]:
        pose = pose_at(rng.uniform(0, 20), 3, rng)
        there = [replace(c, point=c.point * unit) if unit else moved(c, pose) for c in contacts]
        after = verify(Layout("there", "spatial", contacts=tuple(there))).groups["all"].findings["force_closure"]
        assert after.answer is before.answer
        assert after.edges == before.edges
        assert after.margin == pytest.approx(before.margin, rel=1e-9, abs=1e-12)


def test_weights_are_checked_on_the_edges_that_the_verdict_states() -> None:
    verdict = verify(Layout("fingers", "spatial", contacts=tuple(scattered(0) + fingers_named())))
    group = verdict.groups["all"]
    finding = group.findings["force_closure"]
    assert finding.answer is Answer.YES
    assert finding.tangents is not None
    assert check(verdict) == []
    name = next(iter(finding.tangents))
    (tangent,) = finding.tangents[name]
    normal = next(c for c in verdict.contacts if c.name == name).normals[0]
    across = np.cross(normal / np.linalg.norm(normal), tangent)
    for wrong in (
        (-tangent,),
        (2 * tangent,),
        (tangent + 1e-3 * across,),
        (normal,),
        (),
        (np.full(3, np.nan),),
        (across[:2],),
    ):
        forged = replace(finding, tangents={**finding.tangents, name: wrong})
        findings = {**group.findings, "force_closure": forged}
        assert check(replace(verdict, groups={"all": replace(group, findings=findings)})) != [], wrong


def fingers_named() -> list[Contact]:
    return [replace(contact, name=f"G{i}") for i, contact in enumerate(fingers())]
