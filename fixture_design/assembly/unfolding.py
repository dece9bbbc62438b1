"""From one state and transition of each orbit to all: the images by the symmetries."""

from __future__ import annotations

import numpy as np

from fixture_design.assembly.known_states import KnownStates, Transition
from fixture_design.assembly.sorting import Sorted, State, state_of
from fixture_design.assembly.symmetry import Symmetries


def unfolded(known: KnownStates) -> KnownStates:
    """The same states and transitions with all their images, and no symmetries."""
    if len(known.symmetries) == 1:
        return known
    geometry, symmetries = known.geometry, known.symmetries
    samples: dict[State, Sorted] = {}
    patterns: dict[State, np.ndarray] = {}
    for state, found in known.samples.items():
        patterns[state] = found.touching[0]
        for element in symmetries.orbit(patterns[state]).tolist():
            image = symmetries.of(np.full(len(found), element), found)
            samples[state_of(geometry, image.touching[0])] = image
    transitions: dict[tuple[State, State], Transition] = {}
    for (tight, loose), found in known.transitions.items():
        rows = np.array([[name in names for name in geometry.names] for names in (set(tight), set(loose))])
        for element in symmetries.orbit(*rows).tolist():
            pair = tuple(state_of(geometry, row) for row in symmetries.permuted(np.full(2, element), rows))
            transitions[pair[0], pair[1]] = _image(symmetries, element, found)
    return KnownStates(geometry, Symmetries.none(len(geometry.names)), known.most, samples, transitions)


def _image(symmetries: Symmetries, element: int, found: Transition) -> Transition:
    elements = np.array([element])
    q = symmetries.moved(elements, found.q[None])[0]
    return Transition(q, symmetries.displaced(elements, found.displacement[None])[0])
