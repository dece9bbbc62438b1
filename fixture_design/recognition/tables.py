"""Discriminants of all transitions as plain tables, for evaluation here and in exported code."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import ArrayLike, Indices, Rows, Weights
from fixture_design.errors import InputError
from fixture_design.recognition.classifier import Classifier
from fixture_design.recognition.discriminants import Faces
from fixture_design.recognition.widened import Widened, widened_cones, widened_group


@dataclass(frozen=True, eq=False)
class Tables:
    """DT of all transitions (4-26) in arrays.

    A measurement passes a group if a . s <= bound for all its faces; a transition is possible if one of its groups is
    passed. Faces of a group are ``chosen[group_start[g] : group_start[g + 1]]``, groups of a transition
    ``transition_start[t] : transition_start[t + 1]``, transitions of a source likewise by ``source_start``.

    Attributes:
        rows: unit face vectors a, of the signal's numbers, shape (m, k).  bounds: shape (m,).
        chosen, group_start, transition_start, target, source_start: see above; targets and sources are rows of the
            classifier's states.
    """

    rows: Rows
    bounds: Weights
    chosen: Indices
    group_start: Indices
    transition_start: Indices
    target: Indices
    source_start: Indices

    @classmethod
    def of(cls, classifier: Classifier) -> Tables:
        """The tables of a classifier, with only those faces that some transition needs, its sets and noise widening.

        Raises:
            InputError: a classifier without discriminants.
        """
        if not classifier.transitions:
            raise InputError("this classifier has no discriminants", expected="one that was built with them")
        ids = list(classifier.ids)
        tables = _Growing(classifier)
        transition_start, target, source_start = [0], [], [0]
        for source in ids:
            for transition in (some for some in classifier.transitions if some.source == source):
                others = [name for name in classifier.state(source).successors if name != transition.target]
                for cone, faces in enumerate(transition.faces):
                    tables.add(transition.target, cone, faces, others)
                transition_start.append(len(tables.group_start) - 1)
                target.append(ids.index(transition.target))
            source_start.append(len(target))
        indices = (tables.chosen, tables.group_start, transition_start, target, source_start)
        rows = np.array(tables.rows).reshape(-1, classifier.signals.size)
        return cls(rows, np.array(tables.bounds), *(np.array(some, dtype=int) for some in indices))

    def possible(self, signal: np.ndarray, source: int) -> list[int]:
        """Rows of the states that may follow a state."""
        passed = self.rows @ signal <= self.bounds
        return [
            int(self.target[t])
            for t in range(self.source_start[source], self.source_start[source + 1])
            if any(
                passed[self.chosen[self.group_start[g] : self.group_start[g + 1]]].all()
                for g in range(self.transition_start[t], self.transition_start[t + 1])
            )
        ]


class _Growing:
    """Tables while they are made: each face once."""

    def __init__(self, classifier: Classifier) -> None:
        self.rows: list[np.ndarray] = []
        self.bounds: list[float] = []
        self.chosen: list[int] = []
        self.group_start = [0]
        self._known: dict[tuple[str, int, int], int] = {}
        noise, size = classifier.noise, classifier.signals.force_size
        self._cones: dict[str, list[Widened]] = {
            state.id: widened_cones(state.measured, size, noise.force, noise.displacement)
            for state in classifier.states
        }

    def add(self, state: str, cone: int, group: Faces, others: list[str]) -> None:
        """A group of a state's cone, which tells it from others."""
        widened = self._cones[state][cone]
        for face in widened_group(widened, group, [some for other in others for some in self._cones[other]]):
            key = (state, cone, face)
            if key not in self._known:
                self._known[key] = len(self.rows)
                self.rows.append(widened.rows[face])
                self.bounds.append(float(widened.bounds[face]))
            self.chosen.append(self._known[key])
        self.group_start.append(len(self.chosen))


def discriminated(
    classifier: Classifier, tables: Tables, source: str, wrench: ArrayLike | None, twist: ArrayLike | None = None
) -> tuple[str, ...]:
    """The states that the discriminants leave after ``source``: those whose DT holds the measurement.

    Sure only of measurements that are in the widened set of some successor: between these the discriminants tell as the
    whole sets do, and of others they say nothing. None are left where force and displacement do negative work.

    Raises:
        InputError, UnknownNameError: as `Classifier.recognize`.
    """
    signal = classifier.signals.signal(wrench, twist, classifier.noise.floor)
    row = classifier.ids.index(classifier.state(source).id)
    if classifier.contrary(signal):
        return ()
    return tuple(classifier.ids[k] for k in sorted(tables.possible(signal, row)))
