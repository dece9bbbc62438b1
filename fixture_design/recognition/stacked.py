"""All cones of all states as one matrix, so that a measurement costs one product and two reductions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Rows, Vector, Weights
from fixture_design.recognition.measurement import MeasurementSet, oriented_rows
from fixture_design.recognition.widened import bounds_of


@dataclass(frozen=True, eq=False)
class Stacked:
    """Face vectors of all cones, one below the other.

    Attributes:
        rows: unit face vectors a, shape (m, k).  bounds: by how much a . s may exceed zero, shape (m,).
        cones: the first row of each cone.  states: the first cone of each state.
    """

    rows: Rows
    bounds: Weights
    cones: Indices
    states: Indices

    @classmethod
    def of(cls, sets: Sequence[MeasurementSet], force_size: int, force: float, displacement: float) -> Stacked:
        """The sets, widened by their own bounds and by those of the sensors.

        A cone without faces is the whole space; a row of zeros stands for it, whose margin is its bound.
        """
        rows, bounds, cones, states = [], [], [], []
        count = 0
        for found in sets:
            states.append(len(cones))
            for cone in found.cones:
                faces = oriented_rows(cone)
                faces = faces if len(faces) else np.zeros((1, cone.dimension))
                cones.append(count)
                rows.append(faces)
                bounds.append(bounds_of(faces, force_size, found.widening, force, displacement))
                count += len(faces)
        return cls(np.ascontiguousarray(np.vstack(rows)), np.concatenate(bounds), np.array(cones), np.array(states))

    def margins(self, signal: Vector) -> Weights:
        """For each state the best of its cones: the least of bound - a . s; not negative if the signal is inside."""
        least = np.minimum.reduceat(self.bounds - self.rows @ signal, self.cones)
        return np.maximum.reduceat(least, self.states)
