"""Flawed fixtures are caught with the right cause; the sound ones they come from pass."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design import check, verify
from fixture_design.layout import Answer
from fixture_design.viewing import evidence_in_words
from tests.verification.fixtures import FLAWS, answer_to, layout_of, random_plate, sound

SEEDS = range(20)


@pytest.mark.parametrize("seed", SEEDS)
def test_sound_fixtures_pass(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    plate = random_plate(tmp_path, rng)
    verdict = verify(layout_of(sound(plate, rng), plate))
    open_ones = [(r.group, r.require, r.answer) for r in verdict.requirements if r.answer is not Answer.YES]
    assert open_ones == []
    assert check(verdict) == []


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("name", FLAWS)
def test_flawed_fixtures_are_caught_with_their_cause(tmp_path: Path, name: str, seed: int) -> None:
    flaw = FLAWS[name]
    rng = np.random.default_rng(seed)
    plate = random_plate(tmp_path, rng)
    data = sound(plate, rng)
    flaw.spoil(data, plate)
    verdict = verify(layout_of(data, plate))
    assert answer_to(verdict, flaw) in flaw.answers
    finding = verdict.groups[flaw.stage].findings[flaw.requirement]
    said = evidence_in_words(flaw.requirement, finding, verdict.reference, verdict.length)
    for word in flaw.words:
        assert word in f"{said}; {finding.reason}"
    assert check(verdict) == []
