"""How far the sets of denser samples are outside a measurement set: the bound that it is widened by."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.cones.kernel import nonnegative_least_squares
from fixture_design.recognition.measurement import MeasurementSet, oriented_rows
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
    found_out = np.zeros(len(samples))
    for rows in {len(some) for some in samples.forces}:
        some = [k for k, spans in enumerate(samples.forces) if len(spans) == rows]
        found_out[some] = _outside(np.array([samples.forces[k] for k in some]).reshape(len(some), rows, size), blocks)
    return found_out


def displacements_outside(
    alternatives: tuple[Rows, ...], neighbours: Sequence[tuple[Rows, ...]], dimension: int
) -> float:
    """The least bound that A(q) needs within the union of the A of neighbours, all widened.

    max over u in A_n of min over the neighbours' cones of max over their faces a . u, |u| = 1; the inner two are a max
    over choices of one face a cone, and for one choice it is the distance of the hull of the faces from A_n's polar.
    """
    cones = [faces for others in neighbours for faces in others]
    if any(not len(rows) for rows in cones):
        return 0.0
    worst = 0.0
    for polar in alternatives:
        for choice in product(*(range(len(rows)) for rows in cones)):
            hull = np.array([rows[k] for rows, k in zip(cones, choice, strict=True)])
            worst = max(worst, _hull_to_cone(hull, polar, dimension))
    return worst


def _hull_to_cone(hull: Rows, cone: Rows, dimension: int) -> float:
    """Least |sum l_i h_i - sum c_j d_j| with l, c >= 0 and sum l = 1.

    By nonnegative least squares with the row sum l = 1 added: scaling l and c together leaves the minimiser.
    """
    vectors = np.vstack([hull, -cone]).reshape(-1, dimension)
    ones = np.concatenate([np.ones(len(hull)), np.zeros(len(cone))])
    target = np.append(np.zeros(dimension), 1.0)
    weights = nonnegative_least_squares(np.vstack([vectors.T, ones]), target)
    total = float(weights[: len(hull)].sum())
    return float(np.linalg.norm(weights @ vectors)) / total if total > 0 else 1.0


def _blocks(found: MeasurementSet, columns: slice) -> list[Rows]:
    """Distinct lists of face vectors in one block of the signal."""
    blocks = {}
    for cone in found.cones:
        rows = oriented_rows(cone)[:, columns]
        rows = np.ascontiguousarray(rows[np.abs(rows).max(axis=1, initial=0.0) > 0])
        blocks[rows.tobytes()] = rows
    return list(blocks.values())


def _outside(spans: np.ndarray, blocks: Sequence[Rows]) -> Weights:
    """Of n cones with as many span vectors, shape (n, k, d)."""
    count, rows, size = spans.shape
    if not rows:
        return np.zeros(count)
    flat = spans.reshape(-1, size)
    least = np.array([(flat @ block.T).reshape(count, -1).max(axis=1, initial=-1.0) for block in blocks])
    worst = np.zeros(count)
    for k in np.flatnonzero(least.min(axis=0) > 0.0):
        best = np.argsort(least[:, k], kind="stable")[:_CANDIDATES]
        worst[k] = min(_whole_outside(spans[k], blocks[b]) for b in best)
    return worst


def _whole_outside(spans: Rows, rows: Rows) -> float:
    crossed = rows[(rows @ spans.T > 0).any(axis=1)]
    return max((_largest(spans, row) for row in crossed), default=0.0)


def _largest(spans: Rows, row: Vector) -> float:
    """max of a . s over the unit vectors s of a cone: the length of a's projection onto it; 0 if a leaves it.

    At most 1, as a is a unit vector; the sum says more where span vectors all but balance, and its weights are huge.
    """
    return min(1.0, float(np.linalg.norm(nonnegative_least_squares(spans.T, row) @ spans)))
