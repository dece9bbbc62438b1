"""What is known so far: samples of each state, spread out, and transitions with their witnesses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from fixture_design.arrays import Indices, Vector
from fixture_design.assembly.assembly import Configuration
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.sorting import Sorted, State, joined, state_of


@dataclass(frozen=True, eq=False)
class Transition:
    """A direct transition (3-24), (3-25): from ``q``, in the state with more contacts, some displacement leaves them.

    Attributes:
        q: shape (c,).  displacement: shape (d,), about the moving body's origin, fixed axes; the configuration moved by
            it (its contacts held) is in the state with fewer contacts, and so is all in between.
    """

    q: Configuration
    displacement: Vector


@dataclass(eq=False)
class KnownStates:
    """States and transitions while they are being found.

    Attributes:
        most: samples that are kept of a state.
        samples: of each state; transitions: (state with more contacts, state with fewer) -> witness.
    """

    geometry: ContactGeometry
    most: int
    samples: dict[State, Sorted] = field(default_factory=dict)
    transitions: dict[tuple[State, State], Transition] = field(default_factory=dict)

    def add(self, found: Sorted) -> tuple[Sorted, int]:
        """Takes clear configurations in; returns those that are kept as samples, and how many states are new.

        A sample is kept while its state has too few, if it is away from those there are.
        """
        kept, before = [], len(self.samples)
        for state, rows in self.by_state(found).items():
            fresh = self._away(state, found[rows])
            if len(fresh):
                old = self.samples.get(state)
                self.samples[state] = fresh if old is None else joined([old, fresh])
                kept.append(fresh)
        return joined(kept) if kept else found[np.zeros(0, dtype=int)], len(self.samples) - before

    def by_state(self, found: Sorted) -> dict[State, Indices]:
        """Rows of the clear configurations, by state."""
        patterns, places = np.unique(found.touching, axis=0, return_inverse=True)
        rows: dict[State, list[int]] = {}
        for k, pattern in enumerate(patterns):
            mine = np.flatnonzero((places.ravel() == k) & found.clear)
            if mine.size:
                rows.setdefault(state_of(self.geometry, pattern), []).extend(mine.tolist())
        return {state: np.array(sorted(found_rows)) for state, found_rows in rows.items()}

    def connect(self, states: Iterable[tuple[State, State]], q: np.ndarray, displacements: np.ndarray) -> None:
        """Takes transitions in (more contacts first); of several witnesses the first stays."""
        for pair, at, displacement in zip(states, q, displacements, strict=True):
            if set(pair[0]) > set(pair[1]) and pair not in self.transitions:
                self.transitions[pair] = Transition(at, displacement)

    def _away(self, state: State, found: Sorted) -> Sorted:
        """The configurations farthest from the samples and each other, as many as there is room for."""
        old = self.samples.get(state)
        room = self.most - (0 if old is None else len(old))
        if room <= 0:
            return found[np.zeros(0, dtype=int)]
        gap = np.full(len(found), np.inf)
        for q in [] if old is None else old.q:
            gap = np.minimum(gap, self._distances(q, found.q))
        chosen: list[int] = []
        while len(chosen) < room:
            best = int(np.argmax(gap))
            if gap[best] <= _SAME * self.geometry.size:
                break
            chosen.append(best)
            gap = np.minimum(gap, self._distances(found.q[best], found.q))
        return found[np.array(chosen, dtype=int)]

    def _distances(self, q: Configuration, others: np.ndarray) -> np.ndarray:
        away = self.geometry.between(np.repeat(q[None], len(others), axis=0), others)
        return np.linalg.norm(away * weights(self.geometry), axis=1)


#: Samples this near to each other, relative to the size, are one [-].
_SAME = 1e-6
