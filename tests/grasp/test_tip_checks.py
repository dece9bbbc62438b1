"""Fingertips of a hand file must be on their links."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.grasp import Fingertip, Hand, HandError, load_hand
from tests.grasp.hands import JAW, PUBLIC, THREE, model_of, public_hand

X = np.array([1.0, 0, 0])
LEFT = Fingertip("left", "left_pad", np.zeros(3), X, pad=(0.022, 0.03), along=np.array([0, 1.0, 0]))
BALL = Fingertip("ball", "finger_1_tip", np.zeros(3), -X, ball=0.01)


def _loaded(tip: Fingertip, model=JAW):
    return load_hand(Hand("some", model, (tip,)))


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (
            {"at": np.array([0.005, 0, 0.04])},
            r"fingertip 'left': the middle of its pad is 25\.\d mm off link",
        ),
        ({"pad": (22.0, 30.0)}, r"a corner of its pad is 18.6 m off .*look like millimetres"),
        ({"pad": (0.022, 0.06)}, "a corner of its pad is 15 mm off"),
        ({"facing": -X}, "its `facing` looks into link 'left_pad'"),
        ({"facing": np.array([0, 0, 1.0])}, "its `facing` looks along link 'left_pad'"),
        ({"pad": None, "along": None, "at": np.array([0, 0, 15.0])}, r"its `at` is 15 m off.*look like millimetres"),
        ({"pad": None, "along": None, "ball": 0.01}, "the foremost point of its ball is 10 mm off"),
    ],
)
def test_fingertips_off_their_link_are_refused(changes, problem):
    with pytest.raises(HandError, match=problem):
        _loaded(replace(LEFT, **changes))


def test_a_ball_that_looks_into_its_finger_is_refused():
    with pytest.raises(HandError, match="its `facing` looks into link 'finger_1_tip'"):
        _loaded(replace(BALL, facing=np.array([0, 0, -1.0])), THREE)
    with pytest.raises(HandError, match=r"is (5|4\.9\d) mm off"):
        _loaded(replace(BALL, ball=0.015), THREE)


def test_a_little_off_is_noted_and_a_tenth_of_a_millimetre_is_nothing():
    for off, noted in ((0.5e-3, True), (0.05e-3, False)):
        model = _loaded(replace(LEFT, at=off * X))
        assert any("the middle of its pad is 500 um off" in note or "off link" in note for note in model.notes) == noted


def test_a_tiny_pad_is_noted():
    model = _loaded(replace(LEFT, pad=(22e-6, 3e-5)))
    assert any("'left' is only 22 um large: check `units`" in note for note in model.notes)


def test_a_link_that_is_made_of_nothing_holds_nothing(tmp_path):
    model = tmp_path / "bare.urdf"
    text = JAW.read_text()
    start = text.index('<link name="left_pad">')
    text = text[:start] + text[start:].replace("<collision>", "<visual>", 1).replace("</collision>", "</visual>", 1)
    model.write_text(text)
    with pytest.raises(HandError, match="off link 'left_pad'"):  # the jaw that it is welded to is not there
        _loaded(LEFT, model)
    frame = '<link name="free"/><joint name="j" type="revolute"><parent link="left_jaw"/><child link="free"/>'
    limit = '<limit lower="0" upper="1" effort="1" velocity="1"/>'
    model.write_text(JAW.read_text().replace("</robot>", f'{frame}<axis xyz="0 0 1"/>{limit}</joint></robot>'))
    with pytest.raises(HandError, match="link 'free' is made of nothing"):
        _loaded(replace(LEFT, link="free"), model)


@pytest.mark.parametrize("name", ["JAW", "THREE", *PUBLIC])
def test_fingertips_that_are_right_are_taken(name):
    """Those of the repository's hands, and those that are guessed of public ones, given as in a hand file."""
    given = {"JAW": JAW, "THREE": THREE}
    model = model_of(given[name]) if name in given else public_hand(name)
    again = load_hand(replace(model.hand, fingertips=model.fingertips))
    assert again.fingertips == model.fingertips
