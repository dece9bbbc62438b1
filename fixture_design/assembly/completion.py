"""From some states to all: what sampling misses is next to what it found.

Sampling alone misses thin states. From every state found, all its contact modes are followed (the states one loosening
away), and motions along its free directions until a new contact stops them, as well as its samples moved onto one more
contact equation (the states one tightening away), until nothing new appears.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.following import follow, held, propose
from fixture_design.assembly.known_states import KnownStates
from fixture_design.assembly.modes import contact_modes
from fixture_design.assembly.point_motions import point_motions
from fixture_design.assembly.round_space import RoundGeometry
from fixture_design.assembly.sampling import onto, onto_all
from fixture_design.assembly.sorting import Sorted, State, alike, joined, numbered, sort_configurations
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.assembly.tracing import trace
from fixture_design.tolerances import APART, TOUCHING

#: Random directions that are traced from a sample, besides those along the axes.
_DIRECTIONS = 6

#: Digits to which configurations are compared, so that each is followed once.
_SAME_DIGITS = 7

#: Configurations that are gone on from before what they led to is kept: an interrupt loses no more.
_TOGETHER = 256

#: Where straight motions are looked at [-].
_LOOKED_AT = (0.03, 0.1, 0.3, 0.6, 1.0)

#: Where it is looked at whether they begin as they go on, and how far aside they may be there, relative to the way [-].
_BEGINNING, _OFF_COURSE = (0.003, 0.01), 0.25

#: Starts for each state that only unclear configurations tell of, and how far beside these, relative to the radius [-].
_AGAIN, _BESIDE = 30, (0.01, 0.03, 0.1)

#: Generations after which the search ends in any case.
_MOST_GENERATIONS = 40


def complete(
    known: KnownStates, fresh: Sorted, rng: np.random.Generator, progress: Callable[[str], None] = lambda _: None
) -> None:
    """Goes on from samples until nothing new appears: no new state, and no room for more samples.

    Args:
        fresh: samples from which was not gone on yet.
    """
    seen: set[State] = set()
    for _ in range(_MOST_GENERATIONS):
        start = joined([fresh, _aligned(known, seen)])
        if not len(start):
            return
        kept = []
        for first in range(0, len(start), _TOGETHER):
            some = start[np.arange(first, min(first + _TOGETHER, len(start)))]
            found = [loosen(known, some), tighten(known, some, rng), aim(known.geometry, some), again(known, rng)]
            kept.append(known.add(joined(found))[0])
            left = len(start) - first - len(some)
            more = f", {left} configurations to go on from" if left else ""
            images = " up to symmetry" if len(known.symmetries) > 1 else ""
            progress(f"{len(known.samples)} states, {len(known.transitions)} transitions{images}{more}")
        fresh = joined(kept)


def _aligned(known: KnownStates, seen: set[State]) -> Sorted:
    """Configurations of states with two apices in one point where a facet of one part is along one of the other.

    Only there do such states border on those in which these facets slide along each other; elsewhere every contact of a
    state may be left alone, if their equations are independent.
    """
    geometry = known.geometry
    found = []
    for state in known.samples.keys() - seen:
        samples = known.samples[state]
        if geometry.coincident(samples.q[:1], APART * geometry.size)[0]:
            turned = geometry.aligned(samples.q)
            pairs = np.flatnonzero(samples.touching[0])
            found.append(onto(geometry, turned, np.repeat(pairs[None], len(turned), axis=0), turning=False))
            _, first = np.unique(np.round(found[-1].q, _SAME_DIGITS), axis=0, return_index=True)
            found[-1] = found[-1][first]
    seen.update(known.samples)
    return joined(found) if found else next(iter(known.samples.values()))[np.zeros(0, dtype=int)]


def loosen(known: KnownStates, start: Sorted) -> Sorted:
    """Follows contact modes of the configurations; notes the transitions, returns where they lead.

    One configuration of each state after the other: what led from one to a state is not followed again from another.
    """
    ends = [start[np.zeros(0, dtype=int)]]
    for rows in _one_of_each(known.representatives(start).touching):
        ends.append(_loosened(known, start[rows]))
    return joined(ends)


def _one_of_each(touching: np.ndarray) -> Iterator[Indices]:
    """The first of each state, the second of each, and so on."""
    number = numbered(alike(touching)[1])
    for k in range(int(number.max(initial=-1)) + 1):
        yield np.flatnonzero(number == k)


def _loosened(known: KnownStates, start: Sorted) -> Sorted:
    geometry = known.geometry
    rows, displacements, kept = _modes(geometry, start)
    fresh = np.flatnonzero(~known.linked(start.touching[rows], kept))
    proposed, unclear = propose(geometry, start[rows[fresh]], displacements[fresh], padded(kept[fresh]))
    known.doubt(unclear)
    ends, most = [start[np.zeros(0, dtype=int)]], 1
    # many motions lead from one state to one other: the first that does is enough
    while len(proposed := proposed[~known.linked(proposed.start.touching, proposed.decisive.touching)]):
        number = numbered(known.orbits(proposed.start.touching, proposed.decisive.touching))
        some = proposed[number < most]
        followed = follow(geometry, some)
        connect(known, some.start[followed.rows], followed.ends)
        ends.append(followed.ends)
        proposed, most = proposed[number >= most], 2 * most
    return joined(ends)


def tighten(known: KnownStates, start: Sorted, rng: np.random.Generator) -> Sorted:
    """Moves the configurations along free directions until something new touches; notes the transitions."""
    geometry = known.geometry
    directions = np.vstack([np.eye(geometry.dimension), -np.eye(geometry.dimension)])
    count = len(directions) + _DIRECTIONS
    rows = np.repeat(np.arange(len(start)), count)
    drawn = rng.normal(size=(len(start), _DIRECTIONS, geometry.dimension))
    wished = np.concatenate([np.broadcast_to(directions, (len(start), *directions.shape)), drawn], axis=1)
    stopped = trace(geometry, start[rows], padded(start.touching)[rows], wished.reshape(len(rows), -1))
    before = sort_configurations(geometry, stopped.before)
    connect(known, stopped.ends, before)
    return stopped.ends


def aim(geometry: ContactGeometry, start: Sorted) -> Sorted:
    """The configurations moved onto the equations that hold and one more: of another pair, or one's end."""
    found = [start]
    counts = start.touching.sum(axis=1)
    # those with as many contacts together, so that none is solved with more equations than it has
    for count in np.unique(counts).tolist():
        rows = np.flatnonzero(counts == count)
        kept = np.nonzero(start.touching[rows])[1].reshape(len(rows), count)
        row, other = np.nonzero(~start.touching[rows] & geometry.takes_part)
        found.append(onto(geometry, start.q[rows][row], np.column_stack([kept[row], other])))
        row, place = np.nonzero(geometry.ending[kept])
        at_end = kept[row] + len(geometry.names) * (np.arange(count) == place[:, None])
        found.append(onto(geometry, start.q[rows][row], at_end))
    return joined(found)


