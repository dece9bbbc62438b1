"""Pushes from second-order cones, and what is found out about the loads that they hold: the types of `second_order`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Weights
from fixture_design.errors import ConeError

#: What contacts have at most: a normal force, two of friction, a moment of friction about the normal.
WIDEST = 4


@dataclass(frozen=True, eq=False)
class ForceCones:
    """Pushes x_i = [t, z] with |z| <= t, and the wrenches maps_i x_i that they make.

    Attributes:
        maps: shape (d, s), the columns of one cone after those of another. Scaling a cone's column of z by mu makes
            its friction coefficient mu.
        sizes: shape (n,), the numbers k_i >= 1 of each cone; they sum to s.
        heads: shape (n,), NaN where t is free; else t is just that, as of a clamp that pushes with a given force >= 0.

    Raises:
        ConeError: sizes that do not fit, numbers that are not finite, a head below 0.
    """

    maps: Float[np.ndarray, "d s"]
    sizes: Indices
    heads: Weights

    def __post_init__(self) -> None:
        if self.maps.ndim != 2 or self.sizes.shape != self.heads.shape or self.sizes.sum() != self.maps.shape[1]:
            raise ConeError(f"maps {self.maps.shape}, sizes {self.sizes.tolist()}, {len(self.heads)} heads do not fit")
        if len(self.sizes) and self.sizes.min() < 1:
            raise ConeError(f"cones have 1 number or more, not {self.sizes.tolist()}")
        if not np.isfinite(self.maps).all():
            raise ConeError("maps must be finite")
        if not (np.isnan(self.heads) | ((self.heads >= 0) & np.isfinite(self.heads))).all():
            raise ConeError(f"heads must be >= 0, or NaN where they are free: {self.heads.tolist()}")

    @property
    def starts(self) -> Indices:
        """The first column of each cone."""
        return np.cumsum(self.sizes) - self.sizes

    def blocks(self) -> list[slice]:
        """The columns of each cone."""
        return [slice(start, start + size) for start, size in zip(self.starts, self.sizes, strict=True)]

    @property
    def passive(self) -> ForceCones:
        """Those whose t is free: what they can do is a cone."""
        free = np.isnan(self.heads)
        return ForceCones(self.maps[:, np.repeat(free, self.sizes)], self.sizes[free], self.heads[free])

    @property
    def places(self) -> Int[np.ndarray, "n 4"]:
        """The column of each number of each cone, of `WIDEST` at most; s, one beyond the last, where it has fewer."""
        numbers = np.arange(WIDEST)
        return np.where(numbers < self.sizes[:, None], self.starts[:, None] + numbers, self.maps.shape[1])


@dataclass(frozen=True, eq=False)
class Factors:
    """lower <= lambda* <= upper for each load, and what proves it.

    Attributes:
        lower: shape (k,). Reached by `forces`; -inf if none were found; +inf if `starts` hold the fixed wrench and some
            multiple of the load, and `forces` hold one load more, again and again.
        upper: shape (k,). Bounded by `motions`; +inf if unbounded, or if no bound was found; -inf if no factor at all
            can be held, as the motion shows: l . q = 0, and f . q - sum h_i (|b_i| - a_i) > 0.
        forces: x, shape (k, s), in the cones; for a finite lower f + lower l + M x = 0 up to rounding, and for +inf
            l + M x = 0 with clamps' x = 0.
        motions: q, shape (k, d), l . q = 1 for a finite upper; zero where there is none.
        starts: x, shape (k, s), zero but where lower is +inf.
    """

    lower: Weights
    upper: Weights
    forces: Float[np.ndarray, "k s"]
    motions: Float[np.ndarray, "k d"]
    starts: Float[np.ndarray, "k s"]
