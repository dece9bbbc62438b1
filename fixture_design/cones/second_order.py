"""How many times a load can pushes from second-order cones hold, with a proof from both sides, for many loads at once.

A contact with friction pushes with x = [t, z], |z| <= t: t along its normal, z what it rubs with, in units in which
the friction cone is round. For a load l beside a fixed wrench f the question is

    lambda* = max { lambda : f + lambda l + sum_i M_i x_i = 0, x_i in K_i },

and its dual min { -f . q + sum over clamps of h_i (|b_i| - a_i) : l . q = 1, a_i >= |b_i| for the others }, where
[a_i, b_i] = M_i^T q: a motion q with which the load does work one, against no push that could be larger. Forces prove a
lower bound, a motion an upper one; both are one matrix product to check.
The largest factor of -l, negated, is the smallest one of l.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones.balance_proof import proved
from fixture_design.cones.balance_space import BalanceSpace
from fixture_design.cones.force_cones import WIDEST, Factors, ForceCones
from fixture_design.errors import ConeError

__all__ = ["Factors", "ForceCones", "largest_factors"]


def largest_factors(cones: ForceCones, fixed: Vector, loads: Rows, *, threads: int | None = None) -> Factors:
    """Bounds on the largest factor of each load, from one interior point for all of them (`kernel.balance`).

    Brackets are usually narrower than 1e-8 of the factor. A tie (a wrench on the very boundary of what is held) may
    leave a bound unproven: -inf below, +inf above. A load of zero has the factor +inf if the fixed wrench is held, and
    -inf if it cannot be. Where cones push against each other (opposed contacts), or all on one line or plane, what they
    cannot do is taken out first, so that what is left has strictly feasible motions (`balance_space`).

    Args:
        fixed: f, shape (d,), e.g. gravity.  loads: shape (k, d).
        threads: by default one for each processor.

    Raises:
        ConeError: numbers that are not finite, or do not fit.
    """
    d = cones.maps.shape[0]
    if fixed.shape != (d,) or loads.ndim != 2 or loads.shape[1] != d:
        raise ConeError(f"a fixed wrench {fixed.shape} and loads {loads.shape} for maps in R^{d}")
    if cones.sizes.max(initial=1) > WIDEST:
        raise ConeError(f"cones have 1 to {WIDEST} numbers, not {cones.sizes.tolist()}")
    if not (np.isfinite(fixed).all() and np.isfinite(loads).all()):
        raise ConeError("the fixed wrench and the loads must be finite")
    return proved(BalanceSpace.of(cones, fixed, threads), loads)
