"""Hand files and hands in Drake: what is read, what is refused, what is guessed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import FileFormatError, UnknownNameError
from fixture_design.grasp import Hand, HandError, JointRule, load_hand
from fixture_design.io import json_schema, read_hand
from tests.grasp.hands import JAW, PUBLIC, THREE, model_of, public_hand

GOOD = """
schema: fixture_design/hand/1
model: {model}
fingertips:
  - {{name: left, link: left_pad, at: [0, 0, 0], facing: [1, 0, 0], pad: [0.022, 0.03], along: [0, 1, 0]}}
"""


def _file(folder: Path, text: str) -> Path:
    file = folder / "some.hand.yaml"
    file.write_text(text.format(model=JAW))
    return file


def test_own_hands_have_the_joints_and_fingertips_that_their_files_say():
    jaw, three = model_of(JAW), model_of(THREE)
    assert [joint.name for joint in jaw.joints] == ["left_joint", "right_joint"]
    assert len(jaw.free) == 1
    assert [tip.name for tip in jaw.fingertips] == ["left", "right"]
    assert len(three.free) == 9
    assert {tip.ball for tip in three.fingertips} == {0.01}
    assert not jaw.notes
    assert not three.notes


def test_a_joint_that_follows_moves_as_far_as_the_one_it_follows():
    jaw = model_of(JAW)
    at, facing = jaw.tips(jaw.positions({"left_joint": 0.03}))
    np.testing.assert_allclose(at, [[-0.03, 0, 0.115], [0.03, 0, 0.115]], atol=1e-12)
    np.testing.assert_allclose(facing, [[1, 0, 0], [-1, 0, 0]], atol=1e-12)


def test_jacobians_are_what_moving_a_joint_a_little_does():
    three, step = model_of(THREE), 1e-6
    q = three.completed(three.middle[three.free] + 0.1)
    tip = three.fingertips[1]
    jacobian = three.jacobian(q, tip.link, tip.at)
    for column in range(len(three.free)):
        moved = q.copy()
        moved[three.free[column]] += step
        change = (three.tips(moved)[0][1] - three.tips(q)[0][1]) / step
        np.testing.assert_allclose(jacobian[:, column], change, atol=1e-5)


def test_spin_jacobians_are_what_moving_a_joint_a_little_does():
    """R(q + dq) R(q)^T is I + [w dq]x, up to squares; and sliding jaws do not spin."""
    three, step = model_of(THREE), 1e-6
    q = three.completed(three.middle[three.free] + 0.1)
    link = three.fingertips[1].link
    spin, before = three.spin_jacobian(q, link), three.poses(q)[link].rotation
    assert np.abs(spin).max() > 0.5
    for column in range(len(three.free)):
        moved = q.copy()
        moved[three.free[column]] += step
        turn = (three.poses(moved)[link].rotation @ before.T - np.eye(3)) / step
        np.testing.assert_allclose(spin[:, column], [turn[2, 1], turn[0, 2], turn[1, 0]], atol=1e-5)
    jaw = model_of(JAW)
    np.testing.assert_allclose(jaw.spin_jacobian(jaw.middle, "left_pad"), 0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("wrong", "right", "problem"),
    [
        ("facing: [1, 0, 0]", "facing: [0, 0, 0]", "zero length"),
        ("along: [0, 1, 0]", "along: [1, 1, 0]", "not across"),
        (", along: [0, 1, 0]", "", "go together"),
        ("at: [0, 0, 0]", "at: [0, 0]", "at"),
        ("name: left", "nam: left", "nam"),
        ("pad: [0.022, 0.03]", "ball: 0.01, pad: [0.022, 0.03]", "not both"),
        ("hand/1", "layout/1", "schema"),
    ],
)
def test_files_that_are_wrong_are_refused_with_the_reason(tmp_path, wrong, right, problem):
    assert wrong in GOOD
    with pytest.raises(FileFormatError, match=problem):
        read_hand(_file(tmp_path, GOOD.replace(wrong, right)))


@pytest.mark.parametrize(
    ("wrong", "right", "problem"),
    [
        ("left_pad", "left_paw", "no link is called 'left_paw'; did you mean 'left_pad'"),
        ("fingertips:", "joints: [{{name: lef, effort: 1}}]\nfingertips:", "no movable joint is called 'lef'"),
        (
            "fingertips:",
            "joints: [{{name: left_joint, follows: right_joint}}]\nfingertips:",
            "joints follow each other in a circle",
        ),
        ("fingertips:", "joints: [{{name: left_joint, lower: 1, upper: 0}}]\nfingertips:", "no range"),
    ],
)
def test_what_the_model_does_not_have_is_named(tmp_path, wrong, right, problem):
    with pytest.raises((UnknownNameError, HandError), match=problem):
        load_hand(read_hand(_file(tmp_path, GOOD.replace(wrong, right))))


def test_a_model_that_drake_would_abort_on_is_an_error(tmp_path):
    model = tmp_path / "bad.urdf"
    model.write_text(
        '<robot name="bad"><link name="a"><collision><geometry><box size="-1 1 1"/></geometry></collision></link>'
        '<link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    with pytest.raises(HandError, match="Drake does not take this hand"):
        load_hand(read_hand(model))


@pytest.mark.parametrize("scale", ["a a a", "1 1", "nan 1 1", "0 1 1"])
def test_a_mesh_scale_that_is_none_is_an_error(tmp_path, scale):
    model = tmp_path / "scaled.urdf"
    mesh = f'<collision><geometry><mesh filename="m.stl" scale="{scale}"/></geometry></collision>'
    model.write_text(f'<robot name="scaled"><link name="a">{mesh}</link></robot>')
    with pytest.raises(FileFormatError, match=r"scaled\.urdf: mesh 'm\.stl': 'scale' cannot be"):
        load_hand(read_hand(model))


def test_jaws_that_nobody_coupled_are_said_to_move_on_their_own_and_a_hand_file_couples_them(tmp_path):
    model = tmp_path / "loose.urdf"
    text = JAW.read_text()
    model.write_text(text.replace('<mimic joint="left_joint" multiplier="1" offset="0"/>', ""))
    tips = model_of(JAW).hand.fingertips
    loose = load_hand(Hand("loose", model, tips))
    assert len(loose.free) == 2
    assert any("follows: left_joint" in note for note in loose.notes)
    coupled = load_hand(Hand("coupled", model, tips, joints={"right_joint": JointRule(follows="left_joint")}))
    assert len(coupled.free) == 1
    assert not coupled.notes


def test_joints_that_follow_are_not_set():
    with pytest.raises(HandError, match="'right_joint' follows 'left_joint'"):
        model_of(JAW).positions({"right_joint": 0.045, "left_joint": 0.03})


def test_a_hand_without_joints_is_none(tmp_path):
    model = tmp_path / "stiff.urdf"
    model.write_text('<robot name="stiff"><link name="a"/></robot>')
    with pytest.raises(HandError, match="nothing of this hand moves"):
        load_hand(read_hand(model))


def test_the_schema_tells_the_keys():
    schema = json_schema("hand")
    assert set(schema["required"]) == {"schema", "model"}
    assert "fingertips" in schema["properties"]


@pytest.mark.parametrize(("name", "tips"), list(zip(PUBLIC, (4, 3, 2, 2, 2, 1), strict=True)))
def test_public_hands_load_and_say_that_their_fingertips_are_guessed(name, tips):
    hand = public_hand(name)
    assert len(hand.fingertips) == tips
    assert any("guessed" in note for note in hand.notes)


def test_guessed_pads_are_those_of_the_gripper():
    robotiq = public_hand("robotiq")
    assert len(robotiq.free) == 1
    for tip in robotiq.fingertips:
        assert tip.pad == pytest.approx((0.022, 0.0375))
        np.testing.assert_allclose(tip.facing, [0, -1, 0])
