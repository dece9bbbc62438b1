"""How many times a load can pushes from second-order cones hold, with a proof from both sides, for many loads at once.

A contact with friction pushes with x = [t, z], |z| <= t: t along its normal, z what it rubs with, in units in which
the friction cone is round. For a load l beside a fixed wrench f the question is

    lambda* = max { lambda : f + lambda l + sum_i M_i x_i = 0, x_i in K_i },

and its dual min { -f . q + sum over clamps of h_i (|b_i| - a_i) : l . q = 1, a_i >= |b_i| for the others }, where
[a_i, b_i] = M_i^T q: a motion q with which the load does work one, against no push that could be larger. Forces prove a
lower bound, a motion an upper one; both are one matrix product to check (`check_forces`, `check_motion` in the tests).
The largest factor of -l, negated, is the smallest one of l.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.errors import ConeError

#: Cones have as many numbers at most: a normal force, two of friction, a moment of friction about the normal.
WIDEST = 4


@dataclass(frozen=True, eq=False)
class ForceCones:
    """Pushes x_i = [t, z] with |z| <= t, and the wrenches maps_i x_i that they make.

    Attributes:
        maps: shape (d, s), the columns of one cone after those of another. Scaling a cone's column of z by mu makes
            its friction coefficient mu.
        sizes: shape (n,), the numbers k_i of each cone, 1 to 4; they sum to s.
        heads: shape (n,), NaN where t is free; else t is just that, as of a clamp that pushes with a given force >= 0.

    Raises:
        ConeError: sizes that do not fit, numbers that are not finite, a head below 0.
    """

    maps: Float[np.ndarray, "d s"]
    sizes: Int[np.ndarray, "n"]
    heads: Float[np.ndarray, "n"]

    def __post_init__(self) -> None:
        if self.maps.ndim != 2 or self.sizes.shape != self.heads.shape or self.sizes.sum() != self.maps.shape[1]:
            raise ConeError(f"maps {self.maps.shape}, sizes {self.sizes.tolist()}, {len(self.heads)} heads do not fit")
        if len(self.sizes) and not (self.sizes.min() >= 1 and self.sizes.max() <= WIDEST):
            raise ConeError(f"cones have 1 to {WIDEST} numbers, not {self.sizes.tolist()}")
        if not np.isfinite(self.maps).all():
            raise ConeError("maps must be finite")
        if not (np.isnan(self.heads) | ((self.heads >= 0) & np.isfinite(self.heads))).all():
            raise ConeError(f"heads must be >= 0, or NaN where they are free: {self.heads.tolist()}")

    @property
    def starts(self) -> Int[np.ndarray, "n"]:
        """The first column of each cone."""
        return np.concatenate([[0], np.cumsum(self.sizes)[:-1]]).astype(np.intp)

    @property
    def places(self) -> Int[np.ndarray, "n 4"]:
        """The column of each number of each cone; s, one beyond the last, for numbers that it has not."""
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


def largest_factors(cones: ForceCones, fixed: Vector, loads: Rows, *, threads: int | None = None) -> Factors:
    """Bounds on the largest factor of each load, from one interior point for all of them (`kernel.balance`).

    Brackets are usually narrower than 1e-8 of the factor. A load of zero has the factor +inf if the fixed wrench is
    held, and -inf if it cannot be. Where cones push against each other (opposed contacts), or all on one line or plane,
    what they cannot do is taken out first, so that what is left has strictly feasible motions (`balance_space`).

    Args:
        fixed: f, shape (d,), e.g. gravity.  loads: shape (k, d).
        threads: by default one for each processor.

    Raises:
        ConeError: numbers that are not finite, or do not fit.
    """
    from fixture_design.cones.balance_proof import proved
    from fixture_design.cones.balance_space import BalanceSpace

    d = cones.maps.shape[0]
    if fixed.shape != (d,) or loads.ndim != 2 or loads.shape[1] != d:
        raise ConeError(f"a fixed wrench {fixed.shape} and loads {loads.shape} for maps in R^{d}")
    if not (np.isfinite(fixed).all() and np.isfinite(loads).all()):
        raise ConeError("the fixed wrench and the loads must be finite")
    return proved(BalanceSpace.of(cones, fixed, threads), loads)
