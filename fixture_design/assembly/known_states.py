"""What is known so far: samples of each state, spread out, and transitions with their witnesses."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fixture_design.arrays import Indices, Mask, Vector
from fixture_design.assembly.assembly import Configuration
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.sorting import Sorted, State, alike, joined, state_of, states_of
from fixture_design.assembly.symmetry import Symmetries
from fixture_design.tolerances import SOLVED


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
        symmetries: only one state of each orbit is kept, and one transition: the others are their images.
        most: samples that are kept of a state.
        samples: of each state; transitions: (state with more contacts, state with fewer) -> witness.
    """

    geometry: ContactGeometry
    symmetries: Symmetries
    most: int
    samples: dict[State, Sorted] = field(default_factory=dict)
    transitions: dict[tuple[State, State], Transition] = field(default_factory=dict)
    _linked: set[bytes] = field(default_factory=set)
    _doubtful: dict[bytes, tuple[Configuration, Mask]] = field(default_factory=dict)
    _told: set[bytes] = field(default_factory=set)

    def add(self, found: Sorted) -> tuple[Sorted, int]:
        """Takes clear configurations in; returns those that are kept as samples, and how many states are new.

        A sample is kept while its state has too few, if it is away from those there are.
        """
        kept, before = [], len(self.samples)
        found = self.representatives(found[self._well_known(found)])
        for state, rows in self.by_state(found).items():
            fresh = self._away(state, found[rows])
            if len(fresh):
                old = self.samples.get(state)
                self.samples[state] = fresh if old is None else joined([old, fresh])
                kept.append(fresh)
        return joined(kept) if kept else found[np.zeros(0, dtype=int)], len(self.samples) - before

    def by_state(self, found: Sorted) -> dict[State, Indices]:
        """Rows of the clear configurations, by state."""
        if not len(found):
            return {}
        first, places = alike(found.touching)
        order = np.argsort(places, kind="stable")
        rows: dict[State, list[int]] = {}
        for k, alike_ones in zip(first, np.split(order, np.cumsum(np.bincount(places))[:-1]), strict=True):
            mine = alike_ones[found.clear[alike_ones]]
            if mine.size:
                rows.setdefault(state_of(self.geometry, found.touching[k]), []).extend(mine.tolist())
        return {state: np.array(sorted(found_rows)) for state, found_rows in rows.items()}

    def connect(self, tight: Sorted, loose: Sorted) -> None:
        """Takes transitions in (more contacts first); of several witnesses the first stays."""
        if not len(tight):
            return
        both = np.concatenate([tight.touching, loose.touching], axis=1)
        first, _ = alike(both)
        tight, loose = tight[first], loose[first]
        elements = self.symmetries.to_representatives(tight.touching, loose.touching)
        displacements = self.symmetries.displaced(elements, self.geometry.between(tight.q, loose.q))
        tight, loose = self.symmetries.of(elements, tight), self.symmetries.of(elements, loose)
        states = (states_of(self.geometry, found.touching) for found in (tight, loose))
        for pair, at, displacement in zip(zip(*states, strict=True), tight.q, displacements, strict=True):
            if set(pair[0]) > set(pair[1]) and pair not in self.transitions:
                self.transitions[pair] = Transition(at, displacement)
        self._linked.update(_keys(tight.touching, loose.touching))

    def linked(self, tight: np.ndarray, loose: np.ndarray) -> Mask:
        """Whether transitions between patterns (n, P), or images of them, are known."""
        first, places = alike(np.concatenate([tight, loose], axis=1))
        keys = _keys(*self._images(tight[first], loose[first]))
        return np.array([key in self._linked for key in keys], dtype=bool)[places]

    def orbits(self, tight: np.ndarray, loose: np.ndarray) -> Indices:
        """Numbers of the orbits that transitions between patterns (n, P) are in."""
        first, places = alike(np.concatenate([tight, loose], axis=1))
        return alike(np.concatenate(self._images(tight[first], loose[first]), axis=1))[1][places]

    def _images(self, tight: np.ndarray, loose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        elements = self.symmetries.to_representatives(tight, loose)
        return self.symmetries.permuted(elements, tight), self.symmetries.permuted(elements, loose)

    def doubt(self, found: Sorted) -> None:
        """Takes in configurations that do not say clearly what touches, one of each state."""
        first, _ = alike(found.touching)
        found = self.representatives(found[first])
        for q, touching in zip(found.q, found.touching, strict=True):
            self._doubtful.setdefault(touching.tobytes(), (q, touching))

    def doubts(self) -> tuple[np.ndarray, np.ndarray]:
        """Such configurations (n, c) and their patterns (n, P), of states that are not known; each is told once."""
        known = {found.touching[0].tobytes() for found in self.samples.values()}
        fresh = [both for key, both in self._doubtful.items() if key not in known and key not in self._told]
        self._told.update(self._doubtful)
        q, touching = (np.array([both[k] for both in fresh]) for k in range(2))
        some = next(iter(self.samples.values()))
        return q.reshape(-1, some.q.shape[1]), touching.reshape(-1, some.touching.shape[1]).astype(bool)

    def representatives(self, found: Sorted) -> Sorted:
        """The configurations' images in the representatives of their states' orbits."""
        if len(self.symmetries) == 1 or not len(found):
            return found
        first, places = alike(found.touching)
        return self.symmetries.of(self.symmetries.to_representatives(found.touching[first])[places], found)

    def _well_known(self, found: Sorted) -> Mask:
        """Which configurations still touch as well as they must after rounding, as that of their images."""
        return np.where(found.touching, found.distances, 0.0).max(axis=1, initial=0.0) <= _WELL * self.geometry.size

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


def _keys(tight: np.ndarray, loose: np.ndarray) -> list[bytes]:
    return [row.tobytes() for row in np.packbits(np.concatenate([tight, loose], axis=1), axis=1)]


#: What touches in a sample does so within this, relative to the size [-]: half of what it must.
_WELL = SOLVED / 2

#: Samples this near to each other, relative to the size, are one [-].
_SAME = 1e-6
