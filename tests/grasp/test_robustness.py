"""What is told of a grasp's robustness comes from other poses than those by which it was chosen."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.grasp import PoseError
from fixture_design.grasp import robustness as of
from fixture_design.grasp.finds import Finds
from fixture_design.grasp.judging import Site, drafted, judged
from fixture_design.grasp.posture import Posture
from tests.grasp.hands import JAW, at, model_of, primitive


@pytest.fixture
def lucky(monkeypatch):
    """Poses at which every other grasp closes, looked at by number; the first `POSES` of any choice always close."""
    told: list[int] = []

    def closes(contacts, surface):
        told.append(len(told))
        return len(told) <= of.POSES or len(told) % 2 == 0

    monkeypatch.setattr(of, "_closes", closes)
    return told


def test_grasps_that_are_kept_are_measured_again_at_more_poses(lucky):
    part, geometry = primitive("cube")
    site, model = Site.of(part, geometry), model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))
    draft = drafted(posture, site, model.fingertips)
    assert not isinstance(draft, str)
    finds = Finds(site, PoseError(), 0, None, lambda words, part: None)
    finds.judge([draft])
    (chosen,) = finds.best.values()
    assert chosen.robust == 1.0
    (told,) = finds.grasps(1)
    assert told.robust == pytest.approx(0.5)
    assert len(lucky) == of.POSES + of.POSES_TOLD


def test_poses_that_are_told_are_not_those_that_choose():
    chosen, told = (np.random.default_rng((0, which)).standard_normal(3) for which in (0, 1))
    assert not np.allclose(chosen, told)
    part, geometry = primitive("cube")
    site, model = Site.of(part, geometry), model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))
    draft = drafted(posture, site, model.fingertips)
    assert not isinstance(draft, str)
    # so large an error that some poses close and some do not
    error = PoseError(position=4e-3, rotation=0.2)
    first = judged(draft, site, error, 0).robust
    tips = model.fingertips
    again = of.robust_share(posture, part.pose, site.surface, tips, error, 0, told=True)
    assert first is not None
    assert 0 < again < 1
    assert again * of.POSES_TOLD == pytest.approx(round(again * of.POSES_TOLD))
