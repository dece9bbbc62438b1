"""From one state and transition of each orbit to all: the images by the symmetries."""

from __future__ import annotations

import numpy as np

from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.known_states import KnownStates, Transition
from fixture_design.assembly.sorting import Sorted, State, state_of
from fixture_design.assembly.symmetry import Symmetries


def unfolded(known: KnownStates) -> KnownStates:
    """The same states and transitions with all their images, and no symmetries."""
    if len(known.symmetries) == 1:
        return known
    geometry, symmetries = known.geometry, known.symmetries
    named = _Named(geometry)
    samples: dict[State, Sorted] = {}
    for found in known.samples.values():
        for element in symmetries.orbit(found.touching[0]).tolist():
            image = symmetries.of(np.full(len(found), element), found)
            samples[named.states(image.touching[:1])[0]] = image
    transitions: dict[tuple[State, State], Transition] = {}
    places = {name: k for k, name in enumerate(geometry.names)}
    for pair, found in known.transitions.items():
        rows = [named.touching([places[name] for name in state]) for state in pair]
        elements = symmetries.orbit(*rows)
        images = [named.states(symmetries.permuted(elements, np.tile(row, (len(elements), 1)))) for row in rows]
        q = symmetries.moved(elements, np.tile(found.q, (len(elements), 1)))
        away = symmetries.displaced(elements, np.tile(found.displacement, (len(elements), 1)))
        transitions.update(zip(zip(*images, strict=True), map(Transition, q, away), strict=True))
    return KnownStates(geometry, Symmetries.none(len(geometry.names)), known.most, samples, transitions)


class _Named:
    """The states of patterns, each made once: there are many more transitions than states."""

    def __init__(self, geometry: ContactGeometry) -> None:
        self.geometry = geometry
        self._known: dict[bytes, State] = {}

    def touching(self, places: list[int]) -> np.ndarray:
        row = np.zeros(len(self.geometry.names), dtype=bool)
        row[places] = True
        return row

    def states(self, touching: np.ndarray) -> list[State]:
        found = []
        for row, packed in zip(touching, np.packbits(touching, axis=1), strict=True):
            key = packed.tobytes()
            if key not in self._known:
                self._known[key] = state_of(self.geometry, row)
            found.append(self._known[key])
        return found
