"""The share of pose errors: told at other poses than those that chose, and the same without shortcuts."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from fixture_design.geometry import load_part
from fixture_design.geometry.surface import SolidSurface
from fixture_design.grasp import PoseError
from fixture_design.grasp import robustness as of
from fixture_design.grasp.finds import Finds
from fixture_design.grasp.judging import Site, drafted
from fixture_design.grasp.posture import Posture
from fixture_design.layout import Part, Pose
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


@pytest.mark.parametrize(("told", "count"), [(False, of.POSES), (True, of.POSES_TOLD)])
def test_poses_that_are_told_are_not_those_that_choose(monkeypatch, told, count):
    part, geometry = primitive("cube")
    site, model = Site.of(part, geometry), model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))
    seen = []
    monkeypatch.setattr(of, "_small", lambda shift, turn, center: seen.append(shift) or Pose.identity(3))
    # some close and some do not, so that all poses are looked at
    monkeypatch.setattr(of, "_closes", lambda contacts, surface: len(seen) % 2 == 0)
    of.robust_share(posture, part.pose, site.surface, model.fingertips, PoseError(), 0, told=told)
    assert len(seen) == count
    other = len(seen)
    of.robust_share(posture, part.pose, site.surface, model.fingertips, PoseError(), 0, told=not told)
    first, second = np.array(seen[:other]), np.array(seen[other:])
    assert np.abs(first[:, None] - second[None]).max(axis=2).min() > 1e-9


@pytest.mark.parametrize("sections", [16, 64])
def test_what_is_told_by_the_way_to_the_surface_changes_nothing(monkeypatch, tmp_path, sections):
    """On a cylinder of facets, where places between chord and circle are inside of the one and outside of the other."""
    file = tmp_path / "rod.stl"
    trimesh.creation.cylinder(0.02, 0.08, sections=sections).export(file)
    part = Part("rod", "mesh", file, None, 1.0, Pose.identity(3))
    surface, model = SolidSurface(load_part(part)), model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.02}), at(0, 0, -0.1))
    kept = []

    def count(contacts, surface):
        kept.append(len(contacts))
        return len(kept) % 2 == 0

    monkeypatch.setattr(of, "_closes", count)
    of.robust_share(posture, part.pose, surface, model.fingertips, PoseError(), 0)
    monkeypatch.setattr(of, "_faces_away", lambda *given: False)
    of.robust_share(posture, part.pose, surface, model.fingertips, PoseError(), 0)
    assert kept[: of.POSES] == kept[of.POSES :]
    assert sum(kept) > 0
