"""Evidence must be about the layout: its weight, loads, preloads and features."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fixture_design import check, read_layout, verify
from fixture_design.layout import Layout, Verdict

BRACKET = Path(__file__).resolve().parents[2] / "urdf" / "bracket" / "bracket.layout.yaml"


@pytest.fixture(scope="module")
def bracket() -> tuple[Layout, Verdict]:
    layout = read_layout(BRACKET)
    return layout, verify(layout)


def changed(verdict: Verdict, group: str, claim: str, **use: object) -> Verdict:
    finding = verdict.groups[group].findings[claim]
    findings = {**verdict.groups[group].findings, claim: replace(finding, use=replace(finding.use, **use))}
    return replace(verdict, groups={**verdict.groups, group: replace(verdict.groups[group], findings=findings)})


def test_what_the_layout_says_is_confirmed(bracket: tuple[Layout, Verdict]) -> None:
    layout, verdict = bracket
    assert check(verdict, layout) == []


@pytest.mark.parametrize(
    ("group", "claim", "change", "word"),
    [
        ("clamped", "holds_loads", lambda use: {"loads": use.loads[:1], "worst": 0}, "loads are not those"),
        ("clamped", "holds_loads", lambda use: {"weight": np.zeros(6)}, "weight"),
        ("clamped", "holds_loads", lambda use: {"preloads": {}}, "preloads"),
        ("clamped", "seated", lambda use: {"preloads": {"K2": 1.0}}, "preloads"),
        ("placed", "accurate", lambda use: {"features": use.features[:1]}, "features"),
        ("placed", "accurate", lambda use: {"features": (replace(use.features[0], tolerance=1.0),)}, "features"),
        ("placed", "accurate", lambda use: {"errors": dict.fromkeys(use.errors, 0.0)}, "below its tolerance"),
    ],
)  # fmt: skip
def test_other_evidence_is_refused(
    bracket: tuple[Layout, Verdict], group: str, claim: str, change: Callable, word: str
) -> None:
    layout, verdict = bracket
    use = verdict.groups[group].findings[claim].use
    assert any(word in fault for fault in check(changed(verdict, group, claim, **change(use)), layout))


def test_a_requirement_that_was_left_out(bracket: tuple[Layout, Verdict]) -> None:
    layout, verdict = bracket
    group = verdict.groups["placed"]
    fewer = replace(group, findings={k: v for k, v in group.findings.items() if k != "accurate"})
    assert any("accurate" in f for f in check(replace(verdict, groups={**verdict.groups, "placed": fewer}), layout))
