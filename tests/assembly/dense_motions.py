"""Transitions by another route: many random motions from many configurations of each state, no cones and no modes.

A motion holds a random choice of what touches. Where it ends in a state with fewer contacts, and is in that state at
every part of the way that is looked at, the first state borders on the second.
"""

from __future__ import annotations

import numpy as np

from fixture_design.assembly import ContactStateGraph
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.following import held
from fixture_design.assembly.sampling import onto
from fixture_design.assembly.sorting import Sorted, joined, sort_configurations, states_of

State = tuple[str, ...]


def borders(graph: ContactStateGraph, geometry: ContactGeometry, seed: int, count: int) -> set[tuple[State, State]]:
    """(Tighter, looser) pairs of states that ``count`` motions from each state show."""
    rng = np.random.default_rng(seed)
    found: set[tuple[State, State]] = set()
    for state in graph.states:
        if state.contacts:
            start = _more(geometry, rng, state.contacts, state.samples)
            found |= {(state.contacts, looser) for looser in _moved(geometry, rng, start, count)}
    return found


def _more(geometry: ContactGeometry, rng: np.random.Generator, contacts: State, samples: np.ndarray) -> Sorted:
    """Hundreds of configurations of a state: from anywhere, and wandering from one to the next."""
    pairs = np.array([geometry.names.index(name) for name in contacts])
    found = [sort_configurations(geometry, samples)]
    for _ in range(4):
        known = joined(found).q
        near = known[rng.integers(len(known), size=100)]
        step = rng.normal(size=(100, geometry.dimension)) * geometry.radius * 10.0 ** rng.uniform(-5, -1, (100, 1))
        step = np.where(geometry.free, step / weights(geometry), 0.0)
        starts = np.vstack([geometry.moved(near, step), geometry.random(rng, 50)])
        more = onto(geometry, starts, np.repeat(pairs[None], len(starts), axis=0))
        found.append(more[np.array([other == contacts for other in states_of(geometry, more.touching)], dtype=bool)])
    return joined(found)


def _moved(geometry: ContactGeometry, rng: np.random.Generator, start: Sorted, count: int) -> set[State]:
    tight = start[rng.integers(len(start), size=count)]
    kept = _padded(tight.touching & (rng.random(tight.touching.shape) < rng.uniform(0, 1, (count, 1))))
    ways = np.where(geometry.free, rng.normal(size=(count, geometry.dimension)), 0.0) * 10.0 ** rng.uniform(
        -2, 0, (count, geometry.dimension)
    )
    lengths = geometry.radius * 10.0 ** rng.uniform(-5, -2, (count, 1))
    ways *= lengths / np.linalg.norm(ways, axis=1, keepdims=True) / weights(geometry)
    ends, arrived = held(geometry, geometry.moved(tight.q, ways), kept)
    loose = sort_configurations(geometry, ends)
    fewer = (loose.touching <= tight.touching).all(axis=1) & (loose.touching != tight.touching).any(axis=1)
    rows = np.flatnonzero(arrived & loose.clear & fewer)
    tight, loose = tight[rows], loose[rows]
    return set(states_of(geometry, loose.touching[_is_a_path(geometry, tight, loose)]))


def _is_a_path(geometry: ContactGeometry, tight: Sorted, loose: Sorted) -> np.ndarray:
    way, kept = geometry.between(tight.q, loose.q), _padded(loose.touching)
    length = np.linalg.norm(way * weights(geometry), axis=1)
    good = np.ones(len(way), dtype=bool)
    for share in (0.003, 0.01, 0.03, 0.1, 0.3, 0.6):
        aim = geometry.moved(tight.q, share * way)
        q, arrived = held(geometry, aim, kept)
        found = sort_configurations(geometry, q)
        good &= arrived & found.admissible & (loose.touching <= found.touching).all(axis=1)
        good &= (found.touching <= tight.touching).all(axis=1)
        if share < 0.03:  # where contacts held are held beside it, and not at some other place
            good &= np.linalg.norm(geometry.between(aim, q) * weights(geometry), axis=1) <= 0.2 * share * length
        else:
            good &= (found.touching == loose.touching).all(axis=1)
    return good


def _padded(touching: np.ndarray) -> np.ndarray:
    order = np.argsort(~touching, axis=1, kind="stable")[:, : max(1, int(touching.sum(axis=1).max(initial=0)))]
    return np.where(np.take_along_axis(touching, order, axis=1), order, -1)
