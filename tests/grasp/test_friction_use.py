"""How much of the friction squeezing takes: told where it is much, and such grasps are chosen last."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.cli.grasp_report import grasps_in_words
from fixture_design.contacts import unit_normal
from fixture_design.grasp import Grasp, Posture, Search, judging, posed
from fixture_design.grasp.finds import Finds
from fixture_design.grasp.friction_use import friction_used, is_tight
from fixture_design.grasp.search import grasp
from fixture_design.grasp.weakest import Weakest
from fixture_design.layout import Answer
from tests.grasp.hands import JAW, at, model_of, primitive


def _leaning(degrees: float) -> Grasp:
    """The jaw on a part like the cube, whose two faces lean towards each other like those of a wedge."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))
    (found,) = posed(posture, part, geometry).grasps
    up = np.array([0.0, 0.0, np.tan(np.radians(degrees))])
    contacts = tuple(replace(one, clauses=((unit_normal(one.clauses[0][0]) + up,),)) for one in found.verdict.contacts)
    return replace(found, verdict=replace(found.verdict, contacts=contacts))


@pytest.mark.parametrize(("degrees", "used"), [(5.0, 0.175), (20.0, 0.728)])
def test_squeezing_a_wedge_takes_the_tangent_of_its_angle(degrees, used):
    found = _leaning(degrees)
    assert friction_used(found) == pytest.approx(used, abs=0.02)
    assert is_tight(found) == (used > 0.5)


def test_a_wedge_that_is_too_wide_is_not_squeezed():
    assert friction_used(_leaning(27.0)) == 1.0


def test_tight_grasps_are_told_and_chosen_last():
    tight = replace(_leaning(20.0), tight=True)
    assert any("squeezing alone takes 73% of the friction" in note for note in judging.with_weakest(tight).notes)
    plain = replace(_leaning(5.0), robust=0.5)
    assert judging.better_first([replace(tight, robust=1.0), plain])[0] is plain


def test_families_whose_best_is_tight_are_tried_some_times_more(monkeypatch):
    rounds: list[int] = []
    judge = Finds.judge
    monkeypatch.setattr(judging, "is_tight", lambda grasp: len(rounds) < 3)
    monkeypatch.setattr(Finds, "judge", lambda finds, drafts: (rounds.append(len(drafts)), judge(finds, drafts))[1])
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, Search(most=1), geometry)
    assert len(rounds) == 3
    assert result.satisfied is Answer.YES
    assert not result.grasps[0].tight


def test_a_worst_direction_is_told_only_where_there_is_one():
    found = replace(_leaning(5.0), weakest=Weakest(np.inf, np.array([0.0, 0.0, 1.0])))
    part, geometry = primitive("cube")
    result = posed(found.posture, part, geometry)
    endless = "\n".join(grasps_in_words(replace(result, grasps=(found,))))
    assert "holds any force, as its drives have no limit" in endless
    assert "worst direction" not in endless
    assert "worst direction" in "\n".join(grasps_in_words(result))
