"""Moving configurations onto chosen contact equations: least squares of (3-15), all starts at once."""

from __future__ import annotations

import numpy as np

from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.tolerances import SOLVED

#: Steps after which a start that has not arrived is given up.
_MOST_STEPS = 40

#: Steps after which a start that is not nearer by this factor [-] is given up: it is in a minimum that is no solution.
_STUCK_STEPS, _STUCK = 8, 0.5

#: Largest angle of a step [rad]: only in the angle are the equations not linear.
_LARGEST_ANGLE = 0.5

#: The share of `SOLVED` at which the steps end [-]: the last one costs little and leaves rounding only.
_ENOUGH = 1e-1

#: Damping of a step, relative to the squared distance that is left [-]: vanishes fast enough to converge quadratically.
_DAMPING = 0.1

#: Smallest damping, relative to the sum of the squares [-]: steps stay finite where equations depend on each other,
#: also after rounding.
_LEAST_DAMPING = 1e-13


def solved(
    geometry: ContactGeometry, q: np.ndarray, chosen: np.ndarray, *, ends: bool = True, turning: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Configurations near ``q`` that close the chosen pairs: minima of E(q) = sum H_i(q)^2 (3-15).

    Damped Gauss-Newton (Levenberg-Marquardt) on the gaps and overshoots that H is made of. In the plane [x, y, theta]
    has no constraint, so that no rho is needed; (3-33) lacks the squares.

    Args:
        q: starts, shape (n, c).
        chosen: pairs for each start, shape (n, m); one may be listed twice.
        ends: whether the apex must lie on the facet itself, or only on its line.
        turning: whether the orientation may change.

    Returns:
        the configurations, and what is left of sqrt(E) [m], shape (n,). E_min = 0 (3-16) up to `SOLVED`.
    """
    q, scale = q.copy(), weights(geometry)
    free = geometry.free.copy()
    free[geometry.turns] &= turning
    left, before = np.full(len(q), np.inf), np.full(len(q), np.inf)
    active = np.arange(len(q))
    for number in range(_MOST_STEPS):
        if number and number % _STUCK_STEPS == 0:
            active = active[left[active] <= _STUCK * before[active]]
            before[active] = left[active]
        if not len(active):
            break
        found = geometry.solving(q[active], chosen[active], ends=ends)
        kept = slice(None) if ends else list(found.firm)
        values = found.values[:, :, kept].reshape(len(active), -1)
        left[active] = np.linalg.norm(values, axis=1)
        going = left[active] > _ENOUGH * SOLVED * geometry.size
        active, values = active[going], values[going] / geometry.radius
        gradients = found.gradients[going][:, :, kept].reshape(len(active), values.shape[1], geometry.dimension)
        step = _step(np.where(free, gradients, 0.0) / scale, values)
        step *= geometry.radius / scale
        angle = np.linalg.norm(step[:, geometry.turns], axis=1, keepdims=True)
        step *= _LARGEST_ANGLE / np.maximum(angle, _LARGEST_ANGLE)
        q[active] = geometry.moved(q[active], step)
    return q, left


def _step(gradients: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The damped step; all is in units of the radius."""
    squares = np.einsum("nki,nkj->nij", gradients, gradients)
    damping = _DAMPING * np.minimum((values**2).sum(axis=1), 1.0)
    damping += _LEAST_DAMPING * (1.0 + np.einsum("nii->n", squares))
    squares += damping[:, None, None] * np.eye(squares.shape[1])
    return -np.linalg.solve(squares, np.einsum("nki,nk->ni", gradients, values)[..., None])[..., 0]
