"""Every verdict against exact rational truth of the layout before rounding (tests/generated.py says which kinds)."""

import pytest

from fixture_design.layout import Layout
from fixture_design.verification import check, verify
from tests.generated import GeneratedLayout, generate


def problems_of(generated: GeneratedLayout) -> list[str]:
    """Wrong answers, 'undecided' where it is no near tie, and evidence that the checker does not confirm."""
    verdict = verify(Layout("generated", generated.space, contacts=generated.contacts))
    findings = verdict.groups["all"].findings
    wrong = [
        f"{generated}: {question} is {finding.answer}, truth {generated.truth[question]} ({finding.reason})"
        for question, finding in findings.items()
        if not generated.accepts(question, str(finding.answer))
    ]
    return wrong + [f"{generated}: {problem}" for problem in check(verdict)]


@pytest.mark.parametrize("seed", range(10))
def test_a_thousand_layouts(seed: int) -> None:
    assert [problem for layout in generate(100, seed) for problem in problems_of(layout)] == []


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("seed", range(100, 110))
def test_ten_thousand_layouts(seed: int) -> None:
    assert [problem for layout in generate(1000, seed) for problem in problems_of(layout)] == []
