"""The checker confirms what is right and refuses every kind of forged evidence."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.layout import Answer, Finding, Layout, Motion, Singular, Verdict, Weights
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
        assert "choice" in check(forged(verdict, "deterministic", replace(finding, evidence=partly)))[0]
