"""How far the sets of denser samples are outside a measurement set: the bound that it is widened by."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Rows, Weights
from fixture_design.cones.cone import unit_rows
from fixture_design.recognition.measurement import (
    MeasurementSet,
    largest_outside,
    largest_outside_faces,
    oriented_rows,
)
from fixture_design.recognition.sample_cones import SampleCones
from fixture_design.recognition.signals import Signals

#: Cones of a set that the whole cone of a sample is held against: those that its span vectors are least outside of.
_CANDIDATES = 3


def forces_outside(found: MeasurementSet, samples: SampleCones, signals: Signals) -> Weights:
    """For every sample the least bound that its whole force set needs, by one cone of the set; shape (n,).

    Not its span vectors alone: a sum of two that nearly oppose each other is shorter than they are.
    """
    size = signals.force_size
    blocks = _blocks(found, slice(0, size))
    return np.array([_outside(unit_rows(rows)[0], blocks) for rows in samples.forces])


def displacements_outside(found: MeasurementSet, samples: SampleCones, signals: Signals) -> Weights:
    """For every sample the least bound that every alternative of its displacement set needs; shape (n,)."""
    blocks = _blocks(found, slice(signals.force_size, signals.size))
    worst = []
    for alternatives in samples.displacements:
        each = []
        for faces in alternatives:
            unit = unit_rows(faces)[0]
            each.append(min(max((largest_outside_faces(unit, row) for row in rows), default=0.0) for rows in blocks))
        worst.append(max(each))
    return np.array(worst)


def _blocks(found: MeasurementSet, columns: slice) -> list[Rows]:
    """Distinct lists of face vectors in one block of the signal."""
    blocks = {}
    for cone in found.cones:
        rows = oriented_rows(cone)[:, columns]
        rows = np.ascontiguousarray(rows[np.abs(rows).max(axis=1, initial=0.0) > 0])
        blocks[rows.tobytes()] = rows
    return list(blocks.values())


def _outside(spans: Rows, blocks: Sequence[Rows]) -> float:
    if not len(spans):
        return 0.0
    least = np.array([float((rows @ spans.T).max(initial=-1.0)) for rows in blocks])
    if least.min() <= 0.0:
        return 0.0
    best = np.argsort(least, kind="stable")[:_CANDIDATES]
    return min(_whole_outside(spans, blocks[k]) for k in best)


def _whole_outside(spans: Rows, rows: Rows) -> float:
    crossed = rows[(rows @ spans.T > 0).any(axis=1)]
    return max((largest_outside(spans, row) for row in crossed), default=0.0)
