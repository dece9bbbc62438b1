"""The transitions of round parts: the same at every seed and resolution, none missing, each a feasible path.

Where a circle is on a rim several pairs touch in one point with one normal, and what can follow is told by second order
only.
"""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import Assembly, ContactStateGraph, geometry_of, rotations, state_graph
from fixture_design.assembly.bordering import look_nearer
from fixture_design.assembly.known_states import KnownStates
from fixture_design.assembly.sorting import sort_configurations, states_of
from fixture_design.assembly.symmetry import Symmetries
from tests.assembly.dense_motions import borders
from tests.assembly.followed import followed
from tests.assembly.rounds import peg, plate
from tests.assembly.test_not_convex import spatial
from tests.assembly.test_round_peg import HOLE, REGION, THICK, graph_of, states, transitions
from tests.geometry.parts import SHARED

FOLDER = SHARED / "IsaacGymEnvs" / "assets" / "factory" / "mesh" / "factory_insertion"

#: Of circle 2, the upper end of the bevel: on the rim with the wall beside it, as it leans away or is upright.
LEANING = ("circle 2 - cylinder 2", "cone 1 - circle 5", "cylinder 1 - circle 5")
UPRIGHT = ("circle 2 - cylinder 2", "circle 2 - facet 4", "cone 1 - circle 5", "cylinder 1 - circle 5")
SIDEWAYS = ("circle 2 - circle 5", "circle 2 - cylinder 2", "cylinder 1 - circle 5")


def factory_peg() -> Assembly:
    if not FOLDER.is_dir():
        pytest.skip("needs the shared data")
    shape, around = (
        {"mesh": str(FOLDER / f"factory_round_{name}.obj"), "scale": 1}
        for name in ("peg_8mm_loose", "hole_8mm_subdiv_3x")
    )
    region: dict = {"x": [-1e-3, 1e-3], "y": [-1e-3, 1e-3], "z": [4e-3, 11e-3], "rotation": 0.1}
    return spatial(shape, around, **region)


@pytest.fixture(scope="module")
def graph() -> ContactStateGraph:
    return state_graph(factory_peg(), samples=4)


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_the_factory_peg(graph: ContactStateGraph) -> None:
    """What follows where a circle is on the rim, by hand: cell by cell around the point at which it is."""
    found = transitions(graph)
    assert (len(graph.states), len(found)) == (23, 64)
    # sideways: all three, any two, any one, none
    some = [(), *[(name,) for name in SIDEWAYS], *[tuple(x for x in SIDEWAYS if x != name) for name in SIDEWAYS]]
    assert {loose for tight, loose in found if tight == SIDEWAYS} == set(some)
    # leaning away, the cylinder cannot touch alone, nor with the wall: it leans from the rim
    assert {loose for tight, loose in found if tight == LEANING} == {(), LEANING[:1], LEANING[1:2]}
    # leaning towards the wall or upright, and only upright also what leans away, and sideways
    wall, cone, cylinder = LEANING
    expected = {(), (wall,), (cone,), (cylinder,), (wall, cylinder), LEANING}
    assert {loose for tight, loose in found if tight == UPRIGHT} == expected


@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_every_seed_finds_the_same(graph: ContactStateGraph, seed: int) -> None:
    other = state_graph(graph.assembly, samples=4, seed=seed)
    assert states(other) == states(graph)
    assert transitions(other) == transitions(graph)


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_each_transition_is_a_feasible_path(graph: ContactStateGraph) -> None:
    geometry = geometry_of(graph.assembly)
    for edge in graph.transitions:
        followed(graph, geometry, edge)


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_random_motions_show_no_other_transition(graph: ContactStateGraph) -> None:
    found = borders(graph, geometry_of(graph.assembly), seed=3, count=4000)
    assert found - transitions(graph) == set()
    assert len(found) >= 55


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_another_resolution(tmp_path: Path) -> None:
    """A bevelled peg at two resolutions of its mesh and the plate's."""
    bevelled, region = [(0.0, 0.7), (0.2, 0.9), (3.0, 0.9)], {"z": [-0.5, 0.3], "rotation": 0.2}
    coarse = graph_of(tmp_path, bevelled, 24, **region)
    fine = graph_of(tmp_path, bevelled, 96, **region)
    assert states(fine) == states(coarse)
    assert transitions(fine) == transitions(coarse)


def test_what_a_circle_on_a_rim_borders_on(tmp_path: Path) -> None:
    """A bevelled peg with the upper end of its bevel on the rim at (1, 0, 0): sideways, leaning away, upright."""
    bevelled = peg(tmp_path / "peg.obj", [(0.0, 0.7), (0.2, 0.9), (3.0, 0.9)], 24)
    geometry = geometry_of(spatial(bevelled, plate(tmp_path / "plate.obj", 4, THICK, HOLE, 24), **REGION))
    wall, cone, cylinder = "circle 2 - cylinder 2", "cone 1 - circle 4", "cylinder 1 - circle 4"
    sideways = tuple(sorted(("circle 2 - circle 4", wall, cylinder)))
    leaning, upright = (wall, cone, cylinder), tuple(sorted((wall, "circle 2 - facet 4", cone, cylinder)))
    known = KnownStates(geometry, Symmetries.none(len(geometry.names)), 4)
    a = 0.03
    at_rim, down, up = np.array([1.0, 0, 0]), np.array([1.0, 0, -0.05]), 0.1
    configurations = {
        sideways: _with_circle(at_rim, [a, 0, 0]),
        leaning: _with_circle(at_rim, [0, -a, 0]),
        upright: _with_circle(at_rim, [0, 0, 0]),
        (wall,): _with_circle(down, [0, -a, 0]),
        (cylinder,): _with_circle(at_rim, [0, a, 0], up),
    }
    for state, q in configurations.items():
        found = sort_configurations(geometry, q[None])
        assert found.clear.all()
        assert states_of(geometry, found.touching) == [state]
        known.add(found)
    look_nearer(known)
    expected = {(sideways, (wall,)), (sideways, (cylinder,)), (leaning, (wall,))}
    expected |= {(upright, (wall,)), (upright, (cylinder,)), (upright, leaning)}
    assert set(known.transitions) == expected


def _with_circle(point: np.ndarray, turn: list, above: float = 0.0) -> np.ndarray:
    """The peg turned, with the point of circle 2 that is farthest along x, or of the cylinder above it, at a point."""
    quaternion = rotations.from_vectors(np.array([turn], dtype=float))
    own = np.array([0.9, 0.0, 0.2 + above])
    return np.concatenate([point - rotations.matrices(quaternion)[0] @ own, quaternion[0]])
