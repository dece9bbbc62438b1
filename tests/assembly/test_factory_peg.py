"""The rectangular peg of IsaacGym's factory over its hole, not turned: what any search must agree on."""

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, geometry_of, state_graph
from fixture_design.assembly.sampling import onto
from fixture_design.assembly.sorting import sort_configurations, states_of
from tests.assembly.followed import followed
from tests.assembly.test_not_convex import spatial
from tests.geometry.parts import SHARED

FOLDER = SHARED / "IsaacGymEnvs" / "assets" / "factory" / "mesh" / "factory_insertion"


def graph_of(seed: int) -> ContactStateGraph:
    if not FOLDER.is_dir():
        pytest.skip("needs the shared data")
    peg, hole = ({"mesh": str(FOLDER / f"factory_rectangular_{n}_8mm{k}_subdiv_3x.obj")}
                 for n, k in (("peg", "_loose"), ("hole", "")))  # fmt: skip
    region: dict = {"x": [-1e-3, 1e-3], "y": [-1e-3, 1e-3], "z": [4e-3, 11e-3], "rotation": "fixed"}
    return state_graph(spatial(peg, hole, **region), samples=4, seed=seed)


@pytest.mark.slow
def test_it_has_the_same_states_by_two_seeds_and_every_transition_is_a_path() -> None:
    first, second = graph_of(0), graph_of(1)
    assert {state.contacts for state in first.states} == {state.contacts for state in second.states}
    assert len(first.states) == 93
    ends = [{(g.state(e.loose).contacts, g.state(e.tight).contacts) for e in g.transitions} for g in (first, second)]
    assert ends[0] == ends[1]
    geometry = geometry_of(first.assembly)
    for edge in first.transitions:
        followed(first, geometry, edge)
    for state in first.states:
        found = sort_configurations(geometry, state.samples)
        assert found.clear.all()
        assert set(states_of(geometry, found.touching)) == {state.contacts}


@pytest.mark.slow
def test_random_starts_onto_random_pairs_find_nothing_new() -> None:
    graph = graph_of(0)
    geometry = geometry_of(graph.assembly)
    rng = np.random.default_rng(7)
    known = {state.contacts for state in graph.states}
    seen = set()
    for size in (1, 2, 3):
        sets = rng.integers(0, len(geometry.names), (8_000, size))
        seen |= set(states_of(geometry, onto(geometry, geometry.random(rng, len(sets)), sets).touching))
    assert seen <= known
    assert len(seen) > 5
