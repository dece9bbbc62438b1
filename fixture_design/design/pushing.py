"""The least that clamps push with: a linear program over contact forces and preloads.

With d_e the face vectors of the edges of the friction cones (or of the normals), K the clamps that push with a preload,
and R all that only reacts (locators, supports, fingers, bodies),

    min  sum p_k     over  p, forces c >= 0 of every wrench w
    with  sum_{i in R, e} c_wie d_ie + sum_{k in K, e} c_wke d_ke = w      (the contacts push the part along -d)
          sum_e c_wke = p_k,   low <= p_k <= high

for every wrench w. Where there are no such forces, the least |w - ...|_1 comes first, and then the least sum of p that
leaves no more. The dual values y of what is made small price what is not in the program: a clamp k is worth its push if
sum_w max_e y_w . d_ke is more than the price of a push, a locator i its place for w if max_e y_w . d_ie > 0. Where
nothing outside is worth it, the least is that of all candidates: a bound for every choice of them (column generation).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Rows, Weights
from fixture_design.design.candidates import Several
from fixture_design.design.duties import Duties
from fixture_design.tolerances import DEFAULT, LOAD_TIE, PRESSED


@dataclass(frozen=True, eq=False)
class Pushes:
    """The least preloads of some clamps.

    Attributes:
        total: their sum [N]; inf where they cannot balance the wrenches within their limits.
        unbalanced: what is left of the wrenches then, the sum of all coordinates [N].  barely: whether that is no more
            than `LOAD_TIE` of the largest: they are at the limit.
        each: of every clamp [N]; 0 of those that only react.
        duals: y, what a unit of each wrench costs, shape (w, d).
        price: what a unit of push costs, next to these [-]: 1 and what it takes to keep locators pressed; no more than
            the latter where wrenches are not balanced, whatever that takes.
        reactions: the largest force of every locator in any of the balances [N].
    """

    total: float
    unbalanced: float
    each: Weights
    duals: Float[np.ndarray, "w d"]
    price: float
    reactions: Weights
    barely: bool = False

    def less_than(self, other: Pushes, part: float) -> bool:
        """Whether they push with less by this part of it; or, where neither balances, leave less by it."""
        if np.isinf(self.total) and np.isinf(other.total):
            return self.unbalanced < other.unbalanced * (1 - part)
        return self.total < other.total * (1 - part)


@dataclass(frozen=True, eq=False)
class _System:
    """matrix @ x = right, upper @ x <= 0, low <= x <= high; which of x are slacks, and which preloads."""

    matrix: np.ndarray
    right: Weights
    upper: np.ndarray | None
    low: Weights
    high: Weights
    slacks: Mask
    preloads: Mask

    def least(self, costs: Mask, slack: Weights | float, most: Weights | None = None) -> Any:
        """What scipy finds for the least sum of some of x, with no more than ``slack`` in each slack.

        Args:
            most: what stands to the right of ``upper``, by default zeros.
        """
        from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

        high = self.high.copy()
        high[self.slacks] = slack
        zeros = None if self.upper is None else np.zeros(len(self.upper))
        return linprog(
            costs.astype(float), A_ub=self.upper, b_ub=zeros if most is None else most,
            A_eq=self.matrix, b_eq=self.right, bounds=np.column_stack([self.low, high]), method="highs",
        )  # fmt: skip


#: More slack than the least, where the solver takes this for infeasible [-]: it keeps its equations to 1e-7.
_SLACKS = (DEFAULT.near, 1e-6, 1e-5, 1e-4)


@dataclass(frozen=True, eq=False)
class Program:
    """What pushes how: face vectors of all candidates with and without friction, shape (n, k, d), and the duties."""

    rough: Several
    smooth: Float[np.ndarray, "n j _"]
    duties: Duties

    def rows(self, wrench: int) -> Several:
        """The face vectors that may balance a wrench."""
        return self.smooth if self.duties.smooth[wrench] else self.rough

    def least(self, locators: Indices, clamps: Indices) -> Pushes:
        """The least preloads of these clamps that balance every wrench together with these locators.

        Args:
            clamps: all that are no locators; those that do not push (`Duties.pushes`) react.
        """
        pushing = self.duties.pushes[clamps]
        system, reacting = self._system(locators, clamps)
        found = priced = system.least(system.preloads, 0.0)
        left = 0.0
        if found.x is None:
            first = system.least(system.slacks, np.inf)
            assert first.x is not None  # slacks make every program feasible
            left = float(first.x[system.slacks].sum())
            slack = np.maximum(first.x[system.slacks], 0.0)
            found = next(
                again for more in _SLACKS if (again := system.least(system.preloads, slack + more)).x is not None
            )  # what came first is inside these limits, but for what the solver calls feasible
            priced = first if left > DEFAULT.near else found
        each, unit = np.zeros(len(clamps)), self._unit()
        each[pushing] = found.x[system.preloads] * unit
        pressing = 0.0 if system.upper is None else -PRESSED * float(priced.ineqlin.marginals.sum())
        duals = priced.eqlin.marginals.reshape(len(self.duties.wrenches), -1)[:, : self.rough.shape[2]]
        reactions = self._reactions(found.x, reacting, system)[: len(locators)]
        if left > DEFAULT.near:
            return Pushes(np.inf, left * unit, each, duals, pressing, reactions, left <= LOAD_TIE)
        return Pushes(float(each.sum()), 0.0, each, duals, 1.0 + pressing, reactions)

    def total(self, locators: Indices, clamps: Indices) -> float:
        """The total of `least` alone, which is inf at once where there is no balance."""
        system, _ = self._system(locators, clamps)
        found = system.least(system.preloads, 0.0)
        return np.inf if found.x is None else float(found.x[system.preloads].sum()) * self._unit()

    def least_within(self, locators: Indices, clamps: Indices, slopes: np.ndarray, fixed: Weights) -> Weights | None:
        """What those that push do at least, shape (k,) [N], if besides slopes @ p + fixed >= 0; None if nothing does.

        Args:
            slopes: shape (m, k).  fixed: shape (m,) [N].
        """
        system, _ = self._system(locators, clamps)
        more = np.hstack([np.zeros((len(slopes), int((~system.preloads).sum()))), -slopes])
        upper = more if system.upper is None else np.vstack([system.upper, more])
        most = np.append(np.zeros(len(upper) - len(more)), fixed / self._unit())
        found = replace(system, upper=upper).least(system.preloads, 0.0, most)
        return None if found.x is None else found.x[system.preloads] * self._unit()

    def _system(self, locators: Indices, others: Indices) -> tuple[_System, Indices]:
        """The equations of all wrenches, one under the other, and the columns of each beside those of the next; and
        what reacts, the locators first.

        Args:
            others: clamps that push, and what only reacts.
        """
        pushing = self.duties.pushes[others]
        reacting, clamps = np.concatenate([locators, others[~pushing]]).astype(np.int64), others[pushing]
        duties, count, unit = self.duties, len(clamps), self._unit()
        dimension = self.rough.shape[2]
        blocks = [self._block(number, reacting, clamps) for number in range(len(duties.wrenches))]
        widths = [block.shape[1] for block in blocks]
        height, width = dimension + count, sum(widths)
        at = np.concatenate([[0], np.cumsum(widths)]).astype(int)
        matrix, slacks = np.zeros((height * len(blocks), width + count)), np.zeros(width + count, dtype=bool)
        for number, block in enumerate(blocks):
            matrix[number * height : (number + 1) * height, at[number] : at[number + 1]] = block
            matrix[number * height + dimension : (number + 1) * height, width:] = -np.eye(count)
            slacks[at[number + 1] - 2 * dimension : at[number + 1]] = True
        right = np.hstack([duties.wrenches / unit, np.zeros((len(blocks), count))]).ravel()
        low = np.concatenate([np.zeros(width), duties.low[clamps] / unit])
        high = np.concatenate([np.full(width, np.inf), duties.high[clamps] / unit])
        upper = self._pressing(len(locators), at, width, count)
        return _System(matrix, right, upper, low, high, slacks, np.arange(width + count) >= width), reacting

    def _reactions(self, x: Weights, reacting: Indices, system: _System) -> Weights:
        """The largest force of everything that reacts, in any of the balances [N]."""
        ends = np.flatnonzero(system.slacks)[2 * self.rough.shape[2] - 1 :: 2 * self.rough.shape[2]] + 1
        starts = np.concatenate([[0], ends[:-1]]).astype(int)
        forces = []
        for number, start in enumerate(starts.tolist()):
            edges = self.rows(number).shape[1]
            forces.append(x[start : start + len(reacting) * edges].reshape(len(reacting), edges).sum(axis=1))
        return np.max(forces, axis=0) * self._unit()

    def _unit(self) -> float:
        """The size of the wrenches [N], 1 where there are none."""
        return float(np.abs(self.duties.wrenches).max()) or 1.0

    def _block(self, wrench: int, reacting: Indices, clamps: Indices) -> np.ndarray:
        """One wrench's equations: forces of what reacts, of clamps, slacks; a clamp's forces add to its push."""
        rows = self.rows(wrench)
        dimension = rows.shape[2]
        of_reacting = rows[reacting].reshape(-1, dimension).T
        of_clamps = rows[clamps].reshape(-1, dimension).T
        slacks = np.hstack([np.eye(dimension), -np.eye(dimension)])
        sums = np.kron(np.eye(len(clamps)), np.ones((1, rows.shape[1])))
        low = np.hstack([np.zeros((len(clamps), of_reacting.shape[1])), sums, np.zeros((len(clamps), 2 * dimension))])
        return np.vstack([np.hstack([of_reacting, of_clamps, slacks]), low])

    def _pressing(self, locators: int, at: Indices, width: int, count: int) -> np.ndarray | None:
        """Rows that say: every locator, the first of what reacts, is pressed with a part of what all clamps push."""
        rows = []
        for number in np.flatnonzero(self.duties.pressed).tolist():
            edges = self.rows(number).shape[1]
            for place in range(locators):
                row = np.zeros(width + count)
                first = int(at[number]) + place * edges
                row[first : first + edges] = -1.0
                row[width:] = PRESSED
                rows.append(row)
        return np.array(rows) if rows else None

    def worth(self, duals: Rows, candidates: Indices) -> Weights:
        """sum_w max_e y_w . d_ke of candidates as clamps; above the price it pays to let them push."""
        return sum(
            ((self.rows(number)[candidates] @ y).max(axis=1) for number, y in enumerate(duals)),
            start=np.zeros(len(candidates)),
        )

    def use(self, duals: Rows, candidates: Indices) -> Weights:
        """The largest of max_e y_w . d_ie of candidates as locators; above 0 their reactions would help."""
        return np.max([(self.rows(number)[candidates] @ y).max(axis=1) for number, y in enumerate(duals)], axis=0)
