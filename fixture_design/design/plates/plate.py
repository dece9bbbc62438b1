"""The modular plate: a grid of holes, what stands in them, and how far a clamp reaches."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, isfinite, pi

import numpy as np
from jaxtyping import Bool, Int

from fixture_design.errors import InputError


@dataclass(frozen=True)
class Clamp:
    """A clamp with a plunger that moves along a row or a column of holes; its tip is as round and wide as the plunger.

    Attributes:
        radius: of the plunger and its tip [m].
        shortest, longest: distance from the clamp's hole to the centre of the tip that the plunger can have [m].
        slant: largest angle between the plunger and the normal of the edge it pushes on [rad].

    Raises:
        InputError: a length is negative or not a number, ``longest`` is below ``shortest``, or ``slant`` is not from
            0 up to a right angle.
    """

    radius: float
    shortest: float = 0.0
    longest: float = inf
    slant: float = pi / 3

    def __post_init__(self) -> None:
        _check_length("the clamp's radius", self.radius)
        _check_length("the plunger's shortest reach", self.shortest)
        if not self.longest >= self.shortest:
            raise InputError(
                "the plunger's longest reach is not a length from the shortest one up",
                found=f"{self.longest:g} m",
                expected=f"at least {self.shortest:g} m",
            )
        if not 0 <= self.slant < pi / 2:
            raise InputError("the plunger's slant is no angle in [0, pi/2)", found=f"{self.slant:g} rad")

    @property
    def least_push(self) -> float:
        """cos(slant): how much of the plunger's direction must be along the edge's normal [-]."""
        return cos(self.slant)


@dataclass(frozen=True)
class Plate:
    """Holes at [i, j] pitch, for i < columns and j < rows, with round locators in three of them and a clamp at one.

    Attributes:
        pitch: distance of neighbouring holes [m].
        columns, rows: number of holes along x and y.
        locator_radius: [m]; zero for sharp tips.
        clamp: by default one whose tip is as round as the locators, of any reach.

    Raises:
        InputError: the pitch is not positive, there are no holes, or neighbouring locators overlap.

    Example:
        >>> Plate(pitch=0.025, columns=8, rows=6, locator_radius=0.006).plunger.radius
        0.006
    """

    pitch: float
    columns: int
    rows: int
    locator_radius: float
    clamp: Clamp | None = None

    def __post_init__(self) -> None:
        _check_length("the pitch", self.pitch)
        _check_length("the locators' radius", self.locator_radius)
        if self.columns < 1 or self.rows < 1:
            raise InputError("a plate has holes", found=f"{self.columns} columns and {self.rows} rows")
        if not 2 * self.locator_radius < self.pitch:
            raise InputError(
                "locators in neighbouring holes overlap",
                found=f"radius {self.locator_radius:g} m at pitch {self.pitch:g} m",
                expected="a radius below half the pitch",
            )

    @property
    def plunger(self) -> Clamp:
        """The clamp, also where none was given."""
        return Clamp(self.locator_radius) if self.clamp is None else self.clamp

    @property
    def reach(self) -> int:
        """Largest difference of two columns or two rows, along the longer side."""
        return max(self.columns, self.rows) - 1

    def holds(self, extents: Int[np.ndarray, "*k 2"]) -> Bool[np.ndarray, "*k"]:
        """Whether holes that extend over so many pitches in x and y fit on the plate, as they are or turned by 90."""
        return (extents.max(axis=-1) <= self.reach) & (extents.min(axis=-1) <= min(self.columns, self.rows) - 1)


def _check_length(what: str, length: float) -> None:
    if not (isfinite(length) and length >= 0):
        raise InputError(f"{what} must be a length >= 0", found=f"{length:g} m")
