"""The peg and the hole of section 3.4: the states, Table 4, Table 5, and transitions that are true ones."""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, state_at, state_graph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.io import read_assembly
from tests.assembly.parts import FIGURE_14
from tests.problems import FIGURE_14_TABLE_4, FIGURE_14_TABLE_5, FIGURE_14_TABLE_5_CONTACTS


@pytest.fixture(scope="module")
def graph() -> ContactStateGraph:
    return state_graph(read_assembly(FIGURE_14))


def edges(graph: ContactStateGraph) -> set[tuple[tuple[str, ...], tuple[str, ...]]]:
    return {(graph.state(edge.loose).contacts, graph.state(edge.tight).contacts) for edge in graph.transitions}


def test_the_states_are_those_of_the_thesis(graph: ContactStateGraph) -> None:
    apart = [state for state in graph.states if not state.coincident]
    assert len(apart) == 21
    assert len(graph.states) == 21 + 8
    for contacts in FIGURE_14_TABLE_4:
        state = graph.with_contacts(contacts)
        assert state is not None, contacts
        assert not state.coincident
    assert graph.with_contacts(["apex 3 - facet 5", "apex 4 - facet 8"]) is None  # (3-36)


def test_names_and_order(graph: ContactStateGraph) -> None:
    assert graph.states[0].id == "N1"
    assert graph.states[0].contacts == ()
    keys = [(len(state.contacts), state.contacts) for state in graph.states]
    assert keys == sorted(keys)
    assert [state.id for state in graph.states] == [f"N{k}" for k in range(1, 30)]


@pytest.mark.parametrize("name", FIGURE_14_TABLE_5)
def test_table_5_is_in_its_states(name: str) -> None:
    assembly = read_assembly(FIGURE_14)
    for configuration in FIGURE_14_TABLE_5[name]:
        found = state_at(assembly, configuration, within=1e-5)
        assert found.contacts == FIGURE_14_TABLE_5_CONTACTS[name]
        assert found.admissible
        assert not found.coincident


def test_every_sample_touches_exactly_so(graph: ContactStateGraph) -> None:
    """Checked with plain geometry: distances between points and segments, one at a time."""
    for state in graph.states:
        for configuration in state.samples:
            assert touching(configuration) == set(state.contacts), (state.id, configuration)
            assert state_at(graph.assembly, configuration).admissible


def touching(q: np.ndarray) -> set[str]:
    c, s = np.cos(q[2]), np.sin(q[2])
    R = np.array([[c, -s], [s, c]])
    moving = np.array([[-1, 0], [1, 0], [1, 30], [-1, 30]]) @ R.T + q[:2]
    left, right = [[-1.5, -30], [-1.5, 0], [-30, 0]], [[30, 0], [1.5, 0], [1.5, -30]]
    facets = {"facet 6": left[:2], "facet 5": left[1:], "facet 8": right[:2], "facet 7": right[1:]}
    apices = {"apex 1": left[1], "apex 2": right[1]}
    mine = {"apex 3": moving[0], "apex 4": moving[1]}
    my_facets = {"facet 3": moving[:2], "facet 4": moving[1:3], "facet 2": moving[[3, 0]]}
    near = 1e-7
    found = {f"{a} - {f}" for a, p in mine.items() for f, ends in facets.items() if distance(p, ends) < near}
    return found | {
        f"{f} - {a}" for a, p in apices.items() for f, ends in my_facets.items() if distance(p, ends) < near
    }


def distance(point: np.ndarray, ends: np.ndarray) -> float:
    """(3-30), as it stands."""
    x, start, end = np.asarray(point, float), np.asarray(ends[0], float), np.asarray(ends[1], float)
    if (end - start) @ (x - start) < 0:
        return float(np.linalg.norm(x - start))
    if (start - end) @ (x - end) < 0:
        return float(np.linalg.norm(x - end))
    along = (end - start) / np.linalg.norm(end - start)
    return abs(float(along[0] * (x - start)[1] - along[1] * (x - start)[0]))


def test_transitions_are_nested_and_lead_where_they_say(graph: ContactStateGraph) -> None:
    """Theorem 6, and the witness: on the way from the tight state every configuration is in the loose one."""
    geometry = geometry_of(graph.assembly)
    for edge in graph.transitions:
        tight, loose = graph.state(edge.tight).contacts, graph.state(edge.loose).contacts
        assert set(loose) < set(tight)
        assert touching(edge.configuration) == set(tight)
        # near the start the displacement leaves what it must, to first or second order, and never overlaps
        chosen = np.flatnonzero([name in tight and name not in loose for name in geometry.names])
        gaps = []
        for share in (1.0, 0.5):
            q = edge.configuration + share * edge.displacement
            gaps.append(geometry.equations(q[None], chosen[None]).distances[0].min())
        assert min(gaps) > 1e-9


def test_seeds_give_the_same_graph(graph: ContactStateGraph) -> None:
    for seed in (1, 2):
        other = state_graph(graph.assembly, seed=seed, samples=4)
        assert [state.contacts for state in other.states] == [state.contacts for state in graph.states]
        assert edges(other) == edges(graph)


@pytest.mark.slow
def test_many_seeds_give_the_same_graph(graph: ContactStateGraph) -> None:
    for seed in range(3, 20):
        assert edges(state_graph(graph.assembly, seed=seed)) == edges(graph)


def test_the_same_seed_gives_the_same_samples() -> None:
    assembly = read_assembly(FIGURE_14)
    first, second = (state_graph(assembly, seed=7, samples=4) for _ in range(2))
    for one, other in zip(first.states, second.states, strict=True):
        np.testing.assert_array_equal(one.samples, other.samples)


def test_the_file_of_the_design(graph: ContactStateGraph, tmp_path: Path) -> None:
    assert graph.complete
    assert graph.unseen.found == 29
    assert 0 <= graph.unseen.chance < 0.1
