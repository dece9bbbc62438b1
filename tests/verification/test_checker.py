"""The checker confirms what is right and refuses every kind of forged evidence."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance
from fixture_design.layout import Answer, Finding, Layout, Motion, RequirementVerdict, Singular, Verdict, Weights
from fixture_design.verification import check, verify
from tests.problems import figure_8

OPEN, CLOSED = ("P1", "P2", "P3", "P4"), ("P1", "P2", "P3", "P4", "P5")


def verdict_of(names: tuple[str, ...]) -> Verdict:
    return verify(Layout("figure 8", "planar", contacts=tuple(figure_8(names))))


def forged(verdict: Verdict, claim: str, finding: Finding) -> Verdict:
    group = verdict.groups["all"]
    group = replace(group, findings={**group.findings, claim: finding})
    return replace(verdict, groups={"all": group})


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
    assert "not admissible" in check(forged(verdict_of(OPEN), "form_closure", finding))[0]


def test_a_motion_that_only_slides_is_not_strong() -> None:
    finding = Finding(Answer.YES, 0.0, Motion(np.array([1.0, 0.0, 0.0]), 0.0), 0.0)
    assert check(forged(verdict_of(OPEN), "strongly_accessible", finding)) != []


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
    assert check(forged(verdict, "form_closure", Finding(Answer.YES, 0.1, evidence, 0.0))) != []


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
    problems = check(forged(verdict, claim, Finding(answer, None, evidence, 0.0)))
    assert (problems == []) is (kind in PROVED_BY[claim, answer])


@pytest.mark.parametrize("motion", [np.zeros(3), np.full(3, np.nan), np.ones(6), np.array([np.inf, 0.0, 0.0])])
@pytest.mark.parametrize(("claim", "answer"), [("form_closure", Answer.NO), ("strongly_accessible", Answer.YES)])
def test_motions_that_are_none(claim: str, answer: Answer, motion: np.ndarray) -> None:
    finding = Finding(answer, None, Motion(motion, 0.0), 0.0)
    assert "finite vector" in check(forged(verdict_of(CLOSED), claim, finding))[0]


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
    assert check(forged(verdict, "form_closure", Finding(Answer.YES, 0.1, evidence, 0.0))) != []


def test_balance_without_rank_is_no_closure() -> None:
    """Two opposed pairs through one point: they balance exactly, with rank 2 of 3."""
    rng = np.random.default_rng(0)
    for _ in range(100):
        point, (a, b) = rng.normal(size=2), rng.normal(size=(2, 2))
        contacts = [Contact.on_facet(f"C{i}", "locator", point, n) for i, n in enumerate((a, -a, b, -b))]
        verdict = verify(Layout("pairs", "planar", contacts=tuple(contacts)))
        weights = Weights({f"C{i}": (1.0,) for i in range(4)}, (("C0", 0), ("C1", 0), ("C2", 0)), (), 0.0)
        assert check(verdict) == []
        assert check(forged(verdict, "form_closure", Finding(Answer.YES, None, (weights,), 0.0))) != []


def test_a_choice_that_takes_two_alternatives_of_one_clause() -> None:
    contacts = (
        Contact.of("A", "locator", [0, 0], [[[1, 0], [0, 1]]]),
        Contact.on_facet("B", "locator", [2, 0], [1, 0]),
        Contact.on_facet("C", "locator", [0, 3], [1, 0]),
    )
    verdict = verify(Layout("twice", "planar", contacts=contacts))
    claimed = Singular(3, None, ((("A", 0, 1), ("A", 0, 0)),), 0.0)
    assert "chosen twice" in check(forged(verdict, "deterministic", Finding(Answer.YES, None, claimed, 0.0)))[0]


def test_normal_errors_count_against_a_proof() -> None:
    verdict = verdict_of(CLOSED)
    rough = tuple(replace(c, provenance=Provenance("approximate", 0.5)) for c in verdict.contacts)
    problems = check(replace(verdict, contacts=rough))
    assert any("form_closure yes" in problem for problem in problems)
    assert any("deterministic yes" in problem for problem in problems)


def test_margins_and_requirements_must_agree() -> None:
    verdict = verdict_of(CLOSED)
    finding = replace(verdict.groups["all"].findings["form_closure"], margin=-0.1)
    assert "margin" in check(forged(verdict, "form_closure", finding))[0]
    lying = replace(verdict, requirements=(RequirementVerdict("all", "accessible", Answer.YES),), satisfied=Answer.NO)
    assert len(check(lying)) == 2


def test_a_branch_left_out() -> None:
    verdict = verdict_of(CLOSED)
    finding = Finding(Answer.YES, 0.1, evidence_of(verdict, "form_closure")[:1], 0.0)
    assert "branch" in check(forged(verdict, "form_closure", finding))[0]


def test_weights_of_an_open_layout_do_not_prove_closure() -> None:
    """P1, P3 and P4 balance, but with rank 2: closure without a rank test is the classic mistake."""
    verdict = verdict_of(OPEN)
    finding = Finding(Answer.YES, 0.1, evidence_of(verdict, "strongly_accessible"), 0.0)
    assert check(forged(verdict, "form_closure", finding)) != []


def test_no_evidence_and_wrong_rank() -> None:
    verdict = verdict_of(OPEN)
    assert check(forged(verdict, "form_closure", Finding(Answer.YES, 0.1))) != []
    assert check(forged(verdict, "deterministic", Finding(Answer.YES, 0.1, Singular(2, None, ((),), 0.0)))) != []
    noticed = Singular(2, np.array([0.0, 1.0, 0.0]), (), 0.0)
    assert check(forged(verdict, "deterministic", Finding(Answer.NO, 0.0, noticed))) != []


def test_rank_deficiency_is_found_by_the_checker_too() -> None:
    verdict = verdict_of(("P3", "P4"))
    claimed = Finding(Answer.YES, 0.1, Singular(3, None, ((),), 0.0), 0.0)
    assert check(verdict) == []
    assert check(forged(verdict, "deterministic", claimed)) != []


def test_full_rank_of_some_branches_is_not_that_of_all() -> None:
    """Three apices: the rank must be proved for every alternative that matters."""
    apices = [Contact.of(f"A{i}", "locator", [i, i**2], [[[1, i], [i, -1 - i]]]) for i in range(3)]
    verdict = verify(Layout("apices", "planar", contacts=tuple(apices)))
    finding = verdict.groups["all"].findings["deterministic"]
    assert check(verdict) == []
    if isinstance(finding.evidence, Singular) and finding.answer is Answer.YES:
        partly = replace(finding.evidence, choices=finding.evidence.choices[1:])
        assert "covered" in check(forged(verdict, "deterministic", replace(finding, evidence=partly)))[0]
