"""CONVERT by double description (T. S. Motzkin et al., 1953; K. Fukuda, A. Prodon, 1996).

The cone face{a_1..a_m} is kept as a basis of its lines and a list of its extreme rays, each with the rows that it makes
active. A row more costs one step: rays on its right side go, and every adjacent pair across the row leaves a new ray on
it. The state is immutable, so a caller can go on from any step in several directions.

Zero tests are relative (unit rows, unit rays) and recorded: `DoubleDescription.is_certain` tells whether the largest
value taken as zero and the smallest taken as non-zero leave the undecided band empty.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Incidence, Rows, Vector
from fixture_design.cones.kernel.checks import require_tolerance, require_unit_rows
from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.directions import singular_directions
from fixture_design.errors import ConeError

#: More rays than this are refused: the next step would need gigabytes.
MAX_RAYS = 50_000
#: Pairs of rays looked at in one vectorised piece.
_PIECE = 200_000


@dataclass(frozen=True)
class DoubleDescription:
    """A cone {x : rows . x <= 0} with both its forms.

    Attributes:
        rows: shape (m, d), the unit rows in the order they were added.
        lines: shape (l, d), orthonormal basis of the lineality space.
        rays: shape (k, d), unit, orthogonal to the lines: one for each extreme ray modulo lines.
        incidence: shape (k, m), whether row . ray = 0.
        zero: values up to this are zeros.
        ambient: dimension of the space that the equalities leave, d if there are none.
        zero_max: largest value that was taken as zero.  nonzero_min: smallest that was not.
    """

    rows: Rows
    lines: Rows
    rays: Rows
    incidence: Incidence
    zero: float
    ambient: int
    zero_max: float = 0.0
    nonzero_min: float = np.inf

    @classmethod
    def whole_space(cls, dimension: int, zero: float) -> DoubleDescription:
        """The cone without rows: R^d, all lines."""
        nothing = np.zeros((0, dimension))
        return cls(nothing, np.eye(dimension), nothing, np.zeros((0, 0), dtype=bool), zero, dimension)

    def is_certain(self, band: float) -> bool:
        """Whether no value fell within ``band`` times the tolerance, on either side."""
        return self.zero_max < self.zero / band and self.nonzero_min > self.zero * band

    def add_row(self, row: Vector) -> DoubleDescription:
        """The cone cut by  row . x <= 0  (row: shape (d,), unit). Raises ConeError for another row."""
        native = compiled(len(row), len(self.rows) + 1)
        if native is not None:
            seen = (self.zero_max, self.nonzero_min)
            forms = native.add_row(self.rows, self.lines, self.rays, self.incidence, self.ambient, self.zero, seen, row)
            return _from_forms(np.vstack([self.rows, row]), self.zero, *forms)
        require_unit_rows(row[None, :])
        if len(self.lines):
            along_lines = self.lines @ row
            length = float(np.linalg.norm(along_lines))
            if length > self.zero:
                return self._cut_a_line(row, along_lines / length, length)
            seen_zero = max(self.zero_max, length)
        else:
            seen_zero = self.zero_max
        return self._cut_rays(row, seen_zero)

    def _cut_a_line(self, row: Vector, direction: Float[np.ndarray, " l"], length: float) -> DoubleDescription:
        """A line crosses the row: it turns into one ray, everything else slides along it onto the row."""
        line = direction @ self.lines
        remaining = _orthonormal_rest(self.lines, direction)
        slope = float(row @ line)
        slid = self.rays - np.outer(self.rays @ row / slope, line)
        norms = np.linalg.norm(slid, axis=1, keepdims=True)
        # the rays keep the rows they were on, since those vanish on the line; the new ray is on all of them
        incidence = np.ones((len(slid) + 1, len(self.rows) + 1), dtype=bool)
        incidence[:-1, :-1] = self.incidence
        incidence[-1, -1] = False
        return replace(
            self,
            rows=np.vstack([self.rows, row]),
            lines=remaining,
            rays=np.vstack([slid / norms, -line]),
            incidence=incidence,
            nonzero_min=min(self.nonzero_min, length),
        )

    def _cut_rays(self, row: Vector, zero_max: float) -> DoubleDescription:
        heights = self.rays @ row
        on = np.abs(heights) <= self.zero
        above, below = heights > self.zero, heights < -self.zero
        if on.any():
            zero_max = max(zero_max, float(np.abs(heights[on]).max()))
        nonzero_min = min(self.nonzero_min, float(np.abs(heights[~on]).min())) if (~on).any() else self.nonzero_min
        new_rays, new_incidence = self._rays_between(np.flatnonzero(above), np.flatnonzero(below), heights)
        rays = np.vstack([self.rays[~above], new_rays])
        flags = np.concatenate([on[~above], np.ones(len(new_rays), dtype=bool)])
        return replace(
            self,
            rows=np.vstack([self.rows, row]),
            rays=rays,
            incidence=np.column_stack([np.vstack([self.incidence[~above], new_incidence]), flags]),
            zero_max=zero_max,
            nonzero_min=nonzero_min,
        )

    def _rays_between(
        self, above: np.ndarray, below: np.ndarray, heights: Float[np.ndarray, " rays"]
    ) -> tuple[Rows, Incidence]:
        """One ray on the new row for every adjacent pair across it."""
        pairs = self._adjacent_pairs(above, below)
        upper, lower = pairs[:, 0], pairs[:, 1]
        rays = heights[upper, None] * self.rays[lower] - heights[lower, None] * self.rays[upper]
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        return rays, self.incidence[upper] & self.incidence[lower]

    def _adjacent_pairs(self, above: np.ndarray, below: np.ndarray) -> np.ndarray:
        """Pairs of rays that span a two-dimensional face: no third ray is on all the rows that both are on."""
        needed = self.ambient - len(self.lines) - 2
        active = self.incidence.astype(np.float32)
        inactive = 1.0 - active
        found = []
        piece = max(1, _PIECE // max(1, len(below)))
        for start in range(0, len(above), piece):
            upper = above[start : start + piece]
            shared = active[upper] @ active[below].T
            first, second = np.nonzero(shared >= needed)
            pairs = np.column_stack([upper[first], below[second]])
            for begin in range(0, len(pairs), 4096):
                part = pairs[begin : begin + 4096]
                common = active[part[:, 0]] * active[part[:, 1]]
                containing = (common @ inactive.T == 0).sum(axis=1)
                found.append(part[containing == 2])
        return np.vstack(found) if found else np.zeros((0, 2), dtype=int)


def _from_forms(
    rows: Rows, zero: float, lines: Rows, rays: Rows, incidence: Incidence, ambient: int, zero_max: float, least: float
) -> DoubleDescription:
    """What the compiled kernel returns."""
    return DoubleDescription(rows, lines, rays, incidence, zero, ambient, zero_max, least)


def _orthonormal_rest(lines: Float[np.ndarray, "l d"], direction: Float[np.ndarray, " l"]) -> Rows:
    """Orthonormal basis of the part of span(lines) orthogonal to ``direction`` (given in the lines' coordinates)."""
    return singular_directions(direction[None, :])[1][1:] @ lines


def double_description(rows: Rows, equalities: Rows, zero: float, max_rays: int = MAX_RAYS) -> DoubleDescription:
    """Both forms of {x : rows . x <= 0, equalities . x = 0}.

    Rows are taken in the order that cuts most rays first, which keeps the steps small and ends a closed cone early; the
    result's ``rows`` and ``incidence`` are in the caller's order.

    Args:
        rows: shape (m, d), unit (or zero).  equalities: shape (e, d), likewise.  zero: relative size of a zero.

    Raises:
        ConeError: more than ``max_rays`` extreme rays at some step; rows that are not unit, not finite.
    """
    native = compiled(rows.shape[1], len(rows))
    if native is not None:
        return _from_forms(rows, zero, *native.double_description(rows, equalities, zero, max_rays))
    require_tolerance(zero)
    require_unit_rows(rows)
    require_unit_rows(equalities)
    state = DoubleDescription.whole_space(rows.shape[1], zero)
    for equality in equalities:
        along = state.lines @ equality
        length = float(np.linalg.norm(along))
        if length > zero:
            state = replace(
                state,
                ambient=state.ambient - 1,
                lines=_orthonormal_rest(state.lines, along / length),
                nonzero_min=min(state.nonzero_min, length),
            )
        else:
            state = replace(state, zero_max=max(state.zero_max, length))
    waiting, order = list(range(len(rows))), []
    while waiting:
        if len(state.lines):
            cuts = np.linalg.norm(rows[waiting] @ state.lines.T, axis=1)
        else:
            cuts = (rows[waiting] @ state.rays.T > zero).sum(axis=1) if len(state.rays) else np.zeros(len(waiting))
        chosen = waiting.pop(int(np.argmax(cuts)))
        order.append(chosen)
        state = state.add_row(rows[chosen])
        if len(state.rays) > max_rays:
            raise ConeError(f"the cone has more than {max_rays} extreme rays after {len(state.rows)} face vectors")
        if not len(state.lines) and not len(state.rays):
            order += waiting
            break
    place = np.argsort(order)
    incidence = np.zeros((len(state.rays), len(rows)), dtype=bool)
    incidence[:, : state.incidence.shape[1]] = state.incidence
    return replace(state, rows=rows, incidence=incidence[:, place], rays=_polish(state, equalities))


def _polish(state: DoubleDescription, equalities: Rows) -> Rows:
    """The rays once more as null vectors of their active rows, which takes out what the steps have accumulated."""
    if not len(state.rays) or state.rays.shape[1] == 1:
        return state.rays
    fixed = np.vstack([state.lines, equalities])
    stack = np.zeros((len(state.rays), len(state.rows) + len(fixed), state.rows.shape[1]))
    stack[:, : len(state.rows)] = np.where(state.incidence[:, :, None], state.rows, 0.0)
    stack[:, len(state.rows) :] = fixed
    if stack.shape[1] < stack.shape[2]:
        stack = np.pad(stack, ((0, 0), (0, stack.shape[2] - stack.shape[1]), (0, 0)))
    _, values, right = np.linalg.svd(stack, full_matrices=False)
    null = right[:, -1]
    null = null * np.sign(np.einsum("kd,kd->k", null, state.rays))[:, None]
    # only where the active rows pin the ray down sharply; elsewhere the step's own ray is as good
    sharp = (values[:, -2] > np.sqrt(state.zero)) & (np.einsum("kd,kd->k", null, state.rays) > 0.9)
    return np.where(sharp[:, None], null, state.rays)
