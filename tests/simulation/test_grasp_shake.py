"""Grasps in Drake's dynamics: one that is closed stays, one that hardly squeezes falls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.grasp import Posture, grasp_at
from fixture_design.simulation.grasp_shake import Shake, shaken
from tests.grasp.hands import JAW, at, model_of, primitive


def _grasp(friction=0.5, of_tips=None):
    """A cube between pads with the friction of the hand and of its fingertips."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    tips = tuple(replace(tip, friction=of_tips) for tip in model.fingertips)
    model = replace(model, hand=replace(model.hand, friction=friction), fingertips=tips)
    return grasp_at(Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115)), part, geometry), geometry


def test_a_box_between_pads_stays_under_gravity_from_six_sides():
    found, geometry = _grasp()
    result = shaken(found, geometry, Shake(pull=0.3))
    assert not isinstance(result, str)
    assert result.holds
    assert result.moved.max() < 1e-3


@pytest.mark.parametrize(("friction", "of_tips"), [(0.02, None), (0.5, 0.02)])
def test_a_box_between_slippery_pads_falls(friction, of_tips):
    """29.4 N in all and friction 0.02 carry 0.6 N at most: the box weighs 0.98 N."""
    found, geometry = _grasp(friction, of_tips)
    result = shaken(found, geometry, Shake(pull=0.3))
    assert not isinstance(result, str)
    np.testing.assert_array_equal(result.held, [True, False, False, True, False, False])


def test_tips_that_grip_better_than_their_hand_hold():
    found, geometry = _grasp(0.02, 0.5)
    result = shaken(found, geometry, Shake(pull=0.2))
    assert not isinstance(result, str)
    assert result.holds


@pytest.mark.slow
def test_a_box_that_is_hardly_squeezed_falls_across_the_jaws_and_not_along_them():
    found, geometry = _grasp()
    result = shaken(found, geometry, Shake(squeeze=0.5, pull=0.3))
    assert not isinstance(result, str)
    # +x, +y, +z, -x, -y, -z: the jaws are along x
    np.testing.assert_array_equal(result.held, [True, False, False, True, False, False])
