"""Grasps in Drake's dynamics: one that is closed stays, one that hardly squeezes falls."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.grasp import Posture, grasp_at
from fixture_design.simulation.grasp_shake import Shake, shaken
from tests.grasp.hands import JAW, at, model_of, primitive


def _grasp():
    part, geometry = primitive("cube")
    model = model_of(JAW)
    return grasp_at(Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115)), part, geometry), geometry


def test_a_box_between_pads_stays_under_gravity_from_six_sides():
    found, geometry = _grasp()
    result = shaken(found, geometry, Shake(pull=0.3))
    assert not isinstance(result, str)
    assert result.holds
    assert result.moved.max() < 1e-3


@pytest.mark.slow
def test_a_box_that_is_hardly_squeezed_falls_across_the_jaws_and_not_along_them():
    found, geometry = _grasp()
    result = shaken(found, geometry, Shake(squeeze=0.5, pull=0.3))
    assert not isinstance(result, str)
    # +x, +y, +z, -x, -y, -z: the jaws are along x
    np.testing.assert_array_equal(result.held, [True, False, False, True, False, False])
