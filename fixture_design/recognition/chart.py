"""Coordinates in which the samples of a state are neighbours (4-36): those in which their span vectors change.

Convex sums interpolate span vectors, so two configurations are near if their span vectors are. In the plane a contact's
are [n; l], n at some angle and l a lever: the angle of n and that of the whole vector above the plane of forces,
atan(l / L), are coordinates in which the state is flat. In space the unit vectors themselves are taken. A state with r
freedoms that span vectors notice needs simplices of r + 1 samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.recognition.sample_cones import SampleCones

#: Singular values below this, relative to the largest, are no freedom of the span vectors [-].
_FLAT = 1e-6


@dataclass(frozen=True, eq=False)
class Chart:
    """Coordinates of samples.

    Attributes:
        points: shape (n, k): the span vectors' coordinates, in all their directions, the widest first.
        freedoms: r, at most k.
    """

    points: np.ndarray
    freedoms: int

    def taking(self, rows: list[int]) -> Chart:
        """Some of the samples."""
        return Chart(self.points[rows], self.freedoms)


def chart_of(geometry: ContactGeometry, contacts: tuple[str, ...], samples: SampleCones, apart: bool) -> Chart:
    """The chart of a state's samples; ``contacts`` and ``apart`` as in `sample_cones`."""
    chosen = np.array([geometry.names.index(name) for name in contacts], dtype=int)[None]
    rows = geometry.equations(samples.q[:1], chosen).face_vectors[0]
    freedoms = int(geometry.free.sum() - (np.linalg.matrix_rank(rows[:, geometry.free], tol=_FLAT) if len(rows) else 0))
    if apart:
        values = _span_coordinates(samples.vectors, geometry.dimension)
    else:
        first = np.repeat(samples.q[:1], len(samples), axis=0)
        values = geometry.between(first, samples.q) * weights(geometry)
    centred = values - values.mean(axis=0)
    _, sizes, right = np.linalg.svd(centred, full_matrices=False)
    rank = int((sizes > _FLAT * max(1.0, sizes.max(initial=0.0))).sum())
    return Chart(centred @ right[:rank].T, min(rank, freedoms))


def _span_coordinates(rows: np.ndarray, dimension: int) -> np.ndarray:
    """In the plane two angles of each vector, in space the unit vector; shape (n, k)."""
    if dimension == 6:
        return (rows / np.linalg.norm(rows, axis=-1, keepdims=True)).reshape(len(rows), -1)
    start, forces = rows[:1], np.linalg.norm(rows[..., :2], axis=-1)
    cosine = (rows[..., :2] * start[..., :2]).sum(axis=-1)
    sine = start[..., 0] * rows[..., 1] - start[..., 1] * rows[..., 0]
    return np.concatenate([np.arctan2(sine, cosine), np.arctan2(rows[..., 2], forces)], axis=1)


def spread(points: np.ndarray, spacing: float) -> list[int]:
    """The extremes of every coordinate, and rows that leave none further than ``spacing`` from one of them."""
    chosen = sorted({0, *points.argmin(axis=0).tolist(), *points.argmax(axis=0).tolist()})
    nearest = np.min([np.linalg.norm(points - points[row], axis=1) for row in chosen], axis=0)
    while nearest.max(initial=0.0) > spacing:
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return chosen