def _modes(geometry: ContactGeometry, start: Sorted) -> tuple[Indices, np.ndarray, np.ndarray]:
    """Which configuration, its motion (angles times the radius), and whether it keeps each pair, shape (n, P)."""
    everything = np.arange(len(geometry.names))[None]
    vectors = geometry.equations(start.q, everything).face_vectors / weights(geometry)
    ends = geometry.at_apices(start.q, TOUCHING * geometry.size)
    turns = np.zeros(geometry.dimension, dtype=bool)
    turns[geometry.turns] = True
    rows = [np.zeros(0, dtype=int)]
    displacements = [np.zeros((0, geometry.dimension))]
    kept = [start.touching[:0]]
    for k, touching in enumerate(start.touching):
        pairs = np.flatnonzero(touching)
        if not pairs.size:
            continue
        at_end = ends[k, pairs]
        points = None
        if isinstance(geometry, SpatialGeometry):
            points = point_motions(geometry, start.q[k], pairs[at_end], vectors[k, pairs[at_end], :3])
        found = geometry.rows(start.q[k], pairs, vectors[k, pairs], at_end)
        modes = contact_modes(found.vectors, found.at_end, geometry.free, turns, points)
        if modes:
            rows.append(np.full(len(modes), k))
            displacements.append(np.array([mode.displacement for mode in modes]))
            kept.append(np.zeros((len(modes), len(touching)), dtype=bool))
            kept[-1][:, pairs] = found.pairs_kept(np.array([mode.kept for mode in modes]))
    return np.concatenate(rows), np.concatenate(displacements), np.concatenate(kept)


