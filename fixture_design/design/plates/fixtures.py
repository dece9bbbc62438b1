"""Fixtures on a plate, as arrays: one row each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Points, Weights
from fixture_design.design.plates.plate import Plate


@dataclass(frozen=True, eq=False)
class Fixtures:
    """Fixtures of three locators and a clamp for one part, each placed at the plate's lower left.

    Holes count as [column, row] from 0; lengths are metres in W, with the origin in hole [0, 0] and x along the rows.
    Edge k of the part runs from vertex k to the next. Contacts are the three locators', then the clamp's.

    Attributes:
        polygon: of the part in P, shape (n, 2) [m].  plate: what was asked for.
        theta: of the pose X_WP [rad].  translation: p_WP, shape (k, 2) [m].
        edges: that the locators touch, rising, shape (k, 3).  holes: that they stand in, shape (k, 3, 2).
        clamp_edges: shape (k,).  clamp_holes: shape (k, 2).  clamp_directions: the way the plunger pushes, (k, 2).
        points: of contact in W, shape (k, 4, 2) [m].  normals: the part's outward unit normals there, (k, 4, 2).
        margin: s, shape (k,): see `closure`; about the centre of the part's bounding box, moments divided by half of
            its diagonal.
    """

    polygon: Points
    plate: Plate
    theta: Weights
    translation: Float[np.ndarray, "k 2"]
    edges: Int[np.ndarray, "k 3"]
    holes: Int[np.ndarray, "k 3 2"]
    clamp_edges: Indices
    clamp_holes: Int[np.ndarray, "k 2"]
    clamp_directions: Int[np.ndarray, "k 2"]
    points: Float[np.ndarray, "k 4 2"]
    normals: Float[np.ndarray, "k 4 2"]
    margin: Weights

    def __len__(self) -> int:
        return len(self.theta)

    def kept(self, which: np.ndarray | slice | Sequence[int]) -> Fixtures:
        """Those that a mask, a slice or indices select."""
        columns = (getattr(self, field.name)[which] for field in fields(self)[2:])
        return Fixtures(self.polygon, self.plate, *columns)

    @staticmethod
    def joined(parts: Sequence[Fixtures]) -> Fixtures:
        """One after the other; at least one part."""
        columns = ([getattr(part, field.name) for part in parts] for field in fields(Fixtures)[2:])
        return Fixtures(parts[0].polygon, parts[0].plate, *(np.concatenate(column) for column in columns))
