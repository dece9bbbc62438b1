"""From one state and transition of each orbit to all: the images by the symmetries, as tables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.known_states import KnownStates
from fixture_design.assembly.sorting import State, names_of


@dataclass(frozen=True, eq=False)
class Unfolded:
    """All states and transitions that symmetries make of those that are known.

    Attributes:
        states: by number of contacts and names.  samples: configurations of each, shape (k, c).
        tight, loose: of each transition the places of its states, shape (t,); by the looser one, then the tighter.
        q, displacements: their witnesses, shapes (t, c) and (t, d).
    """

    states: tuple[State, ...]
    samples: tuple[np.ndarray, ...]
    tight: Indices
    loose: Indices
    q: np.ndarray
    displacements: np.ndarray


def unfolded(known: KnownStates) -> Unfolded:
    """The states and transitions with all their images."""
    geometry, symmetries = known.geometry, known.symmetries
    touching = np.array([found.touching[0] & geometry.takes_part for found in known.samples.values()])
    touching = touching.reshape(-1, len(geometry.names))
    own, elements = symmetries.orbits(touching)
    states = names_of(geometry, symmetries.permuted(elements, touching[own]))
    order = sorted(range(len(states)), key=lambda k: (len(states[k]), states[k]))
    own, elements = own[order], elements[order]
    samples = _images_of_samples(known, own, elements)
    keys = symmetries.image_keys(touching)[own, elements]
    return Unfolded(tuple(states[k] for k in order), samples, *_transitions(known, keys))


def _images_of_samples(known: KnownStates, own: Indices, elements: Indices) -> tuple[np.ndarray, ...]:
    if not len(own):
        return ()
    counts = np.array([len(found) for found in known.samples.values()])
    firsts, mine = np.cumsum(counts) - counts, counts[own]
    ends = np.cumsum(mine)
    rows = np.arange(ends[-1]) + np.repeat(firsts[own] - (ends - mine), mine)
    q = np.concatenate([found.q for found in known.samples.values()])[rows]
    return tuple(np.split(known.symmetries.moved(np.repeat(elements, mine), q), ends[:-1]))


def _transitions(known: KnownStates, keys: np.ndarray) -> tuple[Indices, Indices, np.ndarray, np.ndarray]:
    """The images of the transitions between states with these keys, shape (s,)."""
    geometry, symmetries = known.geometry, known.symmetries
    tight, loose = (_patterns(geometry, [pair[k] for pair in known.transitions]) for k in range(2))
    own, elements = symmetries.orbits(tight, loose)
    ends = [_places(keys, symmetries.image_keys(touching)[own, elements]) for touching in (tight, loose)]
    order = np.lexsort(ends)
    order = order[(ends[0][order] >= 0) & (ends[1][order] >= 0)]
    own, elements = own[order], elements[order]
    none = geometry.random(np.random.default_rng(0), 0)
    q = np.concatenate([none, *(found.q[None] for found in known.transitions.values())])
    still = np.zeros((0, geometry.dimension))
    away = np.concatenate([still, *(found.displacement[None] for found in known.transitions.values())])
    return (
        ends[0][order], ends[1][order], symmetries.moved(elements, q[own]), symmetries.displaced(elements, away[own])
    )  # fmt: skip


def _places(keys: np.ndarray, wanted: np.ndarray) -> Indices:
    """Where each wanted key is among the keys, -1 where it is not."""
    order = np.argsort(keys)
    found = np.searchsorted(keys[order], wanted)
    places = np.append(order, -1)[found]
    return np.where(np.append(keys, 0)[places] == wanted, places, -1)


def _patterns(geometry: ContactGeometry, states: list[State]) -> np.ndarray:
    """Which pairs touch in states, shape (n, P); pairs that take no part may have no name of their own."""
    places = {geometry.names[k]: k for k in np.flatnonzero(geometry.takes_part).tolist()}
    found = np.zeros((len(states), len(geometry.names)), dtype=bool)
    for row, state in zip(found, states, strict=True):
        row[[places[name] for name in state]] = True
    return found
