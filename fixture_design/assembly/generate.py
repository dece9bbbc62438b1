"""Two parts in, their contact state graph out."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

import numpy as np

from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.bordering import look_nearer
from fixture_design.assembly.completion import complete, loosen
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.graph import ContactState, ContactStateGraph, StateTransition
from fixture_design.assembly.known_states import KnownStates
from fixture_design.assembly.round_space import RoundGeometry
from fixture_design.assembly.sampling import onto, sample
from fixture_design.assembly.sorting import Sorted, State, joined
from fixture_design.assembly.symmetry import Symmetries
from fixture_design.assembly.symmetry_search import symmetries_of
from fixture_design.assembly.unfolding import unfolded
from fixture_design.assembly.unseen import Unseen, unseen
from fixture_design.tolerances import APART

#: Samples of each state from which the search goes on.
_EXPANDED = 4

#: Starts for more samples of a state: from anywhere, and from near one that is known.
_MORE_RANDOM, _MORE_NEAR = 20, 20

#: How near, relative to the region [-].
_NEARBY = 0.2


def state_graph(
    assembly: Assembly,
    *,
    seed: int = 0,
    samples: int = 10,
    symmetric: bool = True,
    progress: Callable[[str], None] = lambda _: None,
) -> ContactStateGraph:
    """All contact states of an assembly and their direct transitions (chapter 3).

    The modified Monte Carlo method finds states, completion all those beside them, until nothing new appears.

    Args:
        seed: of the random starts; the same seed gives the same graph.
        samples: configurations kept of a state, at most.
        symmetric: whether of states that are images of each other by symmetries of both parts and the region one is
            searched, and the others are written down from it.
        progress: is told in words how far the search is.

    An interrupt (Ctrl-C) ends the search: the graph has what was found, and is not `complete`.

    Raises:
        AssemblyError: bodies or names that cannot be used.
        UnsupportedError: shapes that this version has no contact pairs for.
    """
    geometry = geometry_of(assembly)
    symmetries = symmetries_of(geometry) if symmetric else Symmetries.none(len(geometry.names))
    known = KnownStates(geometry, symmetries, _EXPANDED)
    counts: dict[State, int] = {}
    finished = False
    with suppress(KeyboardInterrupt):  # what was found is kept, and `complete` tells
        _search(known, counts, np.random.default_rng(seed), samples, progress)
        finished = True
    known = unfolded(known)
    return _graph(assembly, known, unseen(known.samples, counts), seed, finished)


def _search(
    known: KnownStates,
    counts: dict[State, int],
    rng: np.random.Generator,
    samples: int,
    progress: Callable[[str], None],
) -> None:
    start = known.representatives(sample(known.geometry, rng))
    counts.update({state: len(rows) for state, rows in known.by_state(start).items()})
    fresh, _ = known.add(start)
    progress(f"{len(start)} of the random starts ended in {len(counts)} states")
    complete(known, fresh, rng, progress)
    known.most = max(samples, _EXPANDED)
    fresh, new = known.add(_more(known, rng))
    more, beside = known.add(loosen(known, fresh))
    if new or beside:
        complete(known, joined([fresh, more]), rng, progress)
    if isinstance(known.geometry, RoundGeometry):
        look_nearer(known)


def _more(known: KnownStates, rng: np.random.Generator) -> Sorted:
    """More configurations of each state: its equations solved from random starts, and from near its samples."""
    geometry = known.geometry
    found = []
    nearby = _NEARBY * np.linalg.norm(np.ptp(geometry.random(rng, 100)[:, :2], axis=0)) / weights(geometry)
    for known_samples in known.samples.values():
        near = known_samples.q[rng.integers(len(known_samples), size=_MORE_NEAR)]
        near = geometry.moved(near, np.where(geometry.free, rng.normal(size=(len(near), len(nearby))) * nearby, 0.0))
        starts = np.vstack([geometry.random(rng, _MORE_RANDOM), near])
        pairs = np.flatnonzero(known_samples.touching[0] & geometry.takes_part)
        found.append(onto(geometry, starts, np.repeat(pairs[None], len(starts), axis=0)))
    return joined(found)


def _graph(assembly: Assembly, known: KnownStates, rest: Unseen, seed: int, finished: bool) -> ContactStateGraph:
    geometry = known.geometry
    ordered = sorted(known.samples, key=lambda contacts: (len(contacts), contacts))
    # N1 stands for no contact, also where the region leaves no room for it
    first = 1 if not ordered or ordered[0] == () else 2
    ids = {contacts: f"N{number}" for number, contacts in enumerate(ordered, start=first)}
    states = tuple(_state(geometry, ids[contacts], contacts, known.samples[contacts]) for contacts in ordered)
    between = [pair for pair in known.transitions if pair[0] in ids and pair[1] in ids]
    q = geometry.canonical(np.array([known.transitions[pair].q for pair in between])) if between else []
    edges = [
        StateTransition(ids[pair[0]], ids[pair[1]], at, known.transitions[pair].displacement)
        for pair, at in zip(between, q, strict=True)
    ]
    edges.sort(key=lambda edge: (int(edge.loose[1:]), int(edge.tight[1:])))
    return ContactStateGraph(assembly, states, tuple(edges), rest, seed, finished)


def _state(geometry: ContactGeometry, name: str, contacts: State, found: Sorted) -> ContactState:
    coincident = bool(geometry.coincident(found.q[:1], APART * geometry.size)[0])
    return ContactState(name, contacts, coincident, geometry.canonical(found.q))
