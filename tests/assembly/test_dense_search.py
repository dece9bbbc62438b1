"""The graph of random polygons against an independent dense search: no state more or less, no transition missing."""

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, Region, state_graph
from tests.assembly.dense_search import DenseSearch, State
from tests.assembly.parts import of_polygons, random_polygon

ANYWHERE = Region(np.array([-3.0, -3.0]), np.array([3.0, 3.0]))


def compare(moving: np.ndarray, fixed: np.ndarray, seed: int) -> tuple[ContactStateGraph, int]:
    search = DenseSearch(moving, [fixed], 3.0)
    expected = search.states(16)
    graph = state_graph(of_polygons(moving, fixed, ANYWHERE), seed=seed, samples=4)
    contacts: dict[str, State] = {state.id: frozenset(state.contacts) for state in graph.states}
    assert set(contacts.values()) == set(expected)
    edges = {(contacts[edge.tight], contacts[edge.loose]) for edge in graph.transitions}
    assert search.transitions(expected) - edges == set()
    for edge in graph.transitions:  # each is confirmed by the search, where its witness is
        sizes = (1e-3, 1e-4, 1e-5)
        tight, loose = contacts[edge.tight], contacts[edge.loose]
        begins = (search.loosenings(edge.configuration, tight, size) for size in sizes)
        assert any(loose in found for found in begins), (edge.tight, edge.loose)
    return graph, len(expected)


def test_two_triangles() -> None:
    rng = np.random.default_rng(3)
    compare(random_polygon(rng, 3), random_polygon(rng, 3), seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_random_polygons(seed: int) -> None:
    """Three to five vertices, many of them not convex."""
    rng = np.random.default_rng(100 + seed)
    moving, fixed = random_polygon(rng, int(rng.integers(3, 5))), random_polygon(rng, int(rng.integers(3, 6)), 1.2)
    compare(moving, fixed, seed)
