"""Joints at their stops: drives push against them in vain, and fingers do not follow the part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.cli.grasp_report import grasps_in_words
from fixture_design.grasp import HandModel, Posture, Search, load_hand, posed
from fixture_design.grasp.hand import JointRule
from fixture_design.grasp.judging import Site, drafted
from fixture_design.grasp.search import grasp
from fixture_design.grasp.stops import Travel, room
from fixture_design.layout import Answer
from tests.grasp.hands import JAW, at, model_of, primitive


def _jaw(lower: float, upper: float = 0.05) -> HandModel:
    """The jaw with another range; it is at 30 mm where it holds the cube."""
    hand = replace(model_of(JAW).hand, joints={"left_joint": JointRule(lower=lower, upper=upper)})
    return load_hand(hand)


def _on_cube(model: HandModel) -> Posture:
    return Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))


def test_a_jaw_at_its_closing_stop_squeezes_nothing():
    part, geometry = primitive("cube")
    result = posed(_on_cube(_jaw(0.03)), part, geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert "nothing squeezes: left_joint is at its lower stop" in (result.reason or "")
    assert "nothing squeezes" in next(grasps_in_words(result))
    (found,) = result.grasps
    assert found.weakest is not None
    assert found.weakest.force == 0
    assert found.robust is not None
    assert found.robust < 0.5  # no finger follows the part
    assert "fingertip 'left' can close no further: its joints are at stops" in found.notes
    assert not found.tight


def test_what_a_jaw_at_its_closing_stop_is_to_hold_is_not_held():
    part, geometry = primitive("cube")
    load = np.array([0, 0, -10.0, 0, 0, 0])
    assert posed(_on_cube(_jaw(0.03)), part, geometry, load).grasps[0].held is None
    assert posed(_on_cube(_jaw(0.025)), part, geometry, load).grasps[0].held is not None


def test_a_jaw_at_its_opening_stop_squeezes_as_ever():
    part, geometry = primitive("cube")
    result = posed(_on_cube(_jaw(0.0, 0.03)), part, geometry, np.array([0, 0, -10.0, 0, 0, 0]))
    assert result.satisfied is Answer.YES
    assert result.grasps[0].held is not None


def test_a_jaw_at_its_stop_is_a_wall_for_one_that_still_closes(tmp_path):
    """Each jaw on its own: the left one presses against its stop, up to its effort, and the right one squeezes."""
    part, geometry = primitive("cube")
    hand = model_of(JAW).hand
    rules = {"left_joint": JointRule(lower=0.03, effort=20.0), "right_joint": JointRule(follows=None, effort=80.0)}
    text = hand.model.read_text().replace('<mimic joint="left_joint" multiplier="1" offset="0"/>', "")
    file = tmp_path / "loose.urdf"
    file.write_text(text)
    model = load_hand(replace(hand, model=file, joints=rules))
    posture = Posture(model, model.positions({"left_joint": 0.03, "right_joint": 0.03}), at(0, 0, -0.115))
    held = [posed(posture, part, geometry, np.array([0, 0, -f, 0, 0, 0])).grasps[0].held for f in (19.9, 20.1)]
    assert held[0] is not None
    assert held[1] is None  # half of it on each pad with friction 0.5: 20 N against the stop


def test_little_travel_is_noted_and_bounds_how_fingers_follow():
    part, geometry = primitive("cube")
    (short,) = posed(_on_cube(_jaw(0.0295)), part, geometry).grasps
    (long,) = posed(_on_cube(_jaw(0.0)), part, geometry).grasps
    assert any("'left' can close by only 500 um more" in note for note in short.notes)
    assert not any("can close by only" in note for note in long.notes)
    assert short.robust is not None
    assert long.robust is not None
    assert short.robust < long.robust - 0.2


def test_travel_is_what_is_left_of_the_range_also_of_a_joint_that_follows():
    posture = _on_cube(model_of(JAW))
    for tip in posture.model.fingertips:
        travel = Travel.of(posture, tip)
        assert travel.closing == pytest.approx(0.03)
        assert travel.opening == pytest.approx(0.02)
    rules = {"right_joint": JointRule(lower=0.029, follows="left_joint")}
    model = load_hand(replace(model_of(JAW).hand, joints=rules))
    np.testing.assert_allclose(room(model, _on_cube(model).q), [[0.001, 0.02]], atol=1e-12)


def test_a_search_takes_no_posture_that_cannot_squeeze():
    part, geometry = primitive("cube")
    jaw = _jaw(0.03)
    found = drafted(_on_cube(jaw), Site.of(part, geometry), jaw.fingertips)
    assert isinstance(found, str)
    assert "nothing squeezes" in found
    assert grasp(jaw, part, Search(most=1, tries=20), geometry).satisfied is Answer.UNDECIDED
