"""How long a grasp takes, and how often the search finds one: own hands, primitives and public parts."""

from __future__ import annotations

import pytest

from fixture_design.geometry import load_part
from fixture_design.grasp import Search
from fixture_design.grasp.search import grasp
from fixture_design.layout import Answer, Part, Pose
from tests.grasp.hands import JAW, SHARED, THREE, model_of, primitive

#: Public parts with the factor that makes them of a size to be held in one hand.
PARTS = {
    "featuretype": ("trimesh/models/featuretype.STL", 0.0127),
    "angle_block": ("trimesh/models/angle_block.STL", 0.0127),
    "backing": ("airo-models/airo_models/grippers/fingertips/originals/backing.stl", 0.001),
    "faucetbase": ("metaworld/metaworld/assets/objects/meshes/faucet/faucetbase.stl", 1.0),
    "7_8ths_cube": ("trimesh/models/7_8ths_cube.stl", 0.001),
}

#: Seeds by which it is told how often a grasp is found.
SEEDS = 50


def public_part(name):
    path, scale = PARTS[name]
    if not (SHARED / path).is_file():
        pytest.skip(f"{path} does not lie beside the repository")
    part = Part(name, "mesh", SHARED / path, None, scale, Pose.identity(3))
    return part, load_part(part)


@pytest.mark.slow
@pytest.mark.parametrize("hand", [JAW, THREE], ids=["jaw", "three"])
@pytest.mark.parametrize("name", ["cube", "cylinder", "sphere"])
def test_a_grasp_of_a_primitive(benchmark, hand, name):
    part, geometry = primitive(name)
    arguments = (model_of(hand), part, Search(most=1), geometry)
    result = benchmark.pedantic(grasp, arguments, rounds=3, warmup_rounds=1)
    assert result.satisfied is Answer.YES


@pytest.mark.slow
@pytest.mark.parametrize("hand", [JAW, THREE], ids=["jaw", "three"])
@pytest.mark.parametrize("name", list(PARTS))
def test_a_grasp_of_a_public_part(benchmark, hand, name):
    part, geometry = public_part(name)
    arguments = (model_of(hand), part, Search(most=1), geometry)
    result = benchmark.pedantic(grasp, arguments, rounds=3, warmup_rounds=1)
    assert result.satisfied is Answer.YES


@pytest.mark.slow
@pytest.mark.parametrize("hand", [JAW, THREE], ids=["jaw", "three"])
def test_spheres_are_nearly_always_held(hand):
    part, geometry = primitive("sphere")
    found = [grasp(model_of(hand), part, Search(most=1, seed=k), geometry).satisfied for k in range(SEEDS)]
    assert found.count(Answer.YES) >= 0.98 * SEEDS
