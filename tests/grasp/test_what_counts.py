"""What counts as a grasp's contacts: of a search the fingertips, of a hand where it is all that touches."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.cli.grasp_report import grasps_in_words
from fixture_design.grasp import HandModel, Posture, Search, load_hand, posed
from fixture_design.grasp.hand import Fingertip, Hand
from fixture_design.grasp.judging import Draft, Site, drafted
from fixture_design.grasp.search import grasp
from fixture_design.layout import Answer, Pose
from tests.grasp.hands import JAW, at, model_of, primitive, public_hand

#: Where the body of the jaw with balls passes an edge of the cube by less than the gap.
GRAZING = ([0.0, 0.05932773397, -0.08261358346], [-0.5925045642, 0.0, np.pi])

#: A flat box on a table, and pads that hang over its upper edge: their middles are above it.
OVERHANGING = ([0, 0, 0.133], [np.pi, 0, np.pi / 2])


@pytest.fixture(scope="module")
def balls(tmp_path_factory) -> HandModel:
    """The parallel jaw with two hard balls in place of its pads."""
    file = tmp_path_factory.mktemp("balls") / "balls.urdf"
    ball = '<origin xyz="-0.004 0 0"/><geometry><sphere radius="0.004"/></geometry>'
    text = JAW.read_text()
    for pad in ("left_pad", "right_pad"):
        start = text.index(f'<link name="{pad}">')
        end = text.index("</link>", start)
        link = re.sub(r"<visual>.*?</visual>", "", text[start:end], flags=re.DOTALL)
        link = re.sub(r"<collision>.*?</collision>", f"<collision>{ball}</collision>", link, flags=re.DOTALL)
        text = text[:start] + link + text[end:]
    file.write_text(text)
    tips = tuple(
        Fingertip(side, f"{side}_pad", np.array([-0.004, 0, 0]), np.array([1.0, 0, 0]), ball=0.004)
        for side in ("left", "right")
    )
    return load_hand(Hand("balls", file, tips))


def _grazing(model: HandModel) -> Posture:
    return Posture(model, model.positions({"left_joint": 0.02999799933}), Pose.from_xyz_rpy(*GRAZING))


def test_a_search_closes_with_fingertips_and_not_with_a_body_that_is_near(balls):
    part, geometry = primitive("cube")
    found = drafted(_grazing(balls), Site.of(part, geometry), balls.fingertips)
    assert isinstance(found, str)
    assert "two hard points leave a spin" in found


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 11])
def test_two_hard_balls_never_hold_a_cube(balls, seed):
    part, geometry = primitive("cube")
    result = grasp(balls, part, Search(seed=seed), geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert not result.grasps


def test_a_hand_where_it_is_counts_all_links_and_names_them(balls):
    part, geometry = primitive("cube")
    result = posed(_grazing(balls), part, geometry)
    assert result.satisfied is Answer.YES
    assert result.grasps[0].others == ("body",)
    assert any("force closed yes, counting body besides the fingertips" in line for line in grasps_in_words(result))


def test_links_near_the_part_are_noted_where_the_fingertips_close():
    """The body of the jaw lies on the cube, which the pads hold without it."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), Pose.from_xyz_rpy([0, 0, -0.09], [0, 0, 0]))
    found = drafted(posture, Site.of(part, geometry), model.fingertips)
    assert isinstance(found, Draft)
    assert set(found.touching.links.values()) == {"left_pad", "right_pad"}
    assert "body touches the part too, and is not counted" in found.touching.notes


def test_pads_that_overhang_the_part_are_as_robust_as_they_are():
    part, geometry = primitive("flat")
    part = replace(part, pose=at(0, 0, 0.006))
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.02}), Pose.from_xyz_rpy(*OVERHANGING))
    (found,) = posed(posture, part, geometry, table=0.0).grasps
    assert not found.layout.elements
    assert found.closed is Answer.YES
    assert found.robust is not None
    assert found.robust > 0.9
    draft = drafted(posture, Site.of(part, geometry), model.fingertips)
    assert isinstance(draft, Draft)
    assert len(set(draft.features)) == 2  # the two faces, not the edges where the pads end


def test_pads_larger_than_the_part_are_as_robust_as_they_are():
    """Pads of 75 x 20 mm on a cube of 30 mm: their corners are beside it at every pose."""
    part, geometry = primitive("small")
    result = grasp(public_hand("wsg"), part, Search(most=1), geometry)
    assert result.satisfied is Answer.YES
    assert result.grasps[0].robust is not None
    assert result.grasps[0].robust > 0.9
