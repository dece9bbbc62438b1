"""Face vectors of contacts that are more than one point: a disk that lies on a plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Rows


@dataclass(frozen=True, eq=False)
class ContactRows:
    """The face vectors of the pairs that touch, some of several points.

    Attributes:
        vectors: shape (r, d).  at_end: shape (r,).
        owned: of each pair its rows; whole: whether it stays only if all of them do, else if any does.
    """

    vectors: Rows
    at_end: Mask
    owned: tuple[Indices, ...]
    whole: tuple[bool, ...]

    @classmethod
    def single(cls, vectors: Rows, at_end: Mask) -> ContactRows:
        """One row each."""
        return cls(vectors, at_end, tuple(np.array([k]) for k in range(len(vectors))), (True,) * len(vectors))

    def pairs_kept(self, rows: np.ndarray) -> np.ndarray:
        """Which pairs motions keep (k, m) that keep these rows (k, r)."""
        kept = [
            rows[:, own].all(axis=1) if whole else rows[:, own].any(axis=1)
            for own, whole in zip(self.owned, self.whole, strict=True)
        ]
        return np.stack(kept, axis=1)
