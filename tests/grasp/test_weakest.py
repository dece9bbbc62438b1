"""The worst direction: known answers, and no direction that is worse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.grasp import HandModel, Posture, grasp_at
from fixture_design.grasp.torques import Drives
from fixture_design.grasp.weakest import weakest
from fixture_design.layout import Answer, Pose
from tests.grasp.hands import JAW, at, model_of, primitive


def _drives(model: HandModel, pose: Pose) -> Drives:
    part, geometry = primitive("cube")
    found = grasp_at(Posture(model, model.positions({"left_joint": 0.03}), pose), part, geometry)
    return Drives.of(found.posture, found.verdict.contacts, found.links, found.center)


@pytest.mark.parametrize("pose", [at(0, 0, -0.115), at(0.0, 0.003, -0.11)])
def test_no_direction_is_worse(pose):
    drives = _drives(model_of(JAW), pose)
    worst = weakest(drives)
    rng = np.random.default_rng(0)
    for _ in range(200):
        way = rng.standard_normal(3)
        held = drives.largest(np.append(way / np.linalg.norm(way), np.zeros(3)))
        assert held is not None
        assert held.factor >= worst.force - 1e-6
    held = drives.largest(np.append(worst.direction, np.zeros(3)))
    assert held is not None
    assert held.factor == pytest.approx(worst.force, rel=1e-5)
    # the pyramids of 8 edges in cones of 40 N: least in the middle between two edges, which is none of a cube's
    assert worst.force == pytest.approx(40 * np.cos(np.pi / 8), rel=1e-5)


def test_drives_without_limits_hold_anything():
    model = model_of(JAW)
    endless = replace(model, joints=tuple(replace(joint, effort=np.inf) for joint in model.joints))
    assert weakest(_drives(endless, at(0, 0, -0.115))).force == np.inf


def test_one_finger_holds_nothing_the_other_way():
    drives = _drives(model_of(JAW), at(0, 0, -0.115))
    one = Contact.on_facet("left", "finger", [-0.03, 0, 0], [-1.0, 0, 0], 0.5)
    part, geometry = primitive("cube")
    model = model_of(JAW)
    found = grasp_at(Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115)), part, geometry)
    assert found.closed is Answer.YES
    single = Drives.of(found.posture, (one,), found.links, found.center)
    worst = weakest(single)
    assert worst.force == 0.0
    held = single.largest(np.append(worst.direction, np.zeros(3)))
    assert held is None or held.factor == pytest.approx(0.0, abs=1e-6)
    assert weakest(drives).force > 0
