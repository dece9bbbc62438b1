"""From an interior point's guesses to factors that are proved: pushes and motions repaired, then measured.

Pushes are moved to where they balance, then onto their cones, and count only if they still balance up to rounding.
Motions are mixed with one that all free cones oppose until none of them pushes along; what they bound is then a bound.
A load that no push takes up or whose pushes grow without end has a ray instead: a motion that shows that nothing is
held, or pushes that hold one load more again and again.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Mask
from fixture_design.cones.balance_space import RANK, BalanceSpace, flat, margins_of
from fixture_design.cones.force_cones import Factors

#: What is left of balanced wrenches, relative to the sum of their sizes [-]: rounding of a few hundred products.
BALANCED = 1e-13
#: A motion may be pushed along by this much of a cone's reach, where no strict motion repairs it [-].
OPPOSED = 1e-14
#: A wrench that nothing can take up stands out this far from rounding, relative to the sum of sizes [-]: far enough
#: that no pushes of reasonable size make up for it by what a motion may be pushed along.
STANDS_OUT = 1e-9
#: Pushes larger than this, next to what is fixed, hold it by rounding only [-].
_LARGEST = 1e7
#: Bounds may cross by this much, relative to their sizes or to what is fixed [-].
_CROSSED = 1e-12
#: Guesses that are this much larger than their tau are rays [-].
_RAY = 1e9
#: Pushes this small next to the largest may be left out [-].
_NEXT_TO_NOTHING = 1e-9
#: Rounds of moving pushes to balance and onto their cones.
_NEARER = 3
#: Room that repaired pushes and motions keep from the boundary, relative to their size [-].
_ROOM = 4e-15


def proved(space: BalanceSpace, loads: np.ndarray) -> Factors:
    """Factors for loads of shape (k, d)."""
    with np.errstate(all="ignore"):
        proofs = _Proofs(space, loads)
        proofs.run()
        return proofs.factors()


class _Proofs:
    """The bounds so far, in scaled units: unit loads l, and a fixed wrench f and clamps of size one at most."""

    def __init__(self, space: BalanceSpace, loads: np.ndarray) -> None:
        self.space = space
        scaled = loads * space.rows
        self.sizes = np.linalg.norm(scaled, axis=1)
        self.loads = scaled / np.where(self.sizes > 0, self.sizes, 1.0)[:, None]
        k = len(loads)
        self.lower, self.upper = np.full(k, -np.inf), np.full(k, np.inf)
        self.x = np.zeros((k, *space.maps.shape[1:]))
        self.starts = np.zeros(self.x.shape)
        self.motions = np.zeros(loads.shape)
        turned = np.einsum("rd,dnw->rnw", space.turn, space.maps[:, space.rest])
        self.turned = flat(turned)
        self.inverse = np.linalg.pinv(self.turned, rcond=RANK)
        # sizes of what pushes make: a cone's map is one long, a clamp's as long as it is
        self.reach = np.sqrt(np.einsum("dnw,dnw->n", space.maps, space.maps))

    def run(self) -> None:
        """By what the rest of the cones can do about a load: not reach it, do without it, or balance it."""
        space = self.space
        across, fixed_across = self.loads @ space.beyond, space.fixed @ space.beyond
        beyond = np.linalg.norm(across, axis=1) > RANK
        inside = np.linalg.norm(self.loads @ space.turn.T, axis=1)
        regular = ~beyond & (inside > RANK * np.linalg.norm(space.turn))
        if np.linalg.norm(fixed_across) > RANK:
            # no load but one that reaches as far could make up for that
            self._nothing(np.flatnonzero(~beyond), np.tile(space.beyond @ fixed_across, (len(self.loads), 1))[~beyond])
            regular &= np.isposinf(self.upper)
        self._beyond(np.flatnonzero(beyond), across[beyond], fixed_across)
        self._without(np.flatnonzero(~beyond & ~regular & np.isposinf(self.upper)))
        self._regular(np.flatnonzero(regular))

    def _beyond(self, which: Indices, across: np.ndarray, fixed_across: np.ndarray) -> None:
        """Where no push reaches, f + lambda l = 0 settles lambda; what remains is whether that is held."""
        if not len(which):
            return
        space = self.space
        tied = across / np.einsum("kc,kc->k", across, across)[:, None]
        only = tied @ space.beyond.T
        self._bound(which, only)
        factors = -(tied @ fixed_across)
        self._nothing(which, (fixed_across + factors[:, None] * across) @ space.beyond.T)
        fixed = space.fixed + factors[:, None] * self.loads[which]
        x, motions, sizes = self._held(fixed)
        self._reach(which, x / sizes[:, None, None])
        lost = np.isneginf(self.lower[which])
        self._reach(which[lost], np.zeros(x[lost].shape))
        motions -= np.einsum("kd,kd->k", self.loads[which], motions)[:, None] * only
        lost = np.isneginf(self.lower[which])
        self._nothing(which[lost], motions[lost])

    def _without(self, which: Indices) -> None:
        """Loads of zero, or that cones under stress take up: all factors, or none."""
        if not len(which):
            return
        x, motions, sizes = self._held(self.space.fixed[None])
        self._endless(which, np.zeros((len(which), *x.shape[1:])), np.repeat(x / sizes[:, None, None], len(which), 0))
        lost = np.isneginf(self.lower[which])
        self._nothing(which[lost], np.repeat(motions, len(which), 0)[lost])

    def _regular(self, which: Indices) -> None:
        if not len(which):
            return
        space = self.space
        turned = self.loads[which] @ space.turn.T
        unit = turned / np.linalg.norm(turned, axis=1, keepdims=True)
        fixed = np.tile(space.turn @ space.fixed, (len(which), 1))
        found = space.guesses(fixed, unit, seek=True)
        largest = np.maximum(np.abs(found.forces).max(axis=(1, 2)), np.abs(found.motions).max(axis=1))
        finite = found.sizes * _RAY > largest
        self._bound(which[finite], found.motions[finite] @ space.turn)
        first = found.forces / found.sizes[:, None, None]
        self._reach(which[finite], first[finite])
        if not space.fixed.any():
            self._reach(which, np.zeros(first.shape))
        lost = np.flatnonzero(np.isneginf(self.lower[which]) | ~finite)
        if not len(lost):
            return
        again = space.guesses(fixed[lost], unit[lost], seek=False)
        middle = again.forces / again.sizes[:, None, None]
        for motions in (found.motions[lost], again.motions):
            along = np.einsum("kr,kr->k", motions, unit[lost])[:, None]
            self._nothing(which[lost], (motions - along * unit[lost]) @ space.turn)
        self._reach(which[lost], np.zeros(middle.shape))
        self._reach(which[lost], middle)
        both = finite[lost]
        self._reach(which[lost[both]], first[lost[both]], middle[both])
        self._reach(which[lost[both]], self._nearby(first[lost[both]], self.loads[which[lost[both]]], space.fixed))
        endless = lost[~finite[lost]]
        self._endless(which[endless], found.forces[endless], middle[~finite[lost]])

    def _held(self, fixed: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """x, motions and tau for fixed wrenches of shape (k, d)."""
        space = self.space
        if not len(space.turn):
            x = np.zeros((len(fixed), int(space.rest.sum()), space.maps.shape[2]))
            return x, np.zeros(fixed.shape), np.ones(len(fixed))
        found = space.held(fixed @ space.turn.T)
        return found.forces, found.motions @ space.turn, found.sizes

    def _reach(self, which: Indices, rest: np.ndarray, middle: np.ndarray | None = None) -> None:
        """Raises the lower bounds by pushes of the rest, mixed with others if those are given."""
        if not len(which):
            return
        loads = self.loads[which]
        rest = self._moved(rest, loads, self.space.fixed, None)
        if middle is not None:
            rest = self._mixed(rest, self._moved(middle, loads, self.space.fixed, None))
        factors = self._factors_of(rest, loads)
        x = self._all(rest, self.space.fixed + factors[:, None] * loads, clamped=True)
        wrenches = self.space.fixed + np.einsum("dnw,knw->kd", self.space.maps, x)
        factors = -np.einsum("kd,kd->k", loads, wrenches)
        good = self._balances(wrenches + factors[:, None] * loads, x, np.abs(factors) + self._fixed_size)
        good &= factors > self.lower[which]
        self.lower[which[good]], self.x[which[good]] = factors[good], x[good]

    def _endless(self, which: Indices, rest: np.ndarray, start: np.ndarray) -> None:
        """Sets lower bounds to +inf where ``start`` holds f and some of the load, and ``rest`` one load more."""
        if not len(which):
            return
        loads, space = self.loads[which], self.space
        rest = rest.copy()
        rest[:, space.balls[space.rest]] = 0.0
        ahead = self._factors_of(rest, loads, fixed=np.zeros(loads.shape[1]))
        rest = np.where(ahead[:, None, None] > 0, rest / ahead[:, None, None], 0.0)
        rest = self._moved(rest, loads, np.zeros(loads.shape[1]), 1.0)
        rest = self._nearby(rest, loads, np.zeros(loads.shape[1]), 1.0)
        rest[:, space.balls[space.rest]] = 0.0
        x = self._all(rest, loads, clamped=False)
        good = self._balances(loads + np.einsum("dnw,knw->kd", space.maps, x), x, np.ones(len(which)))
        self._reach(which, start)
        good &= np.isfinite(self.lower[which])
        chosen = which[good]
        self.starts[chosen], self.x[chosen], self.lower[chosen] = self.x[chosen], x[good], np.inf

    def _moved(self, rest: np.ndarray, loads: np.ndarray, fixed: np.ndarray, factor: float | None) -> np.ndarray:
        """The nearest pushes that balance, not looking at the cones."""
        space = self.space
        for _ in range(2):
            factors = self._factors_of(rest, loads, fixed) if factor is None else np.full(len(loads), factor)
            wrenches = fixed + factors[:, None] * loads + self._wrenches(rest)
            step = (wrenches @ space.turn.T) @ self.inverse.T
            rest = rest - step.reshape(rest.shape)
        return rest

    def _nearby(
        self, rest: np.ndarray, loads: np.ndarray, fixed: np.ndarray, factor: float | None = None
    ) -> np.ndarray:
        """Pushes that balance where those that are next to nothing stay so: cones give as much as they push."""
        space = self.space
        if not rest.shape[1]:
            return rest
        for _ in range(_NEARER):
            free = space.free[space.rest]
            rest = rest.copy()
            rest[rest[..., 0] < _NEXT_TO_NOTHING * rest[..., :1].max(axis=1)] = 0.0
            rest[:, free] = _onto(rest[:, free])
            weights = np.where(free, rest[..., 0], 1.0 if factor is None else 0.0)[..., None] * np.ones(rest.shape)
            weights = np.where(np.isfinite(weights), weights, 0.0)
            factors = self._factors_of(rest, loads, fixed) if factor is None else np.full(len(loads), factor)
            left = (fixed + factors[:, None] * loads + self._wrenches(rest)) @ space.turn.T
            inverses = np.linalg.pinv(self.turned * flat(weights)[:, None], rcond=RANK)
            step = np.einsum("ksr,kr->ks", inverses, np.where(np.isfinite(left), left, 0.0))
            rest = rest - weights * step.reshape(rest.shape)
        return rest

    def _wrenches(self, rest: np.ndarray) -> np.ndarray:
        return flat(rest) @ flat(self.space.maps[:, self.space.rest]).T

    def _factors_of(self, rest: np.ndarray, loads: np.ndarray, fixed: np.ndarray | None = None) -> np.ndarray:
        """The factors that come nearest to balance, where cones under stress take up all they can."""
        fixed = self.space.fixed if fixed is None else fixed
        turned = loads @ self.space.turn.T
        beyond = loads @ self.space.beyond
        wrenches = fixed + self._wrenches(rest)
        # where no push reaches counts as well as where some do
        squares = np.einsum("kr,kr->k", turned, turned) + np.einsum("kc,kc->k", beyond, beyond)
        along = np.einsum("kr,kr->k", turned, wrenches @ self.space.turn.T)
        along += np.einsum("kc,kc->k", beyond, wrenches @ self.space.beyond)
        return np.where(squares > 0, -along / np.where(squares > 0, squares, 1.0), 0.0)

    def _mixed(self, rest: np.ndarray, middle: np.ndarray) -> np.ndarray:
        """As much of pushes in the middle as brings the others into the cones."""
        free = self.space.free[self.space.rest]
        out, room = self._room(rest, free), self._room(middle, free)
        short = np.where(out < 0, -out / (room - out), 0.0).max(axis=1, initial=0.0)
        short = np.where((room > 0).all(axis=1), np.minimum(short * (1 + _ROOM) + _ROOM, 1.0), 0.0)[:, None, None]
        return rest + short * (middle - rest)

    def _room(self, rest: np.ndarray, free: Mask) -> np.ndarray:
        heads = np.where(free, rest[..., 0], 1.0)
        return margins_of(np.concatenate([heads[..., None], rest[..., 1:]], axis=-1))

    def _all(self, rest: np.ndarray, wrenches: np.ndarray, *, clamped: bool) -> np.ndarray:
        """Pushes of all cones, on their cones: those under stress take up what the rest leaves of the wrenches."""
        space = self.space
        x = np.zeros((len(rest), *space.maps.shape[1:]))
        x[:, space.rest] = rest
        if clamped:
            x[:, space.balls, 0] = 1.0
            length = np.linalg.norm(x[:, space.balls, 1:], axis=2, keepdims=True)
            x[:, space.balls, 1:] *= np.where(length > 1 - _ROOM, (1 - _ROOM) / length, 1.0)
        x[:, space.free] = _onto(x[:, space.free])
        if space.stressed.any():
            left = wrenches + np.einsum("dnw,knw->kd", space.maps, x)
            taken = -(left @ space.relief.T).reshape(len(x), int(space.stressed.sum()), space.maps.shape[2])
            strict = margins_of(space.stress[space.stressed])
            short = (-margins_of(taken) / strict).max(axis=1) + _ROOM * np.abs(taken).max(axis=(1, 2))
            x[:, space.stressed] = taken + np.maximum(short, 0.0)[:, None, None] * space.stress[space.stressed]
            x[:, space.stressed] = _onto(x[:, space.stressed])
        return x

    @property
    def _fixed_size(self) -> float:
        return float(np.linalg.norm(self.space.fixed))

    def _balances(self, left: np.ndarray, x: np.ndarray, sizes: np.ndarray) -> Mask:
        sizes = sizes + np.linalg.norm(x, axis=2) @ self.reach
        return (np.linalg.norm(left, axis=1) <= BALANCED * sizes) & (sizes <= _LARGEST)

    def _opposition(self, motions: np.ndarray) -> np.ndarray:
        """M^T q, shape (k, n, w)."""
        space = self.space
        return (motions @ flat(space.maps)).reshape(len(motions), *space.maps.shape[1:])

    def _bound(self, which: Indices, motions: np.ndarray) -> None:
        """Lowers the upper bounds by motions, mixed with one that all free cones oppose."""
        space, loads = self.space, self.loads[which]
        motions = motions / np.linalg.norm(motions, axis=1, keepdims=True)
        if space.escape is not None:
            opposed = space.free & ~space.stressed
            strict = margins_of(self._opposition(space.escape[None])[0, opposed])
            short = (_ROOM - margins_of(self._opposition(motions)[:, opposed])) / strict
            motions = motions + np.maximum(short.max(axis=1, initial=0.0), 0.0)[:, None] * space.escape
        work = np.einsum("kd,kd->k", loads, motions)
        pushed = self._opposition(motions)
        good = self._is_opposed(pushed, motions) & (work > 0)
        factors = (self._clamps(pushed) - motions @ space.fixed) / work
        good &= factors < self.upper[which]
        self.upper[which[good]], self.motions[which[good]] = factors[good], (motions / work[:, None])[good]

    def _nothing(self, which: Indices, motions: np.ndarray) -> None:
        """Sets upper bounds to -inf where motions show that no factor is held."""
        if not len(which):
            return
        space, loads = self.space, self.loads[which]
        motions = motions / np.linalg.norm(motions, axis=1, keepdims=True)
        motions -= np.einsum("kd,kd->k", loads, motions)[:, None] * loads * (self.sizes[which] > 0)[:, None]
        pushed = self._opposition(motions)
        good = self._is_opposed(pushed, motions)
        clamped = self._clamps(pushed)
        good &= motions @ space.fixed - clamped > STANDS_OUT * (self._fixed_size + self.reach[space.balls].sum())
        chosen = which[good]
        self.upper[chosen], self.lower[chosen], self.motions[chosen] = -np.inf, -np.inf, motions[good]

    def _is_opposed(self, pushed: np.ndarray, motions: np.ndarray) -> Mask:
        sizes = OPPOSED * np.linalg.norm(motions, axis=1)
        return margins_of(pushed[:, self.space.free]).min(axis=1, initial=np.inf) >= -sizes

    def _clamps(self, pushed: np.ndarray) -> np.ndarray:
        """What clamps can do along motions at most, but for their heads, which are in the fixed wrench."""
        return np.linalg.norm(pushed[:, self.space.balls, 1:], axis=2).sum(axis=1)

    def factors(self) -> Factors:
        """The bounds in the units that were given."""
        space = self.space
        self._withdraw()
        sizes = np.where(self.sizes > 0, self.sizes, 1.0)
        endless = np.isposinf(self.lower)
        x = self.x * space.units[:, None]
        x[endless] *= (sizes / space.force)[endless, None, None]
        found = (self.lower > -np.inf) & ~endless
        forces, starts = self._columns(x, found), self._columns(self.starts * space.units[:, None], endless)
        scale = space.force / sizes
        motions = self.motions * space.rows / sizes[:, None]
        return Factors(self.lower * scale, self.upper * scale, forces, motions, starts)

    def _withdraw(self) -> None:
        """Takes both bounds back where they cross: a tie that rounding decides both ways."""
        sizes = np.maximum(np.maximum(np.abs(self.lower), np.abs(self.upper)), 1.0)
        sizes = np.where(np.isfinite(sizes), sizes, 0.0)
        tied = self.lower > self.upper + _CROSSED * sizes
        self.lower[tied], self.upper[tied] = -np.inf, np.inf
        self.x[tied], self.motions[tied], self.starts[tied] = 0.0, 0.0, 0.0

    def _columns(self, x: np.ndarray, held: Mask) -> np.ndarray:
        """One number a column of the maps; clamps without friction as well, where the fixed wrench is held."""
        cones = self.space.cones
        columns = np.zeros((len(x), cones.maps.shape[1] + 1))
        columns[:, cones.places[:, : x.shape[2]]] = x
        clamps = ~np.isnan(cones.heads)
        columns[:, cones.starts[clamps]] = np.where(held[:, None], cones.heads[clamps], 0.0)
        return columns[:, :-1]


def _onto(x: np.ndarray) -> np.ndarray:
    """x with t raised to |z|."""
    x = x.copy()
    lengths = np.linalg.norm(x[..., 1:], axis=-1)
    x[..., 0] = np.where(x[..., 0] < lengths * (1 + _ROOM), lengths * (1 + _ROOM), x[..., 0])
    return x
