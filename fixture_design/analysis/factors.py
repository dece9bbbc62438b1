"""The factors on many loads that forces balance, all at once, and forces at any factor in between."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.analysis import loads as one_at_a_time
from fixture_design.arrays import Mask, Rows, Vector, Weights
from fixture_design.cones import second_order
from fixture_design.cones.force_cones import ForceCones
from fixture_design.tolerances import FORCES_SOLVED


@dataclass(frozen=True, eq=False)
class FactorTable:
    """Brackets of the largest factors on loads, then on the reversed loads, with what proves them.

    Attributes:
        lower, upper: shape (2 k,).  forces: shape (2 k, s), x at the factor ``lower``; where that is inf, a multiple of
            the load alone.  starts: shape (2 k, s), then x without the load; NaN where these
            are not known apart.
        motions: shape (2 k, d): q with load . q = 1 that proves ``upper``; 0 where that is -inf; zeros without one.
    """

    lower: Weights
    upper: Weights
    forces: np.ndarray
    starts: np.ndarray
    motions: Rows

    def ends(self, load: int) -> tuple[int, int]:
        """Where the load is, and the reversed one."""
        return load, load + len(self.lower) // 2

    def forces_at(self, load: int, factor: float) -> Weights | None:
        """x that balances the given factor on a load; None if none is known. The factors are convex."""
        x = self._forces_at(load, factor)
        return None if x is None or np.isnan(x).any() else x

    def _forces_at(self, load: int, factor: float) -> Weights | None:
        up, down = self.ends(load)
        high, low = float(self.lower[up]), -float(self.lower[down])
        if not low <= factor <= high:
            return None
        if np.isinf(high):
            if factor >= 0 or np.isinf(low):
                end, size = (up, factor) if factor >= 0 else (down, -factor)
                return self.starts[end] + size * self.forces[end]
            return _between(low, self.forces[down], 0.0, self.starts[up], factor)
        if np.isinf(low):
            if factor <= 0:
                return self.starts[down] - factor * self.forces[down]
            return _between(0.0, self.starts[down], high, self.forces[up], factor)
        return _between(low, self.forces[down], high, self.forces[up], factor)


def _between(low: float, at_low: Weights, high: float, at_high: Weights, factor: float) -> Weights:
    share = (factor - low) / (high - low) if high > low else 0.5
    return (1 - share) * at_low + share * at_high


def factor_table(cones: ForceCones, fixed: Vector, loads: Rows) -> FactorTable:
    """Brackets for loads and reversed loads, by one interior point for all; what it leaves open, one at a time.

    Args:
        fixed: shape (d,).  loads: shape (k, d), none of them zero.
    """
    both = np.vstack([loads, -loads])
    found = second_order.largest_factors(cones, fixed, both)
    table = FactorTable(*(np.array(a) for a in (found.lower, found.upper, found.forces, found.starts, found.motions)))
    for index in np.flatnonzero(_open(table)).tolist():
        _replace(table, index, one_at_a_time.largest_factors(cones, fixed, both[index : index + 1]))
    return table


def _open(table: FactorTable) -> Mask:
    """Brackets that are wider than what is asked of the solver."""
    with np.errstate(invalid="ignore"):
        width = table.upper - table.lower
    narrow = np.isfinite(width) & (width <= FORCES_SOLVED * (1 + np.abs(table.upper)))
    return (table.upper != table.lower) & ~narrow


def _replace(table: FactorTable, index: int, found: one_at_a_time.Factors) -> None:
    """Take over the bounds that are better, while the table is made."""
    if found.lower[0] > table.lower[index]:
        table.lower[index], table.forces[index] = found.lower[0], found.forces[0]
        table.starts[index] = np.nan if np.isinf(found.lower[0]) else 0.0  # it has no multiple of the load alone
    if found.upper[0] < table.upper[index] and np.any(found.motions[0]):
        table.upper[index], table.motions[index] = found.upper[0], found.motions[0]
