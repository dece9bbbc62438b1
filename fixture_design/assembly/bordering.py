"""Which states border on which, looked at pair by pair once all states are known.

Contact modes are of first order. Where several pairs touch in one point with one normal (a circle on a rim, tangent to
the wall and to what goes on above it), the first order keeps or leaves all of them together: which of them a motion
leaves is told by how it passes the ends of the features, and the motions that leave some may fill a thin sector only.

A state borders on one with fewer contacts exactly if some of the latter's configurations come as near as one likes to
one of its own. So for every two known states with the contacts of one among those of the other, and no transition
between them yet, configurations of the looser are moved onto all contacts of the tighter, and those of the tighter a
little aside and onto the contacts of the looser; each that arrives is followed like any other transition.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.assembly.completion import connect, padded
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.following import held
from fixture_design.assembly.known_states import KnownStates
from fixture_design.assembly.sampling import onto
from fixture_design.assembly.sorting import Sorted, State, sort_configurations
from fixture_design.tolerances import APART, DEPENDENT

#: Shares of the way to a configuration of the looser state that are tried: a shorter one stays in one state.
_SHARES = (1.0, 0.3, 0.1, 0.03, 0.01)

#: How far aside configurations are moved, relative to the radius [-].
_ASIDE = (0.01, 0.003, 0.001)

#: Random directions aside, besides those along axes, and the seed of their numbers: they are the same for every search.
_DIRECTIONS, _SEED = 12, 11

#: Turns beside shifts, as lengths at the radius [-]: long bodies also turn about what is near to their contacts.
_TURNS = (1.0, 5.0)

#: What is left of a unit normal beside others that makes it an axis of its own [-].
_INDEPENDENT = 0.1

#: Moved onto its contacts, a configuration is not farther from where it began than this many times as far [-].
_NEAR = 3.0


def look_nearer(known: KnownStates) -> None:
    """Notes transitions between known states in space that the first order does not tell."""
    rng = np.random.default_rng(_SEED)
    for tight in sorted(known.samples, key=lambda state: (len(state), state)):
        for loose in _looser(known, tight):
            _back(known, tight, loose)
            if not _linked(known, tight, loose):
                _aside(known, tight, loose, rng)


def _looser(known: KnownStates, tight: State) -> list[State]:
    """Known states with some of the contacts, to which no transition is known."""
    return sorted(state for state in known.samples if set(state) < set(tight) and not _linked(known, tight, state))


def _linked(known: KnownStates, tight: State, loose: State) -> bool:
    return bool(known.linked(known.samples[tight].touching[:1], known.samples[loose].touching[:1])[0])


def _chosen(found: Sorted, count: int) -> np.ndarray:
    """The pairs of a state, once for each of some configurations; none: -1."""
    return np.repeat(padded(found.touching[:1]), count, axis=0)


def _back(known: KnownStates, tight: State, loose: State) -> None:
    """From configurations of the looser state onto all contacts of the tighter, and some of the way back."""
    geometry, many, few = known.geometry, known.samples[tight], known.samples[loose]
    pairs = _chosen(many, 1)[0]
    for k in range(len(few)):
        begins = onto(geometry, few.q[k : k + 1], pairs[None])
        begins = begins[(begins.touching == many.touching[0]).all(axis=1)]
        if len(begins):
            begins = begins[np.zeros(len(_SHARES), dtype=int)]
            way = geometry.between(begins.q, np.repeat(few.q[k : k + 1], len(_SHARES), axis=0))
            _try(known, begins, np.array(_SHARES)[:, None] * way, few)


def _aside(known: KnownStates, tight: State, loose: State, rng: np.random.Generator) -> None:
    geometry, many, few = known.geometry, known.samples[tight], known.samples[loose]
    turned = geometry.aligned(many.q) if geometry.coincident(many.q[:1], APART * geometry.size)[0] else many.q[:0]
    special = onto(geometry, turned, _chosen(many, len(turned)), turning=False)
    special = special[(special.touching == many.touching[0]).all(axis=1)]
    for begins in (special, many):
        if len(begins) and not _linked(known, tight, loose):
            ways = _ways(known, begins, rng)
            _try(known, begins[np.repeat(np.arange(len(begins)), len(ways) // len(begins))], ways, few)


def _ways(known: KnownStates, begins: Sorted, rng: np.random.Generator) -> np.ndarray:
    """Displacements of each configuration, (n k, d): along the axes of its contacts, by two of them, and others."""
    geometry = known.geometry
    drawn = rng.normal(size=(_DIRECTIONS, geometry.dimension))
    special = _by_two(np.eye(geometry.dimension), geometry)
    found = []
    for frame in _frames(geometry, begins):
        directions = np.vstack([special @ frame, -special @ frame, drawn / np.linalg.norm(drawn, axis=1)[:, None]])
        lengths = np.array(_ASIDE)[:, None, None] * geometry.radius
        found.append(np.where(geometry.free, lengths * directions, 0.0).reshape(-1, geometry.dimension))
    return np.concatenate(found) / weights(geometry)


def _by_two(axes: np.ndarray, geometry: ContactGeometry) -> np.ndarray:
    """The axes, and sums and differences of any two; turns beside shifts by several shares."""
    first, second = np.triu_indices(len(axes), 1)
    turning = np.zeros(len(axes), dtype=bool)
    turning[geometry.turns] = True
    rows = [axes]
    for share in _TURNS:
        chosen = (turning[first] != turning[second]) if share != 1.0 else slice(None)
        one, two = axes[first[chosen]], share * axes[second[chosen]]
        rows += [one + two, one - two]
    found = np.vstack(rows)
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def _frames(geometry: ContactGeometry, begins: Sorted) -> Iterator[np.ndarray]:
    """Orthonormal displacements (6, 6) along and about the normals of what touches, and what is square to them."""
    pairs = _chosen(begins, 1)
    for vectors in geometry.equations(begins.q, pairs).face_vectors:
        rows: list[np.ndarray] = []
        lengths = np.delete(vectors, geometry.turns, axis=1)
        for row in np.vstack([lengths, np.eye(lengths.shape[1])]):
            rest = row / max(np.linalg.norm(row), DEPENDENT)
            for other in rows:
                rest = rest - (rest @ other) * other
            if np.linalg.norm(rest) > _INDEPENDENT:
                rows.append(rest / np.linalg.norm(rest))
        yield np.kron(np.eye(2), np.array(rows))


def _try(known: KnownStates, begins: Sorted, ways: np.ndarray, few: Sorted) -> None:
    """Follows straight motions that hold the contacts of the looser state."""
    geometry = known.geometry
    aims = geometry.moved(begins.q, ways)
    ends, arrived = held(geometry, aims, _chosen(few, len(aims)))
    found = sort_configurations(geometry, ends)
    gone = np.linalg.norm(geometry.between(begins.q, ends) * weights(geometry), axis=1)
    good = arrived & found.clear & (found.touching == few.touching[0]).all(axis=1)
    good &= gone <= _NEAR * np.linalg.norm(ways * weights(geometry), axis=1)
    connect(known, begins[good], found[good])