def again(known: KnownStates, rng: np.random.Generator) -> Sorted:
    """Clear configurations for states that so far only unclear ones told of: their equations, solved from beside these.

    Beside a state in which edges are along each other lie others in which they nearly are, and farther away less so.
    """
    geometry = known.geometry
    q, touching = known.doubts()
    q, touching = np.repeat(q, _AGAIN, axis=0), np.repeat(touching & geometry.takes_part, _AGAIN, axis=0)
    away = rng.normal(size=(len(q), geometry.dimension)) * geometry.radius / weights(geometry)
    away *= rng.choice(_BESIDE, size=(len(q), 1))
    return onto_all(geometry, geometry.moved(q, np.where(geometry.free, away, 0.0)), touching)


def padded(touching: np.ndarray) -> np.ndarray:
    """The pairs that touch, one configuration a row, -1 for none."""
    rows, pairs = np.nonzero(touching)
    counts = touching.sum(axis=1)
    found = np.full((len(touching), max(int(counts.max(initial=0)), 1)), -1)
    found[rows, np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)] = pairs
    return found


def connect(known: KnownStates, tight: Sorted, loose: Sorted) -> None:
    """Transitions of which the straight motion, contacts held, stays in the looser state."""
    if not len(tight):
        return
    more = (tight.touching & ~loose.touching).any(axis=1) & ~(loose.touching & ~tight.touching).any(axis=1)
    rows = np.flatnonzero(more & ~known.linked(tight.touching, loose.touching))
    rows = rows[_straight(known.geometry, tight[rows], loose[rows])]
    known.connect(tight[rows], loose[rows])


def _straight(geometry: ContactGeometry, tight: Sorted, loose: Sorted) -> np.ndarray:
    """Whether straight motions stay in the looser state: where circles roll, contacts may leave a feature, and where
    edges are nearly along each other, what touches is not known well.
    """
    way, kept = geometry.between(tight.q, loose.q), padded(loose.touching)
    good = np.ones(len(tight), dtype=bool)
    if isinstance(geometry, RoundGeometry):
        good = _begins(geometry, tight, loose, way, kept)
    for share in _LOOKED_AT:
        q, arrived = held(geometry, geometry.moved(tight.q, share * way), kept)
        found = sort_configurations(geometry, q)
        good &= arrived & found.admissible & (found.touching == loose.touching).all(axis=1)
    return good


def _begins(geometry: ContactGeometry, tight: Sorted, loose: Sorted, way: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Whether motions begin along their way, with the contacts that they hold and others that were there.

    Not all that they leave need be apart so near. Where a circle is nearly along a rim, tolerances alone may make two
    states neighbours: then contacts are held only far aside, or something else touches first.
    """
    good = np.ones(len(tight), dtype=bool)
    for share in _BEGINNING:
        aim = geometry.moved(tight.q, share * way)
        q, arrived = held(geometry, aim, kept)
        aside = np.linalg.norm(geometry.between(aim, q) * weights(geometry), axis=1)
        found = sort_configurations(geometry, q)
        among = (found.touching | ~loose.touching).all(axis=1) & (tight.touching | ~found.touching).all(axis=1)
        near = aside <= _OFF_COURSE * share * np.linalg.norm(way * weights(geometry), axis=1)
        good &= arrived & found.admissible & among & near
    return good
