"""Answers that are certain whatever the normals are, their evidence, and who is blamed for the others."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance
from fixture_design.layout import Answer, Counted, Finding, Layout, Motion, Rule, Singular, Verdict
from fixture_design.verification import check, verify

X, Y, Z = np.eye(3)


def on_facet(name: str, point: object, normal: object, feature: str, error: float = 1e-3) -> Contact:
    contact = Contact.on_facet(name, "locator", np.array(point, dtype=float), np.array(normal, dtype=float))
    return replace(contact, feature=feature, provenance=Provenance("exact", error))


def verdict_of(*contacts: Contact) -> Verdict:
    space = "planar" if contacts[0].dimension == 3 else "spatial"
    return verify(Layout("counted", space, contacts=contacts))


def finding(verdict: Verdict, claim: str) -> Finding:
    return verdict.groups["all"].findings[claim]


def pads(count: int, normal: object = -Z, feature: str = "facet 1") -> list[Contact]:
    corners = [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0], [0, 2, 0], [2, 0.5, 0], [0.3, 0.1, 0]]
    return [on_facet(f"{feature} {i}", corners[i], normal, feature) for i in range(count)]


def box_sides(count: int) -> list[Contact]:
    """Two contacts on each of some facets of a box, that turn every way: rows enough, normals too few."""
    facets = [(X, Y), (Y, Z), (Z, X)][:count]
    return [
        on_facet(f"S{i}{k}", n + (0.5 - k) * side, n, f"facet {i}")
        for i, (n, side) in enumerate(facets)
        for k in (0, 1)
    ]


@pytest.mark.parametrize("count", [3, 4, 7])
def test_pads_on_one_facet_never_locate(count: int) -> None:
    verdict = verdict_of(*pads(count))
    for claim, answer in (("deterministic", "no"), ("form_closure", "no"), ("accessible", "yes")):
        assert finding(verdict, claim).answer == answer
    evidence = finding(verdict, "deterministic").evidence
    assert isinstance(evidence, Singular)
    assert evidence.rule is not None
    assert [block.count for block in evidence.rule.counted] == [3]
    assert check(verdict) == []


def test_pads_on_a_line_count_two() -> None:
    """Three on a facet, a line of three on another: 3 + 2 rows at most."""
    line = [on_facet(f"B{i}", [5, i - 1, 3], [1, 0, 0], "facet 2") for i in range(3)]
    verdict = verdict_of(*pads(3), *line)
    evidence = finding(verdict, "deterministic").evidence
    assert isinstance(evidence, Singular)
    assert evidence.rule is not None
    assert [block.count for block in evidence.rule.counted] == [3, 2]
    assert check(verdict) == []


def test_few_rows_on_rough_surfaces_do_not_close() -> None:
    rng = np.random.default_rng(1)
    rough = [
        replace(Contact.on_facet(f"R{i}", "locator", p, p), provenance=Provenance("approximate", 0.4))
        for i, p in enumerate(rng.normal(size=(6, 3)))
    ]
    verdict = verdict_of(*rough)
    assert [finding(verdict, claim).answer for claim in ("form_closure", "accessible", "force_closure")] == [
        "no",
        "yes",
        "no",
    ]
    assert check(verdict) == []


def test_three_facets_do_not_close() -> None:
    contacts = [*box_sides(3), *(on_facet(f"T{i}", X + np.array([0, 0.3, i - 0.5]), X, "facet 0", 0.6) for i in (0, 1))]
    contacts = [replace(c, provenance=Provenance("exact", 0.6)) for c in contacts]
    verdict = verdict_of(*contacts)
    evidence = finding(verdict, "form_closure").evidence
    assert finding(verdict, "form_closure").answer is Answer.NO
    assert isinstance(evidence, Motion)
    assert evidence.rule is not None
    assert evidence.rule.name == "few normals"
    assert [block.count for block in evidence.rule.counted] == [1, 1, 1]
    assert check(verdict) == []


def test_contacts_in_one_line_let_it_spin_whatever_their_friction() -> None:
    pair = [on_facet(f"F{i}", [s, 0, 0], [s, 0, 0], f"facet {i}", 0.2) for i, s in enumerate((1, -1))]
    verdict = verdict_of(*(replace(contact, friction=0.5) for contact in pair))
    for claim in ("deterministic", "form_closure", "force_closure"):
        assert finding(verdict, claim).answer is Answer.NO
    assert check(verdict) == []


def with_rule(verdict: Verdict, rule: Rule | None) -> Verdict:
    """The verdict with another rule behind its `deterministic`."""
    found = finding(verdict, "deterministic")
    assert isinstance(found.evidence, Singular)
    forged = replace(found, evidence=replace(found.evidence, rule=rule))
    group = replace(verdict.groups["all"], findings={**verdict.groups["all"].findings, "deterministic": forged})
    return replace(verdict, groups={"all": group})


def misnamed(rule: Rule) -> Rule:
    """A rule with a name that there is none of, past the type check of its constructor."""
    wrong = replace(rule)
    object.__setattr__(wrong, "name", "few words")
    return wrong


@pytest.mark.parametrize(
    "forge",
    [
        lambda rule: replace(rule, counted=rule.counted[:0]),
        lambda rule: replace(rule, counted=tuple(replace(b, count=b.count - 1) for b in rule.counted)),
        lambda rule: replace(rule, counted=tuple(replace(b, count=b.count + 5) for b in rule.counted)),
        lambda rule: replace(rule, counted=(*rule.counted, *rule.counted)),
        lambda rule: replace(rule, name="few normals"),
        misnamed,
        lambda rule: None,
    ],
)
def test_forged_counts(forge: Callable[[Rule], Rule | None]) -> None:
    verdict = verdict_of(*pads(4))
    found = finding(verdict, "deterministic")
    assert isinstance(found.evidence, Singular)
    assert found.evidence.rule is not None
    assert check(with_rule(verdict, forge(found.evidence.rule))) != []


def test_a_rule_of_unknown_name_is_reported() -> None:
    verdict = verdict_of(*pads(4))
    evidence = finding(verdict, "deterministic").evidence
    assert isinstance(evidence, Singular)
    assert evidence.rule is not None
    assert check(with_rule(verdict, misnamed(evidence.rule))) == [
        "all: deterministic no: no rule is called 'few words'"
    ]


@pytest.mark.parametrize(
    "change",
    [
        lambda c: replace(c, feature="facet 2"),
        lambda c: replace(c, feature=None),
        lambda c: replace(c, provenance=Provenance("approximate", 1e-3)),
        lambda c: replace(c, clauses=((np.array([0, 1e-3, -1]),),)),
    ],
)
def test_contacts_counted_together_must_share_a_plane_facet(change: Callable[[Contact], Contact]) -> None:
    verdict = verdict_of(*pads(4))
    changed = replace(verdict, contacts=(*verdict.contacts[:-1], change(verdict.contacts[-1])))
    assert any("one plane facet" in problem for problem in check(changed))


def test_a_count_says_nothing_of_friction() -> None:
    verdict = verdict_of(*pads(4))
    rubbing = replace(verdict, contacts=tuple(replace(c, friction=0.5) for c in verdict.contacts))
    found = replace(finding(verdict, "form_closure"), answer=Answer.NO)
    rule = Rule("few rows", (Counted(tuple(c.name for c in verdict.contacts), 3),))
    assert isinstance(found.evidence, Motion)
    found = replace(found, evidence=replace(found.evidence, rule=rule))
    group = replace(verdict.groups["all"], findings={"force_closure": found})
    assert "friction" in check(replace(rubbing, groups={"all": group}))[0]


def test_an_undecided_answer_names_the_normals_that_blur_it() -> None:
    """Opposed facets that may be out of parallel, and a strip of a curved surface."""
    contacts = [
        *pads(3),
        *(replace(c, name=f"top {i}", clauses=((Z,),), feature="facet 12") for i, c in enumerate(pads(3))),
    ]
    contacts = [*contacts[:3], *(replace(c, provenance=Provenance("approximate", 0.17)) for c in contacts[3:])]
    found = finding(verdict_of(*contacts), "strongly_accessible")
    assert found.answer is Answer.UNDECIDED
    assert found.reason is not None
    assert "on facet 12 (top 0, top 1, top 2: curved surface, off by up to 0.17 rad)" in found.reason
    assert found.reason.index("facet 12") < found.reason.index("facet 1 (")
