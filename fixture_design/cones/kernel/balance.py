"""The largest load that pushes in second-order cones can balance: one interior point for many loads at once.

    minimise c . x  with  A x = b,  x_i = [t, z] in K_i = {|z| <= t},  t = 1 where the cone is a ball,

for each load l of length 1, where c = M^T l, A = N^T M, b = -N^T f and N spans the space orthogonal to l. Then
f + lambda l + M x = 0 for lambda = -l . (f + M x), and a motion q = l - N y with M^T q in the cones bounds lambda. The
equations are as many as the dimension of the wrenches, so a step costs one outer product a cone and one 5 x 5 Cholesky.

Method: homogeneous self-dual embedding, so that infeasible and unbounded loads end in rays instead of nowhere (Y. Ye,
M. J. Todd, S. Mizuno 1994), the scaling of Nesterov and Todd, Mehrotra's corrector (as in L. Vandenberghe, The CVXOPT
linear and quadratic cone program solvers, 2010). What comes out is a good guess and proves nothing: `balance_proof`
repairs and proves. The compiled twin is src/balance.rs, which takes four loads a step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.cone_algebra import Scaling, divided, dots, product, squares
from fixture_design.cones.kernel.embedding import DONE, Embedding, State
from fixture_design.cones.kernel.embedding_system import Move, System
from fixture_design.cones.kernel.threads import thread_count
from fixture_design.errors import ConeError

#: The compiled kernel takes so many dimensions with cones of a width.
_WIDEST_COMPILED = {2: 3, 3: 6, 4: 7}
#: Steps at most; 8 to 15 are usual.
_STEPS = 60
#: Steps at the end that keep tau and the gap and take the residuals to rounding.
_POLISHING = 2
#: No step is longer than one over this [-].
_SHORTEST_BACK = 1e-300
#: Part of the way to the boundary that a step goes [-].
_BACKED_OFF = 0.95


@dataclass(frozen=True, eq=False)
class Guesses:
    """Where the interior point ended, homogeneous: forces / size and motions / size solve the load, if size > 0.

    Attributes:
        forces: x, shape (k, n, w).
        motions: q = size l - N y, shape (k, r).
        sizes: tau, shape (k,); next to nothing where the load has no optimum and the others are a ray.
        steps: shape (k,), ints.
    """

    forces: np.ndarray
    motions: np.ndarray
    sizes: np.ndarray
    steps: np.ndarray


def balance_guesses(
    maps: np.ndarray,
    balls: np.ndarray,
    fixed: np.ndarray,
    loads: np.ndarray,
    *,
    seek: bool = True,
    threads: int | None = None,
) -> Guesses:
    """The interior point for k loads.

    Args:
        maps: M, shape (r, n, w): cones padded with zero columns to one width w, 2 to 4. A ball's first column is zero.
        balls: shape (n,), bool: cones whose t is 1.
        fixed: f, shape (k, r).  loads: shape (k, r), unit.
        seek: whether lambda is to be large; False asks only for some x.
        threads: by default one for each processor; the compiled kernel uses them.

    Raises:
        ConeError: shapes that do not fit, numbers that are not finite.
    """
    r, n, width = maps.shape
    if balls.shape != (n,) or fixed.shape != loads.shape or loads.shape[1:] != (r,) or not 2 <= width <= 4:
        raise ConeError(f"maps {maps.shape}, balls {balls.shape}, fixed {fixed.shape}, loads {loads.shape} do not fit")
    if not (np.isfinite(maps).all() and np.isfinite(fixed).all() and np.isfinite(loads).all()):
        raise ConeError("maps, fixed and loads must be finite")
    native = compiled(r)
    if native is not None and r <= _WIDEST_COMPILED[width]:
        flat = np.ascontiguousarray(maps.transpose(1, 2, 0)).reshape(n * width, r)
        found = native.balance_guesses(flat, balls, fixed, loads, width, seek, thread_count(threads))
        forces, motions, sizes, steps = found
        return Guesses(forces.reshape(-1, n, width), motions, sizes, steps)
    return _numpy_guesses(maps, balls, fixed, loads, seek)


def _numpy_guesses(maps: np.ndarray, balls: np.ndarray, fixed: np.ndarray, loads: np.ndarray, seek: bool) -> Guesses:
    problem = Embedding.of(maps, balls, fixed, loads, seek)
    state = problem.start()
    running = np.ones(len(loads), dtype=bool)
    steps = np.zeros(len(loads), dtype=int)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            running &= ~problem.finished(state)
            if not running.any():
                break
            after = _step(problem, state)
            running &= after.is_inside() & (after.centre(balls) < state.centre(balls) * (1 + DONE))
            state = after.where(running, state)
            steps += running
        state = _polished(problem, state)
    motions = state.tau[:, None] * loads - np.einsum("brm,bm->br", problem.basis, state.y)
    return Guesses(state.x, motions, state.tau, steps)


def _step(problem: Embedding, state: State) -> State:
    """Predictor, corrector, and as far as the cones go."""
    scaling = Scaling.of(state.x, state.s)
    system = System.of(problem, state, scaling)
    lam = scaling.times(state.s)
    mu = state.centre(problem.balls)
    ahead = system.direction(-lam, -state.tau * state.kappa, np.ones(len(mu)))
    far = np.minimum(_longest(lam, ahead, state), 1.0)
    sigma = (1 - far) ** 3
    crossed = product(ahead.x, ahead.s)
    crossed[:, :, 0] -= (sigma * mu)[:, None]
    goal = -lam - divided(lam, crossed)
    goal_tau = sigma * mu - state.tau * state.kappa - ahead.tau * ahead.kappa
    move = system.refined(system.direction(goal, goal_tau, 1 - sigma), 1 - sigma)
    far = np.minimum(_BACKED_OFF * _longest(lam, move, state), 1.0)
    alpha = far[:, None, None]
    x = state.x + alpha * scaling.times(move.x)
    tau = state.tau + far * move.tau
    x[:, problem.balls, 0] = tau[:, None]
    s = state.s + alpha * move.slack
    return State(x, s, state.y + far[:, None] * move.y, tau, state.kappa + far * move.kappa)


def _polished(problem: Embedding, state: State) -> State:
    """Steps back to the middle that leave tau alone and take A x = b tau, A^T y + s = c tau all the way."""
    for _ in range(_POLISHING):
        scaling = Scaling.of(state.x, state.s)
        system = System.of(problem, state, scaling)
        lam = scaling.times(state.s)
        middle = np.zeros(lam.shape)
        middle[..., 0] = (dots(lam, lam).sum(axis=1) / len(problem.balls))[:, None]
        move = system.refined(system.held(divided(lam, middle) - lam), np.ones(len(lam)))
        far = np.minimum(_BACKED_OFF * _longest(lam, move, state), 1.0)
        far = np.where(far > _BACKED_OFF / 2, far, 0.0)
        x = state.x + far[:, None, None] * scaling.times(move.x)
        x[:, problem.balls, 0] = state.tau[:, None]
        s, y = state.s + far[:, None, None] * move.slack, state.y + far[:, None] * move.y
        after = State(x, s, y, state.tau, state.kappa)
        # a ray has nothing to be polished
        state = after.where(after.is_inside() & (state.kappa < state.tau), state)
    return state


def _longest(lam: np.ndarray, move: Move, state: State) -> np.ndarray:
    """The longest step that stays in the cones, seen from the scaled point lam of both x and s."""
    size = np.sqrt(squares(lam))
    unit = lam / size[..., None]
    back = np.zeros(len(lam))
    for d in (move.x, move.s):
        first = unit[..., 0] * d[..., 0] - dots(unit[..., 1:], d[..., 1:])
        rest = d[..., 1:] - ((d[..., 0] + first) / (unit[..., 0] + 1))[..., None] * unit[..., 1:]
        back = np.maximum(back, ((np.sqrt(dots(rest, rest)) - first) / size).max(axis=1, initial=0.0))
    back = np.maximum(back, np.maximum(-move.tau / state.tau, -move.kappa / state.kappa))
    return 1 / np.maximum(back, _SHORTEST_BACK)
