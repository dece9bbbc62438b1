"""A turned body at many configurations."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.assembly.circles import Circles, Cones
from fixture_design.assembly.turned_body import TurnedBody


@dataclass(frozen=True, eq=False)
class Placement:
    """The turned body at n configurations.

    Attributes:
        R, position: of its frame, shapes (n, 3, 3) and (n, 3).
        slides: whether `Touch.slide` is wanted, which takes time.
    """

    body: TurnedBody
    R: np.ndarray
    position: np.ndarray
    slides: bool = False

    @cached_property
    def axis(self) -> np.ndarray:
        return self.R @ self.body.axis

    def of(self, rows: np.ndarray) -> Placement:
        """Some of the placements."""
        return Placement(self.body, self.R[rows], self.position[rows], self.slides)

    @property
    def origin(self) -> np.ndarray:
        return self.R @ self.body.foot + self.position

    def circle(self, k: int) -> Circles:
        return self._circles[k]

    @cached_property
    def _circles(self) -> list[Circles]:
        """All of them, so that each has its basis once."""
        rows = zip(self.body.centers, self.body.radii.tolist(), strict=True)
        return [Circles.around(self.R @ center + self.position, self.axis, radius) for center, radius in rows]

    def surface(self, k: int) -> Cones:
        s, c = self.body.slopes[k].tolist()
        origin = self.R @ self.body.centers[k] + self.position
        return Cones(origin, self.axis, float(self.body.radii[k]), (s, c), float(self.body.lengths[k]))
