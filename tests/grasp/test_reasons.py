"""What a search says of itself where it found nothing, or not what was asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.cli.grasp_report import grasps_in_words
from fixture_design.grasp import HandModel, Posture, Search, posed
from fixture_design.grasp import result as results
from fixture_design.grasp.attempts import DRAFTS, Attempts
from fixture_design.grasp.finds import Finds
from fixture_design.grasp.search import grasp
from fixture_design.layout import Answer
from tests.grasp.hands import JAW, THREE, at, model_of, primitive

QUICK = Search(most=1, tries=12)
WEIGHT = np.array([0.0, 0, -5, 0, 0, 0])


def _without_friction(model: HandModel) -> HandModel:
    tips = tuple(replace(tip, friction=None, soft=None) for tip in model.fingertips)
    return replace(model, hand=replace(model.hand, friction=0.0), fingertips=tips)


def test_a_load_that_is_held_is_not_what_is_undecided(monkeypatch):
    monkeypatch.setattr(results.Grasp, "closed", property(lambda found: Answer.UNDECIDED))
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, replace(QUICK, load=WEIGHT), geometry)
    assert result.grasps[0].held is not None
    assert result.reason == "the verdicts of all grasps that were found and hold the load are undecided"


def test_undecided_grasps_do_not_use_up_what_is_wanted(monkeypatch):
    """The first grasps that are judged are undecided, as many as one that is wanted has drafts."""
    judged = []

    def judge(finds: Finds, drafts):
        undecided = not judged
        judged.append(len(drafts))
        plain(finds, drafts)
        if undecided:
            doubtful.extend(finds.best.values())

    doubtful: list[results.Grasp] = []
    plain = Finds.judge
    monkeypatch.setattr(Finds, "judge", judge)
    monkeypatch.setattr(Finds, "_is_good", lambda finds, one: not any(one is other for other in doubtful))
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, replace(QUICK, tries=40), geometry)
    assert judged[0] == DRAFTS
    assert len(judged) > 1
    assert result.satisfied is Answer.YES


@pytest.mark.slow
def test_a_ball_of_facets_is_held_by_three_fingers_as_often_as_one_is_wanted():
    part, geometry = primitive("sphere")
    result = grasp(model_of(THREE), part, Search(most=1), geometry)
    assert result.satisfied is Answer.YES


def test_a_search_that_is_stopped_says_so():
    part, geometry = primitive("cube")
    nothing = grasp(model_of(JAW), part, QUICK, geometry, cancelled=lambda: True)
    assert nothing.reason == "the search was stopped before it had found any grasp"
    assert {region.outcome for region in nothing.regions} == {"not tried"}
    asked = []

    def later() -> bool:
        asked.append(1)
        return len(asked) > 8

    some = grasp(model_of(JAW), part, Search(), geometry, cancelled=later)
    assert some.satisfied is Answer.YES
    assert "the search was stopped before all was tried" in some.notes


def test_faces_where_contacts_do_not_close_were_reached():
    part, geometry = primitive("cube")
    result = grasp(_without_friction(model_of(JAW)), part, QUICK, geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert {region.outcome for region in result.regions} == {"the contacts do not close"}


def test_points_that_close_nowhere_are_not_called_out_of_reach(monkeypatch):
    monkeypatch.setattr(Attempts, "drafts", lambda attempts, library, wanted: iter(()))
    part, geometry = primitive("sphere")
    result = grasp(_without_friction(model_of(THREE)), part, QUICK, geometry)
    assert "no three points of the part that were looked at close with friction 0" in (result.reason or "")
    assert "within reach" not in (result.reason or "")


def test_closed_grasps_are_in_no_doubt_whatever_else_is_undecided():
    part, geometry = primitive("cylinder")
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.02}), at(0, 0, -0.115))
    (found,) = posed(posture, part, geometry).grasps
    assert found.closed is Answer.YES
    group = found.verdict.groups["all"]
    unasked = replace(group.findings["form_closure"], answer=Answer.UNDECIDED, reason="the margin is a tie")
    group = replace(group, findings={"form_closure": unasked, "force_closure": group.findings["force_closure"]})
    doubtful = replace(found, verdict=replace(found.verdict, groups={"all": group}))
    assert doubtful.doubt is None


def test_grasps_that_do_not_close_hold_forces_alone():
    """Two hard pads on a ball: it spins about the line between them, and no force through its centre does that."""
    part, geometry = primitive("sphere")
    model = model_of(JAW)
    hard = replace(model, fingertips=tuple(replace(tip, soft=None) for tip in model.fingertips))
    opened = posed(Posture(hard, hard.positions({"left_joint": 0.03}), at(0, 0, -0.115)), part, geometry)
    assert opened.satisfied is Answer.NO
    assert any("forces alone: not all moments are held" in line for line in grasps_in_words(opened))


def test_flat_parts_on_a_table_are_gripped_from_above():
    """A box 12 mm high: the pads are 30 mm, and hang over its upper edge."""
    part, geometry = primitive("flat")
    part = replace(part, pose=at(0.1, 0.2, 0.006, rpy=(0, 0, 0.4)))
    result = grasp(model_of(JAW), part, replace(QUICK, table=0.0), geometry)
    assert result.satisfied is Answer.YES
    (found,) = result.grasps
    model, poses = found.posture.model, found.posture.links()
    assert min(poses[name].points(link.geometry.vertices)[:, 2].min() for name, link in model.links.items()) >= -1e-4
    assert found.posture.X_WH.translation[2] > 0.03


def test_sizes_that_look_like_millimetres_are_noted():
    part, geometry = primitive("huge")
    assert any("check `scale`" in note for note in grasp(model_of(JAW), part, QUICK, geometry).notes)
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -100))
    assert any("check `scale`" in note for note in posed(posture, part, geometry).notes)
