"""How two features touch, for many placements at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Touch(NamedTuple):
    """One pair, at n placements.

    Attributes:
        gap: signed, shape (n,) [m].  normal: from the fixed to the moving body, unit, shape (n, 3).
        point: on the moving body, shape (n, 3) [m].
        beyond: how far the point is beyond the end of a feature, negative within [m].
        exists: whether there is such a place; elsewhere the pair is far apart, and the rest says where one may be.
        slide: how ``beyond`` changes with motions, [f; m] about the point, shape (n, 6): points move along circles as
            bodies turn. Of crossings only if it is wanted.
    """

    gap: np.ndarray
    normal: np.ndarray
    point: np.ndarray
    beyond: np.ndarray
    exists: np.ndarray
    slide: np.ndarray

    @staticmethod
    def ordered(found: Sequence[Touch]) -> tuple[Touch, Touch]:
        """Two places of one pair, the nearer first: what is beyond an end, or does not exist, comes last."""
        first, second = found
        distance = [np.where(t.exists, np.hypot(t.gap, np.maximum(t.beyond, 0.0)), np.inf) for t in found]
        swap = distance[1] < distance[0]
        return first.where(~swap, second), second.where(~swap, first)

    def where(self, mask: np.ndarray, other: Touch) -> Touch:
        def chosen(mine: np.ndarray, theirs: np.ndarray) -> np.ndarray:
            return np.where(mask.reshape(-1, *[1] * (mine.ndim - 1)), mine, theirs)

        return Touch(
            chosen(self.gap, other.gap), chosen(self.normal, other.normal), chosen(self.point, other.point),
            chosen(self.beyond, other.beyond), chosen(self.exists, other.exists), chosen(self.slide, other.slide),
        )  # fmt: skip
