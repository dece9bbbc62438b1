"""A square peg in a square hole, turning up to 0.1 rad about any axis: too many states to count, so invariants."""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, geometry_of, rotations, state_graph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.sampling import onto
from fixture_design.assembly.sorting import sort_configurations, states_of
from tests.assembly.followed import followed
from tests.assembly.solids import prism
from tests.assembly.test_not_convex import HOLE, PLATE, spatial

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def graph(tmp_path_factory: pytest.TempPathFactory) -> ContactStateGraph:
    plate = prism(tmp_path_factory.mktemp("parts") / "plate.obj", PLATE, -2, 0, [HOLE])
    region: dict = {"x": [-0.15, 0.15], "y": [-0.15, 0.15], "z": [-0.4, 0.3], "rotation": 0.1}
    return state_graph(spatial({"box": [1, 1, 1]}, plate, **region), samples=4)


@pytest.fixture(scope="module")
def geometry(graph: ContactStateGraph) -> ContactGeometry:
    return geometry_of(graph.assembly)


def test_every_sample_touches_exactly_so(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    """By the package, and by the peg's corners: within the hole's walls, and those that touch one named so."""
    assert len(graph.states) > 100
    corners = np.array(list(np.ndindex(2, 2, 2))) - 0.5
    for state in graph.states:
        found = sort_configurations(geometry, state.samples)
        assert found.clear.all()
        assert set(states_of(geometry, found.touching)) == {state.contacts}
        placed = corners @ np.swapaxes(rotations.matrices(state.samples[:, 3:]), 1, 2) + state.samples[:, None, :3]
        walls = 0.6 - np.abs(placed[..., :2]).max(axis=-1)
        below = placed[..., 2] < 0
        assert walls[below].min() > -1e-8
        touching = ((walls < 1e-8) & below).any(axis=0)
        apices = {contact.split(" - ")[0] for contact in state.contacts if contact.startswith("apex")}
        assert apices == {f"apex {k + 1}" for k in np.flatnonzero(touching)}


def test_every_transition_has_a_feasible_path(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    """From its configuration along its displacement, with the contacts that stay held: all in the looser state."""
    for edge in graph.transitions:
        followed(graph, geometry, edge)


def test_a_search_by_other_sets_finds_nothing_new(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    """Some contacts of a state and some other pairs, from near one of its samples, and from anywhere: 60000 times."""
    rng = np.random.default_rng(7)
    known, seen = {state.contacts for state in graph.states}, set()
    configurations = np.vstack([state.samples for state in graph.states])
    touching = sort_configurations(geometry, configurations).touching
    samples = [(np.flatnonzero(row), q) for row, q in zip(touching, configurations, strict=True)]
    for count in (1, 2, 3):
        starts, sets = [], []
        for number in rng.integers(len(samples), size=20000):
            own, q = samples[number]
            some = rng.choice(own, size=min(3, len(own)), replace=False) if own.size else own
            row = [*some[: rng.integers(0, 4)], *rng.integers(len(geometry.names), size=count)]
            starts.append(q)
            sets.append(row + row[-1:] * (3 + count - len(row)))
        step = np.column_stack([rng.normal(size=(20000, 3)) * 0.05, rng.normal(size=(20000, 3)) * 0.03])
        found = onto(geometry, geometry.moved(np.array(starts), step), np.array(sets))
        seen.update(states_of(geometry, found.touching))
    assert seen - known == set()
    assert len(seen) > 0.5 * len(known)


@pytest.mark.timeout(1500)
def test_at_any_rotation_samples_and_transitions_are_what_they_say(tmp_path: Path) -> None:
    """Some 40,000 states, of which seeds find all but one or two in a hundred; every sample says again what touches."""
    plate = prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE])
    region: dict = {"x": [-0.15, 0.15], "y": [-0.15, 0.15], "z": [-0.9, 0.9]}
    graph = state_graph(spatial({"box": [1, 1, 1]}, plate, **region), samples=4)
    geometry, rng = geometry_of(graph.assembly), np.random.default_rng(0)
    assert len(graph.states) > 39_000
    some = [graph.states[k] for k in rng.choice(len(graph.states), 4000, replace=False)]
    found = sort_configurations(geometry, np.concatenate([state.samples for state in some]))
    assert found.clear.all()
    expected = [state.contacts for state in some for _ in state.samples]
    assert states_of(geometry, found.touching) == expected
    for k in rng.choice(len(graph.transitions), 500, replace=False):
        followed(graph, geometry, graph.transitions[k])
