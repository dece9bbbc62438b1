"""The search: regions that see each other, grasps of known parts, and the reason where there is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fixture_design as fd
from fixture_design.contacts import Scale
from fixture_design.errors import InputError
from fixture_design.geometry import load_part
from fixture_design.grasp import Posture, Search, grasp_at, posed
from fixture_design.grasp.library import Spots, kabsch
from fixture_design.grasp.search import check_kinds, grasp
from fixture_design.grasp.spots import antipodal, closing_sets, opposite, regions_of, spread
from fixture_design.grasp.touching import touching
from fixture_design.layout import Answer, Part, Pose
from fixture_design.verification import check
from tests.grasp.hands import JAW, SHARED, THREE, at, model_of, primitive, public_hand

#: Few tries and grasps: what is found must be right, not plenty.
QUICK = Search(most=1, tries=40)


def test_a_cube_has_three_regions_as_wide_as_it_is():
    _, geometry = primitive("cube")
    points, pairs = opposite(geometry, spread(geometry, 0))
    regions = regions_of(geometry, points, pairs[antipodal(points, pairs, 0.5, flat=True)])
    assert len(regions) == 3
    for region in regions:
        np.testing.assert_allclose(region.widths, 0.06, atol=1e-12)


def test_faces_of_a_wedge_see_each_other_within_their_friction_cones_only(tmp_path):
    """Two sides of a wedge of 30 degrees: straight lines from one meet the other 30 degrees off its normal."""
    corners = [[0, 0], [1, 0], [np.cos(np.radians(30)), np.sin(np.radians(30))]]
    import trimesh
    from shapely import Polygon

    wedge = trimesh.creation.extrude_polygon(Polygon(0.06 * np.array(corners)), 0.06)
    wedge.export(tmp_path / "wedge.obj", digits=16)
    geometry = load_part(Part("wedge", "mesh", tmp_path / "wedge.obj", None, 1.0, Pose.identity(3)))
    points, pairs = opposite(geometry, spread(geometry, 0))
    sides = [tuple(sorted((points.features[one], points.features[other]))) for one, other in pairs.tolist()]
    slanted = np.array([abs(points.normals[one] @ points.normals[other]) < 0.99 for one, other in pairs])
    assert slanted.any()
    for friction, seen in ((0.3, False), (0.8, True)):
        found = antipodal(points, pairs, friction, flat=False)
        steep = slanted & (np.einsum("ij,ij->i", points.normals[pairs[:, 0]], points.normals[pairs[:, 1]]) < -0.8)
        assert found[steep].any() == seen, sides
    assert not antipodal(points, pairs, 0.8, flat=True)[slanted].any()


def test_sets_that_close_are_confirmed_by_the_verdict():
    _, geometry = primitive("sphere")
    points, scale = spread(geometry, 0), Scale(geometry.box_center, geometry.half_diagonal)
    sets, margins = closing_sets(points, scale, 0.5, 3, (0.02, 0.2), np.random.default_rng(0))
    assert len(sets) > 10
    assert (np.diff(margins) <= 0).all()
    for chosen in sets[[0, len(sets) // 2]]:
        contacts = tuple(
            fd.Contact.on_facet(f"F{k}", "finger", points.points[k], points.normals[k], 0.5) for k in chosen
        )
        verdict = fd.verify(fd.Layout("set", contacts=contacts, require={"all": ("force_closure",)}))
        assert verdict.satisfied is Answer.YES


def test_kabsch_finds_the_pose_that_was_used():
    rng = np.random.default_rng(0)
    pose = Pose.from_xyz_rpy(rng.standard_normal(3), rng.standard_normal(3))
    points = rng.standard_normal((5, 3))
    found, off = kabsch(points, pose.points(points))
    assert off < 1e-12
    np.testing.assert_allclose(found.rotation, pose.rotation, atol=1e-12)


@pytest.mark.parametrize(
    ("hand", "name"),
    [
        (JAW, "cylinder"),
        (THREE, "cube"),
        pytest.param(JAW, "sphere", marks=pytest.mark.slow),
        pytest.param(THREE, "sphere", marks=pytest.mark.slow),
        pytest.param(JAW, "cube", marks=pytest.mark.slow),
        pytest.param(THREE, "cylinder", marks=pytest.mark.slow),
    ],
)
def test_own_hands_grasp_primitives(hand, name):
    part, geometry = primitive(name)
    result = grasp(model_of(hand), part, QUICK, geometry)
    assert result.satisfied is Answer.YES
    for found in result.grasps:
        assert found.closed is Answer.YES
        assert check(found.verdict, found.layout) == []
        _stands(found, part, geometry)


def _stands(found, part, geometry):
    """What the search says is so: fingertips touch within their gap, nothing is inside, joints are in range."""
    posture = found.posture
    again = touching(posture, part, geometry)
    assert not again.overlaps, again.overlaps
    assert {e.name for e in again.layout.elements} == {e.name for e in found.layout.elements}
    assert posture.model.within(posture.q[None])[0]
    assert posture.model.collides_with_itself(posture.q) is None


@pytest.mark.slow
def test_a_part_that_moves_takes_its_grasps_along():
    """All families are found again; their best may be another, as pyramids in friction cones do not turn along."""
    part, geometry = primitive("cube")
    X_WP = Pose.from_xyz_rpy(np.array([0.3, -0.2, 0.5]), np.array([0.4, 0.2, 1.0]))
    here, there = (
        {found.features: found for found in grasp(model_of(JAW), at, replace(QUICK, most=3), geometry).grasps}
        for at in (part, replace(part, pose=X_WP))
    )
    assert here.keys() == there.keys()
    for features, found in here.items():
        assert there[features].closed is found.closed
        assert there[features].quality.epsilon == pytest.approx(found.quality.epsilon, rel=0.1)
        _stands(there[features], replace(part, pose=X_WP), geometry)


@pytest.mark.slow
def test_the_seed_decides():
    part, geometry = primitive("cylinder")
    one, other = (grasp(model_of(THREE), part, replace(QUICK, seed=3), geometry).grasps[0] for _ in range(2))
    np.testing.assert_array_equal(one.posture.q, other.posture.q)


def test_too_large_a_part_is_told_with_both_widths():
    part, geometry = primitive("large")
    result = grasp(model_of(JAW), part, QUICK, geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert "150 mm wide" in (result.reason or "")
    assert "100 mm" in (result.reason or "")
    assert {region.outcome for region in result.regions} == {"too wide"}


def test_hard_jaws_do_not_hold_a_ball_and_say_why():
    part, geometry = primitive("sphere")
    model = model_of(JAW)
    hard = replace(model, fingertips=tuple(replace(tip, soft=None) for tip in model.fingertips))
    result = grasp(hard, part, QUICK, geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert "spin about the line" in (result.reason or "")


def test_a_table_keeps_the_hand_above_it():
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, replace(QUICK, table=-0.03), geometry)
    assert result.grasps
    for found in result.grasps:
        poses = found.posture.links()
        lowest = min(
            poses[n].points(link.geometry.vertices)[:, 2].min() for n, link in found.posture.model.links.items()
        )
        assert lowest >= -0.0302


@pytest.mark.slow
def test_a_load_beyond_the_drives_is_not_held():
    part, geometry = primitive("cube")
    light = grasp(model_of(JAW), part, replace(QUICK, load=np.array([0, 0, -5.0, 0, 0, 0])), geometry)
    assert light.satisfied is Answer.YES
    heavy = grasp(model_of(JAW), part, replace(QUICK, load=np.array([500.0, 500.0, -500, 0, 0, 0])), geometry)
    assert heavy.satisfied is Answer.UNDECIDED
    assert heavy.reason == "no grasp that was found holds the load"


def test_cancelled_searches_return_what_there_is():
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, QUICK, geometry, cancelled=lambda: True)
    assert not result.grasps


def test_fd_grasp_is_the_search():
    part, _ = primitive("cube")
    result = fd.grasp(fd.read_hand(JAW), part, Search(most=1, tries=10))
    assert result.satisfied is Answer.YES
    again = grasp_at(result.grasps[0].posture, part, load_part(part))
    assert again.closed is Answer.YES


def test_spots_are_reached_as_prescribed():
    from fixture_design.grasp.library import Library
    from fixture_design.grasp.reach import Reach

    model = model_of(THREE)
    spots = Spots(
        np.array([[0.03, 0, 0], [-0.03, 0.015, 0], [-0.03, -0.015, 0]]), np.array([[1.0, 0, 0], [-1, 0, 0], [-1, 0, 0]])
    )
    library = Library.of(model, 3, np.random.default_rng(0))
    reach = Reach.of(model)
    solved = [(seed, reach.solve(spots, seed)) for seed in library.seeds(spots, 4)]
    seed, (q, X_PH) = next((seed, found) for seed, found in solved if found is not None)
    at, _ = Posture(model, q, X_PH).tips()
    np.testing.assert_allclose(at[list(seed.tips)], spots.points + 0.01 * spots.normals, atol=2e-5)


@pytest.mark.parametrize(
    "name",
    ["wsg", *(pytest.param(n, marks=pytest.mark.slow) for n in ("allegro", "barrett", "robotiq", "wsg with tip"))],
)
def test_public_hands_close_on_a_cube(name):
    part, geometry = primitive("cube")
    result = grasp(public_hand(name), part, Search(most=1), geometry)
    assert result.satisfied is Answer.YES
    _stands(result.grasps[0], part, geometry)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["allegro", "robotiq", "wsg", "wsg with tip"])
@pytest.mark.parametrize("shape", ["cylinder", "featuretype"])
def test_public_hands_close_on_more(name, shape):
    if shape == "featuretype":
        file = SHARED / "trimesh" / "models" / "featuretype.STL"
        part = Part(shape, "mesh", file, None, 0.0254 / 2, Pose.identity(3))
        geometry = load_part(part)
    else:
        part, geometry = primitive(shape)
    result = grasp(public_hand(name), part, Search(most=1), geometry)
    assert result.satisfied is Answer.YES
    _stands(result.grasps[0], part, geometry)


@pytest.mark.parametrize(
    ("wrong", "problem"),
    [({"most": 0}, "'most'"), ({"tries": 0}, "'tries'"), ({"seed": -1}, "'seed'"), ({"table": np.nan}, "'table'"),
     ({"load": np.zeros(3)}, "'load' is no wrench"), ({"load": np.full(6, np.inf)}, "'load' is no wrench")],
)  # fmt: skip
def test_searches_that_cannot_be_are_refused(wrong, problem):
    with pytest.raises(InputError, match=problem):
        Search(**wrong)


def test_names_of_files_are_no_hands_and_no_parts():
    part, _ = primitive("cube")
    with pytest.raises(InputError, match="no part"):
        check_kinds(model_of(JAW), "cube.stl")
    with pytest.raises(InputError, match="no hand"):
        check_kinds("jaw.urdf", part)


def test_one_fingertip_is_no_proof_that_nothing_holds():
    """The other pad is a link like any: it would hold against the one that is named."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    result = grasp(replace(model, fingertips=model.fingertips[:1]), part, QUICK, geometry)
    assert result.satisfied is Answer.UNDECIDED
    assert "one fingertip" in (result.reason or "")
    posture = Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.115))
    one = replace(posture, model=replace(model, fingertips=model.fingertips[:1]))
    assert posed(one, part, geometry).satisfied is Answer.YES


def test_regions_of_grasps_whose_verdicts_are_undecided_are_not_closed(monkeypatch):
    from fixture_design.grasp import result as results

    monkeypatch.setattr(results.Grasp, "closed", property(lambda found: Answer.UNDECIDED))
    part, geometry = primitive("cube")
    result = grasp(model_of(JAW), part, QUICK, geometry)
    assert result.grasps
    outcomes = {region.outcome for region in result.regions if region.features == result.grasps[0].features}
    assert outcomes == {"undecided"}
