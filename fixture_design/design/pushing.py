"""The least that clamps push with: a linear program over contact forces and preloads.

With d_e the face vectors of the edges of the friction cones (or of the normals), L the locators and K the clamps,

    min  sum p_k     over  p, forces c >= 0 of every wrench w
    with  sum_{i in L, e} c_wie d_ie + sum_{k in K, e} c_wke d_ke = w      (the contacts push the part along -d)
          sum_e c_wke = p_k,   low <= p_k <= high

for every wrench w. Its dual values y price what is not in the program: a clamp k is worth its push if
sum_w max_e y_w . d_ke > 1, a locator i its place for w if max_e y_w . d_ie > 0. Where nothing outside is worth it, the
least is that of all candidates: a bound for every choice of them (column generation).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Rows, Weights
from fixture_design.design.candidates import Several
from fixture_design.design.duties import Duties
from fixture_design.tolerances import DEFAULT

#: Every locator is pressed with this part of what all clamps push together, where it is to be pressed [-].
PRESSED = 1e-2
#: What a wrench that is not balanced costs, next to the same in preload [-]: more than any balance takes.
_UNBALANCED = 1e4


@dataclass(frozen=True, eq=False)
class Pushes:
    """The least preloads of some clamps.

    Attributes:
        total: their sum [N]; inf where they cannot balance the wrenches within their limits.
        each: of every clamp [N].
        duals: y, what a unit of each wrench costs, shape (w, d).
        reactions: the largest force of every locator in any of the balances [N].
        cost: total with what is not balanced: what column generation makes small.
    """

    total: float
    each: Weights
    duals: Float[np.ndarray, "w d"]
    reactions: Weights
    cost: float


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
        """The least preloads of these clamps that balance every wrench together with these locators."""
        from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

        duties, count = self.duties, len(clamps)
        dimension, unit = self.rough.shape[2], self._unit()
        blocks, tops = [], []
        for number, wrench in enumerate(duties.wrenches):
            blocks.append(self._block(number, locators, clamps))
            tops.append(np.concatenate([wrench / unit, np.zeros(count)]))
        widths = [block.shape[1] for block in blocks]
        height, width = dimension + count, sum(widths)
        matrix = np.zeros((height * len(blocks), width + count))
        at = np.concatenate([[0], np.cumsum(widths)]).astype(int)
        for number, block in enumerate(blocks):
            matrix[number * height : (number + 1) * height, at[number] : at[number + 1]] = block
            matrix[number * height + dimension : (number + 1) * height, width:] = -np.eye(count)
        costs = np.concatenate([*(self._costs(w, dimension) for w in widths), np.ones(count)])
        upper, right = self._pressing(locators, at, width, count)
        low = np.concatenate([np.zeros(width), duties.low[clamps] / unit])
        high = np.concatenate([np.full(width, np.inf), duties.high[clamps] / unit])
        found = linprog(
            costs, A_ub=upper, b_ub=right, A_eq=matrix, b_eq=np.concatenate(tops),
            bounds=np.column_stack([low, high]), method="highs",
        )  # fmt: skip
        assert found.x is not None  # slacks make every program feasible
        each = found.x[width:] * unit
        slack = float(np.dot(costs[:width], found.x[:width])) / _UNBALANCED
        duals = found.eqlin.marginals.reshape(len(blocks), height)[:, :dimension]
        total = float(each.sum()) if slack <= DEFAULT.near else np.inf
        edges = [self.rows(number).shape[1] for number in range(len(blocks))]
        forces = [
            found.x[start : start + len(locators) * k].reshape(len(locators), k).sum(axis=1)
            for start, k in zip(at[:-1].tolist(), edges, strict=True)
        ]
        return Pushes(total, each, duals, np.max(forces, axis=0) * unit, float(found.fun) * unit)

    def _unit(self) -> float:
        """The size of the wrenches [N], 1 where there are none."""
        return float(np.abs(self.duties.wrenches).max()) or 1.0

    def _block(self, wrench: int, locators: Indices, clamps: Indices) -> np.ndarray:
        """One wrench's equations: forces of locators, of clamps, slacks; and that a clamp's forces add to its push."""
        rows = self.rows(wrench)
        dimension = rows.shape[2]
        of_locators = rows[locators].reshape(-1, dimension).T
        of_clamps = rows[clamps].reshape(-1, dimension).T
        slacks = np.hstack([np.eye(dimension), -np.eye(dimension)])
        sums = np.kron(np.eye(len(clamps)), np.ones((1, rows.shape[1])))
        low = np.hstack([np.zeros((len(clamps), of_locators.shape[1])), sums, np.zeros((len(clamps), 2 * dimension))])
        return np.vstack([np.hstack([of_locators, of_clamps, slacks]), low])

    def _costs(self, width: int, dimension: int) -> Weights:
        return np.concatenate([np.zeros(width - 2 * dimension), np.full(2 * dimension, _UNBALANCED)])

    def _pressing(
        self, locators: Indices, at: Indices, width: int, count: int
    ) -> tuple[np.ndarray | None, Weights | None]:
        """Rows that say: every locator is pressed with a part of what all clamps push."""
        rows = []
        for number in np.flatnonzero(self.duties.pressed).tolist():
            edges = self.rows(number).shape[1]
            for place in range(len(locators)):
                row = np.zeros(width + count)
                first = int(at[number]) + place * edges
                row[first : first + edges] = -1.0
                row[width:] = PRESSED
                rows.append(row)
        return (np.array(rows), np.zeros(len(rows))) if rows else (None, None)

    def worth(self, duals: Rows, candidates: Indices) -> Weights:
        """sum_w max_e y_w . d_ke of candidates as clamps; above 1 it pays to let them push."""
        return sum(
            ((self.rows(number)[candidates] @ y).max(axis=1) for number, y in enumerate(duals)),
            start=np.zeros(len(candidates)),
        )

    def use(self, duals: Rows, candidates: Indices) -> Weights:
        """The largest of max_e y_w . d_ie of candidates as locators; above 0 their reactions would help."""
        return np.max([(self.rows(number)[candidates] @ y).max(axis=1) for number, y in enumerate(duals)], axis=0)
