"""The checker confirms what is right and refuses every kind of forged evidence."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance
from fixture_design.layout import (
    Answer,
    Finding,
    Layout,
    Motion,
    Requirement,
    RequirementVerdict,
    Rule,
    RuleName,
    Singular,
    Verdict,
    Weights,
)
from fixture_design.verification import check, verify
from fixture_design.verification.checker import CLAIMS
from fixture_design.verification.verify import QUESTIONS
from tests.problems import figure_8

OPEN, CLOSED = ("P1", "P2", "P3", "P4"), ("P1", "P2", "P3", "P4", "P5")


def verdict_of(names: tuple[str, ...]) -> Verdict:
    return verify(Layout("figure 8", "planar", contacts=tuple(figure_8(names))))


def forged(verdict: Verdict, claim: str, finding: Finding) -> Verdict:
    group = verdict.groups["all"]
    group = replace(group, findings={**group.findings, claim: finding})
    return replace(verdict, groups={"all": group})


def faults(verdict: Verdict) -> list[str]:
    """What is wrong with the evidence itself, however its residual is stated."""
    return [problem for problem in check(verdict) if "residual" not in problem]


def evidence_of(verdict: Verdict, claim: str) -> tuple[Weights, ...]:
    evidence = verdict.groups["all"].findings[claim].evidence
    assert isinstance(evidence, tuple)
    return evidence


@pytest.mark.parametrize("names", [OPEN, CLOSED])
def test_genuine_evidence_is_confirmed(names: tuple[str, ...]) -> None:
    assert check(verdict_of(names)) == []


@pytest.mark.parametrize("motion", [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1e-6, 0.0]])
def test_a_motion_that_a_contact_forbids(motion: list[float]) -> None:
    finding = Finding(Answer.NO, 0.0, Motion(np.array(motion), 0.0), 0.0)
    assert "not admissible" in faults(forged(verdict_of(OPEN), "form_closure", finding))[0]


def test_a_motion_that_only_slides_is_not_strong() -> None:
    finding = Finding(Answer.YES, 0.0, Motion(np.array([1.0, 0.0, 0.0]), 0.0), 0.0)
    assert faults(forged(verdict_of(OPEN), "strongly_accessible", finding)) != []


def doubled(weights: Weights) -> Weights:
    return replace(
        weights, weights={n: tuple(2 * w for w in v) if n == "P1" else v for n, v in weights.weights.items()}
    )


def negative(weights: Weights) -> Weights:
    return replace(weights, weights={n: tuple(-w for w in v) for n, v in weights.weights.items()})


def without_basis(weights: Weights) -> Weights:
    return replace(weights, basis=())


def dependent_basis(weights: Weights) -> Weights:
    return replace(weights, basis=(("P1", 0), ("P3", 0), ("P4", 0)))


def other_branch(weights: Weights) -> Weights:
    return replace(weights, choice=tuple((n, c, 1 - a) for n, c, a in weights.choice))


@pytest.mark.parametrize("forge", [doubled, negative, without_basis, dependent_basis, other_branch])
def test_forged_weights(forge: Callable[[Weights], Weights]) -> None:
    verdict = verdict_of(CLOSED)
    evidence = tuple(forge(weights) for weights in evidence_of(verdict, "form_closure"))
    assert faults(forged(verdict, "form_closure", Finding(Answer.YES, 0.1, evidence, 0.0))) != []


KINDS = {
    "motion": Motion(np.array([1.0, 0.0, 0.0]), 0.0),
    "rank": Singular(3, None, ((("P2", 0, 0),), (("P2", 0, 1),)), 0.0),
    "none": None,
}
PROVED_BY = {
    ("deterministic", Answer.YES): {"rank"},
    ("deterministic", Answer.NO): set(),
    ("accessible", Answer.YES): {"motion"},
    ("accessible", Answer.NO): set(),
    ("strongly_accessible", Answer.YES): set(),
    ("strongly_accessible", Answer.NO): {"balance"},
    ("form_closure", Answer.YES): set(),
    ("form_closure", Answer.NO): {"motion"},
    ("force_closure", Answer.YES): set(),
    ("force_closure", Answer.NO): {"motion"},
}


@pytest.mark.parametrize("kind", [*KINDS, "balance", "closure"])
@pytest.mark.parametrize(("claim", "answer"), PROVED_BY)
def test_only_evidence_of_the_right_kind_proves(claim: str, answer: Answer, kind: str) -> None:
    """Of the open layout of Figure 8; closure weights are those of the closed one without P5."""
    verdict = verdict_of(OPEN)
    balance = evidence_of(verdict, "strongly_accessible")
    closure = tuple(
        replace(w, weights={n: v for n, v in w.weights.items() if n != "P5"})
        for w in evidence_of(verdict_of(CLOSED), "form_closure")
    )
    evidence = {**KINDS, "balance": balance, "closure": closure}[kind]
    problems = faults(forged(verdict, claim, Finding(answer, None, evidence, 0.0)))
    assert (problems == []) is (kind in PROVED_BY[claim, answer])


@pytest.mark.parametrize("motion", [np.zeros(3), np.full(3, np.nan), np.ones(6), np.array([np.inf, 0.0, 0.0])])
@pytest.mark.parametrize(("claim", "answer"), [("form_closure", Answer.NO), ("strongly_accessible", Answer.YES)])
def test_motions_that_are_none(claim: str, answer: Answer, motion: np.ndarray) -> None:
    finding = Finding(answer, None, Motion(motion, 0.0), 0.0)
    assert "finite vector" in faults(forged(verdict_of(CLOSED), claim, finding))[0]


def edited(weights: Weights, **values: tuple[float, ...]) -> Weights:
    return replace(weights, weights={**weights.weights, **values})


@pytest.mark.parametrize(
    "forge",
    [
        lambda w: edited(w, P5=(np.nan,)),
        lambda w: edited(w, P5=(0.1, 0.0)),
        lambda w: edited(w, P5=()),
        lambda w: edited(w, P6=(0.1,)),
        lambda w: replace(w, weights={n: v for n, v in w.weights.items() if n != "P5"}),
        lambda w: replace(w, basis=(("P1", 0), ("P1", 0), ("P5", 0))),
        lambda w: replace(w, basis=(("P1", 0), ("P3", 0), ("P9", 4))),
        lambda w: replace(w, choice=(("P9", 0, 0),)),
        lambda w: replace(w, choice=(("P2", 0, 7),)),
        lambda w: replace(w, choice=(("P2", 0, 0), ("P2", 0, 1))),
    ],
)
def test_malformed_weights_are_reported(forge: Callable[[Weights], Weights]) -> None:
    verdict = verdict_of(CLOSED)
    evidence = tuple(forge(weights) for weights in evidence_of(verdict, "form_closure"))
    assert faults(forged(verdict, "form_closure", Finding(Answer.YES, 0.1, evidence, 0.0))) != []


def test_balance_without_rank_is_no_closure() -> None:
    """Two opposed pairs through one point: they balance exactly, with rank 2 of 3."""
    rng = np.random.default_rng(0)
    for _ in range(100):
        point, (a, b) = rng.normal(size=2), rng.normal(size=(2, 2))
        contacts = [Contact.on_facet(f"C{i}", "locator", point, n) for i, n in enumerate((a, -a, b, -b))]
        verdict = verify(Layout("pairs", "planar", contacts=tuple(contacts)))
        weights = Weights({f"C{i}": (1.0,) for i in range(4)}, (("C0", 0), ("C1", 0), ("C2", 0)), (), 0.0)
        assert check(verdict) == []
        assert faults(forged(verdict, "form_closure", Finding(Answer.YES, None, (weights,), 0.0))) != []


def test_a_choice_that_takes_two_alternatives_of_one_clause() -> None:
    contacts = (
        Contact.of("A", "locator", [0, 0], [[[1, 0], [0, 1]]]),
        Contact.on_facet("B", "locator", [2, 0], [1, 0]),
        Contact.on_facet("C", "locator", [0, 3], [1, 0]),
    )
    verdict = verify(Layout("twice", "planar", contacts=contacts))
    claimed = Singular(3, None, ((("A", 0, 1), ("A", 0, 0)),), 0.0)
    assert "chosen twice" in faults(forged(verdict, "deterministic", Finding(Answer.YES, None, claimed, 0.0)))[0]


def test_normal_errors_count_against_a_proof() -> None:
    verdict = verdict_of(CLOSED)
    rough = tuple(replace(c, provenance=Provenance("approximate", 0.5)) for c in verdict.contacts)
    problems = check(replace(verdict, contacts=rough))
    assert any("form_closure yes" in problem for problem in problems)
    assert any("deterministic yes" in problem for problem in problems)


def test_margins_and_requirements_must_agree() -> None:
    verdict = verdict_of(CLOSED)
    finding = replace(verdict.groups["all"].findings["form_closure"], margin=-0.1)
    assert "margin" in faults(forged(verdict, "form_closure", finding))[0]
    lying = replace(verdict, requirements=(RequirementVerdict("all", "accessible", Answer.YES),), satisfied=Answer.NO)
    assert len(check(lying)) == 2


def test_a_branch_left_out() -> None:
    verdict = verdict_of(CLOSED)
    finding = Finding(Answer.YES, 0.1, evidence_of(verdict, "form_closure")[:1], 0.0)
    assert "branch" in faults(forged(verdict, "form_closure", finding))[0]


def test_weights_of_an_open_layout_do_not_prove_closure() -> None:
    """P1, P3 and P4 balance, but with rank 2: closure without a rank test is the classic mistake."""
    verdict = verdict_of(OPEN)
    finding = Finding(Answer.YES, 0.1, evidence_of(verdict, "strongly_accessible"), 0.0)
    assert faults(forged(verdict, "form_closure", finding)) != []


def test_no_evidence_and_wrong_rank() -> None:
    verdict = verdict_of(OPEN)
    assert faults(forged(verdict, "form_closure", Finding(Answer.YES, 0.1))) != []
    assert faults(forged(verdict, "deterministic", Finding(Answer.YES, 0.1, Singular(2, None, ((),), 0.0)))) != []
    noticed = Singular(2, np.array([0.0, 1.0, 0.0]), (), 0.0)
    assert faults(forged(verdict, "deterministic", Finding(Answer.NO, 0.0, noticed))) != []


def test_rank_deficiency_is_found_by_the_checker_too() -> None:
    verdict = verdict_of(("P3", "P4"))
    claimed = Finding(Answer.YES, 0.1, Singular(3, None, ((),), 0.0), 0.0)
    assert check(verdict) == []
    assert faults(forged(verdict, "deterministic", claimed)) != []


def test_full_rank_of_some_branches_is_not_that_of_all() -> None:
    """A corner that is needed: the rank must be proved for every alternative that matters."""
    contacts = (
        Contact.of("A", "locator", [0, 3], [[[1, 0], [1, 1]]]),
        Contact.on_facet("B", "locator", [0, 0], [1, 0]),
        Contact.on_facet("C", "locator", [0, 0], [0, 1]),
    )
    verdict = verify(Layout("corner", "planar", contacts=contacts))
    finding = verdict.groups["all"].findings["deterministic"]
    assert check(verdict) == []
    assert finding.answer is Answer.YES
    assert isinstance(finding.evidence, Singular)
    assert len(finding.evidence.choices) == 2
    partly = replace(finding.evidence, choices=finding.evidence.choices[1:])
    assert "covered" in faults(forged(verdict, "deterministic", replace(finding, evidence=partly)))[0]


def without(verdict: Verdict, group: str, claim: str) -> Verdict:
    found = verdict.groups[group]
    kept = {name: finding for name, finding in found.findings.items() if name != claim}
    return replace(verdict, groups={**verdict.groups, group: replace(found, findings=kept)})


def test_claims_are_the_questions_and_every_group_has_them() -> None:
    assert set(CLAIMS) == set(QUESTIONS)
    verdict = verdict_of(CLOSED)
    for group in verdict.groups:
        for claim in CLAIMS:
            assert check(without(verdict, group, claim)) == [f"{group}: there is no finding for {claim}"]


def required(verdict: Verdict, group: str, require: Requirement, answer: Answer | None) -> Verdict:
    satisfied = Answer.NO if answer is None else answer
    return replace(verdict, requirements=(RequirementVerdict(group, require, answer),), satisfied=satisfied)


def test_a_requirement_without_finding_is_undecided() -> None:
    verdict = verdict_of(CLOSED)
    assert check(required(verdict, "all", "seated", Answer.UNDECIDED)) == []
    for answer in (Answer.YES, Answer.NO, None):
        assert check(required(verdict, "all", "seated", answer)) != []
    unknown = check(required(verdict, "elsewhere", "seated", Answer.UNDECIDED))
    assert unknown == ["seated is required of 'elsewhere', and there is no such group"]
    unanswered = without(verdict, "all", "form_closure")
    assert any("not yes" in problem for problem in check(required(unanswered, "all", "form_closure", Answer.YES)))


def test_a_requirement_of_an_empty_group_has_no_answer() -> None:
    contacts = tuple(replace(contact, role="clamp") for contact in figure_8(CLOSED))
    verdict = verify(Layout("clamps", "planar", contacts=contacts))
    assert check(required(verdict, "locators", "seated", None)) == []
    for answer in Answer:
        assert check(required(verdict, "locators", "seated", answer)) != []


@pytest.mark.parametrize("group", ["all", "locators"])
@pytest.mark.parametrize("members", [(*CLOSED[:4],), (*CLOSED, "P9"), (*CLOSED, "P1"), ()])
def test_groups_have_the_contacts_that_they_are_named_after(group: str, members: tuple[str, ...]) -> None:
    verdict = verdict_of(CLOSED)
    false = replace(verdict.groups[group], contacts=members)
    if not members:
        false = replace(false, findings={claim: Finding(None) for claim in CLAIMS})
    problems = check(replace(verdict, groups={**verdict.groups, group: false}))
    assert [problem.split(":")[0] for problem in problems] == [group]


def test_names_of_groups_and_contacts() -> None:
    verdict = verdict_of(CLOSED)
    locators = {"locators": verdict.groups["locators"]}
    assert "no group 'all'" in check(replace(verdict, groups=locators))[0]
    swapped = {**locators, "all": replace(verdict.groups["all"], name="stage")}
    assert "called 'stage'" in check(replace(verdict, groups=swapped))[0]
    assert "several" in check(replace(verdict, contacts=(*verdict.contacts, verdict.contacts[0])))[0]


@pytest.mark.parametrize("margin", [np.nan, np.inf, -np.inf])
def test_margins_are_finite(margin: float) -> None:
    verdict = verdict_of(CLOSED)
    finding = replace(verdict.groups["all"].findings["form_closure"], margin=margin)
    assert "finite" in faults(forged(verdict, "form_closure", finding))[0]


@pytest.mark.parametrize("name", ["few rows", "few normals", "common slip"])
def test_no_rule_holds_where_all_contacts_have_clearance(name: RuleName) -> None:
    loose = tuple(replace(contact, clearance=1e-4) for contact in figure_8(OPEN))
    verdict = verify(Layout("loose", "planar", contacts=loose))
    assert check(verdict) == []
    ruled = Motion(np.eye(3)[0], -1.0, Rule(name, ()))
    assert "no contacts" in faults(forged(verdict, "accessible", Finding(Answer.YES, 1.0, ruled, -1.0)))[0]
    of_space = Finding(Answer.YES, 1.0, Motion(np.eye(6)[0], -1.0), -1.0)
    assert "finite vector" in faults(forged(verdict, "accessible", of_space))[0]


def test_a_short_rank_and_its_choice_are_possible_ones() -> None:
    verdict = verdict_of(("P3", "P4"))
    finding = verdict.groups["all"].findings["deterministic"]
    assert isinstance(finding.evidence, Singular)
    for rank in (-1, 3, 77):
        wrong = replace(finding, evidence=replace(finding.evidence, rank=rank))
        assert "rank" in faults(forged(verdict, "deterministic", wrong))[0]
    wrong = replace(finding, evidence=replace(finding.evidence, choices=((("P9", 0, 0),),)))
    assert "no alternative" in faults(forged(verdict, "deterministic", wrong))[0]
    for choices in ((), finding.evidence.choices * 2):
        wrong = replace(finding, evidence=replace(finding.evidence, choices=choices))
        assert "one branch" in faults(forged(verdict, "deterministic", wrong))[0]


@pytest.mark.parametrize(
    ("names", "claim"),
    [(OPEN, "form_closure"), (OPEN, "strongly_accessible"), (CLOSED, "form_closure"), (OPEN[:2], "deterministic")],
)
def test_a_residual_that_is_not_the_evidence_s(names: tuple[str, ...], claim: str) -> None:
    """The finding's own, or those of its evidence, are not what the rows in the verdict's scale give."""
    verdict = verdict_of(names)
    finding = verdict.groups["all"].findings[claim]
    assert finding.residual is not None
    off = finding.residual + 1e-3
    evidence = finding.evidence
    assert evidence is not None
    moved = (
        tuple(replace(w, residual=off) for w in evidence)
        if isinstance(evidence, tuple)
        else replace(evidence, residual=off)
    )
    for change in (replace(finding, residual=off), replace(finding, evidence=moved, residual=off)):
        (problem,) = check(forged(verdict, claim, change))
        assert "residual" in problem


def test_a_scale_that_is_none() -> None:
    verdict = verdict_of(OPEN)
    for length in (0.0, -1.0, float("nan"), float("inf")):
        assert any("length" in problem for problem in check(replace(verdict, length=length)))
