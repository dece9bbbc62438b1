"""How accurate locators could be at best: bounds that hold for every choice among some candidates.

Without features the volume |det D| of d rows x_i is bounded by the best *continuous* design, weights w >= 0 of sum 1:

    det(D)^2 = d^d det(sum x_i x_i' / d) <= d^d max over w of det(sum w_i x_i x_i')

and by duality (the smallest ellipsoid around the rows) the maximum is at most det(M) (max g / d)^d for any weights,
with M their sum and g_i = x_i' M^-1 x_i. With a feature of row a, locators with a = D' y have the error sum |y_i|,
which is at least the smallest such sum over all candidates (Elfving), a linear program.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Rows
from fixture_design.design.locating import Features
from fixture_design.tolerances import DEFAULT

#: Rounds of the multiplicative algorithm [-]; the bound holds after any, and is within a percent after these.
_ROUNDS = 300


def largest_volume(rows: Rows) -> float:
    """No choice of as many of the rows as their rank spans a larger volume.

    Args:
        rows: shape (n, d).
    """
    values, right = np.linalg.svd(rows, full_matrices=False)[1:]
    inside = rows @ right[values > DEFAULT.near * values[0]].T
    count, dimension = inside.shape
    weights = np.full(count, 1.0 / count)
    best = np.inf
    for _ in range(_ROUNDS):
        moments = inside.T @ (weights[:, None] * inside)
        influence = np.einsum("ij,ij->i", inside @ np.linalg.inv(moments), inside)
        bound = dimension * np.log(influence.max()) + np.linalg.slogdet(moments)[1]
        best = min(best, float(bound))
        weights = weights * influence / dimension
    return float(np.exp(best / 2))


def least_error(rows: Rows, features: Features, pool: Indices) -> float:
    """No locators of the pool have a smaller worst error at the features, in their tolerances."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    scaled = rows[pool] * features.levers[pool, None]
    least = 0.0
    for feature in features.rows:
        found = linprog(np.ones(2 * len(pool)), A_eq=np.vstack([scaled, -scaled]).T, b_eq=feature, method="highs")
        least = max(least, float(found.fun) if found.x is not None else 0.0)
    return least
