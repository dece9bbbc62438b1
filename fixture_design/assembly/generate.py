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
from fixture_design.assembly.sampling import onto_all, sample
from fixture_design.assembly.sorting import Sorted, State, joined
from fixture_design.assembly.symmetry import Symmetries
from fixture_design.assembly.symmetry_search import symmetries_of
from fixture_design.assembly.unfolding import Unfolded, unfolded
from fixture_design.assembly.unseen import unseen
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
    return _graph(assembly, known, counts, seed, finished)


def _search(
    known: KnownStates,
    counts: dict[State, int],
    rng: np.random.Generator,
    samples: int,
    progress: Callable[[str], None],
) -> None:
    start = known.representatives(sample(known.geometry, rng, known.symmetries))
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
    starts, kept = [geometry.random(rng, 0)], [np.zeros((0, len(geometry.names)), dtype=bool)]
    nearby = _NEARBY * np.linalg.norm(np.ptp(geometry.random(rng, 100)[:, :2], axis=0)) / weights(geometry)
    for known_samples in known.samples.values():
        near = known_samples.q[rng.integers(len(known_samples), size=_MORE_NEAR)]
        near = geometry.moved(near, np.where(geometry.free, rng.normal(size=(len(near), len(nearby))) * nearby, 0.0))
        starts.append(np.vstack([geometry.random(rng, _MORE_RANDOM), near]))
        kept.append(np.repeat((known_samples.touching[0] & geometry.takes_part)[None], len(starts[-1]), axis=0))
    return onto_all(geometry, np.concatenate(starts), np.concatenate(kept))


def _graph(
    assembly: Assembly, known: KnownStates, counts: dict[State, int], seed: int, finished: bool
) -> ContactStateGraph:
    geometry, found = known.geometry, unfolded(known)
    # N1 stands for no contact, also where the region leaves no room for it
    first = 1 if not found.states or found.states[0] == () else 2
    ids = [f"N{number}" for number in range(first, first + len(found.states))]
    edges = map(
        StateTransition,
        [ids[k] for k in found.tight.tolist()],
        [ids[k] for k in found.loose.tolist()],
        geometry.canonical(found.q),
        found.displacements,
    )
    return ContactStateGraph(
        assembly, _states(geometry, ids, found), tuple(edges), unseen(found.states, counts), seed, finished
    )


def _states(geometry: ContactGeometry, ids: list[str], found: Unfolded) -> tuple[ContactState, ...]:
    if not ids:
        return ()
    coincident = geometry.coincident(np.array([q[0] for q in found.samples]), APART * geometry.size)
    ends = np.cumsum([len(q) for q in found.samples])
    samples = np.split(geometry.canonical(np.concatenate(found.samples)), ends[:-1])
    return tuple(map(ContactState, ids, found.states, coincident.tolist(), samples))
