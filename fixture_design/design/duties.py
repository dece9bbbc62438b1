"""Duties: what the elements have to balance, and what clamps may push with for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Mask, Rows, Vector, Weights
from fixture_design.contacts import Scale

#: Wrenches that stand for all of a load path while searching; the verdict on the result looks at every row.
MOST_WRENCHES = 8


@dataclass(frozen=True, eq=False)
class Duties:
    """Wrenches on the part, and limits of each clamp's push.

    Attributes:
        wrenches: [f; m / length] about the candidates' reference, shape (w, d) [N]; the first is the weight alone
            where it is to press the locators.
        smooth: which of them are to be balanced without friction, shape (w,).
        pressed: which of them leave every locator pressed, shape (w,).
        low, high: what each candidate may push with as a clamp, shape (n,) [N]; inf without a limit.
        floor: what limits say it pushes with at least; low may be more where clamps are to press the part, shape (n,).
        pushes: which of them push with a preload where they are no locators, shape (n,); the others react.
        weight: of the part alone, as the wrenches are, shape (d,).
        required: whether a layout that cannot balance them is none.
    """

    wrenches: Rows
    smooth: Mask
    pressed: Mask
    low: Weights
    high: Weights
    floor: Weights
    pushes: Mask
    weight: Vector
    required: bool = False

    @classmethod
    def of(
        cls,
        weight: Vector,
        loads: Sequence[Vector],
        scale: Scale,
        limits: tuple[Weights, Weights, Weights],
        pushes: Mask,
        *,
        seated: bool,
        required: bool = False,
    ) -> Duties:
        """The duties of a weight and of loads, each with it: wrenches about W's origin.

        Args:
            loads: at least one, be it of nothing.
            limits: low, high and floor.
            seated: whether the clamps, with the weight alone, are to leave every locator pressed, without friction.
        """
        wrenches = [weight + load for load in loads]
        rows = np.array([scaled(wrench, scale) for wrench in ([weight, *wrenches] if seated else wrenches)])
        kept = _far_apart(rows)
        alone = np.array([seated and row == 0 for row in kept])
        return cls(rows[kept], alone, alone, *limits, pushes, scaled(weight, scale), required)

    def and_more(self, count: int) -> Duties:
        """The same for so many more candidates, which are no clamps."""
        more = np.zeros(count)
        low, high, floor = (np.append(values, more) for values in (self.low, self.high, self.floor))
        return replace(self, low=low, high=high, floor=floor, pushes=np.append(self.pushes, more > 0))

    def with_reserve(self, reserve: float) -> Duties:
        """The same with every load (1 + reserve) times as large besides, so that the preloads are at no limit."""
        loads = self.wrenches[~self.pressed]
        larger = loads + reserve * (loads - self.weight)
        more = np.zeros(len(larger), dtype=bool)
        return replace(
            self,
            wrenches=np.vstack([self.wrenches, larger]),
            smooth=np.append(self.smooth, more),
            pressed=np.append(self.pressed, more),
        )


def scaled(wrench: Vector, scale: Scale) -> Vector:
    """A wrench about W's origin as [f; m / length] about a scale's reference."""
    p = len(scale.reference)
    force, moment = wrench[:p], wrench[p:]
    if p == 2:
        moved = moment - (scale.reference[0] * force[1] - scale.reference[1] * force[0])
    else:
        moved = moment - np.cross(scale.reference, force)
    return np.concatenate([force, moved / scale.length])


def _far_apart(rows: Rows) -> list[int]:
    """The first row, and after it each time the one that is furthest from those there are."""
    kept = [0]
    away = np.linalg.norm(rows - rows[0], axis=1)
    while len(kept) < MOST_WRENCHES and away.max() > 0:
        kept.append(int(np.argmax(away)))
        away = np.minimum(away, np.linalg.norm(rows - rows[kept[-1]], axis=1))
    return kept
