"""What is measured, as vectors of one kind: forces, displacements, both, or forces and a known weight.

A signal s is dimensionless in its directions: moments are divided by a length L of the moving part, rotations
multiplied by it, and each block has length one, since a cone does not care how hard the robot pushes::

    force          s = [f; m / L]                    of the force that the robot applies, as p in (2-16)
    with a weight  s = [f; m / L; W]                 W = m g: p + w(q) is in F(q) if and only if s is in the cone of
                                                     [d; 0] and [-w(q); W]
    displacement   s = [dx; L dtheta]                (4-12)
    both           s = [force block; displacement]   the product of both cones

The last component of a weighed signal makes a cone of what is a shifted one, so that every operation of the thesis
serves. (4-7) has the sign of the reaction; here it is the force on the moving part that the contacts balance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Vector
from fixture_design.errors import InputError
from fixture_design.recognition.numbers_of import numbers_of

Measure = Literal["force", "displacement", "both"]

#: What vectors are about, whose origin is always the moving part's: axes fixed in the world (3-34), or the part's own.
Axes = Literal["fixed", "part"]

#: Vectors shorter than this are zero [N or m, after scaling]: a zero says nothing of its direction.
NOTHING = 1e-12


@dataclass(frozen=True)
class Signals:
    """How measurements become signals.

    Attributes:
        measure: what is measured.  axes: in which axes.
        plane: 2 in the plane, 3 in space.  length: L [m].
        weight: W [N]; 0: no weight is known, or it is tared.
    """

    measure: Measure
    axes: Axes
    plane: int
    length: float
    weight: float = 0.0

    @property
    def wrench_size(self) -> int:
        """d: 3 in the plane, 6 in space."""
        return 3 * (self.plane - 1)

    @property
    def force_size(self) -> int:
        """Numbers of the force block."""
        if self.measure == "displacement":
            return 0
        return self.wrench_size + (self.weight > 0)

    @property
    def size(self) -> int:
        """Numbers of a signal."""
        return self.force_size + (self.wrench_size if self.measure != "force" else 0)

    @cached_property
    def wrench_scale(self) -> Vector:
        """Factors that make [f; m] the first numbers of the force block."""
        return self._with_length(1 / self.length)

    @cached_property
    def twist_scale(self) -> Vector:
        """Factors that make [dx; dtheta] the displacement block."""
        return self._with_length(self.length)

    def signal(self, wrench: ArrayLike | None, twist: ArrayLike | None, floor: float = 0.0) -> np.ndarray:
        """The signal of a measurement. A block that was not measured, or is zero, is zero: every cone holds that.

        Args:
            floor: wrenches up to this length are zero [N]; not where a weight is known: then zero tells something.

        Raises:
            InputError: numbers that do not fit, or are not finite; no force where a classifier needs one.
        """
        blocks = []
        if self.force_size:
            blocks.append(self._force(self._checked(wrench, "wrench"), floor))
        if self.measure != "force":
            if self.measure == "both" and twist is None:
                blocks.append(np.zeros(self.wrench_size))
            else:
                blocks.append(_unit(self._checked(twist, "twist") * self.twist_scale))
        return blocks[0] if len(blocks) == 1 else np.concatenate(blocks)

    def force_rows(self, rows: Rows) -> np.ndarray:
        """Contact wrenches, shape (k, d), in the coordinates of the force block."""
        scaled = rows * self.wrench_scale
        return np.column_stack([scaled, np.zeros(len(scaled))]) if self.weight else scaled

    def weight_row(self, wrench: Vector) -> np.ndarray:
        """[-w; W] of the weight's wrench w."""
        return np.append(-wrench * self.wrench_scale, self.weight)

    def _force(self, wrench: Vector, floor: float) -> np.ndarray:
        scaled = wrench * self.wrench_scale
        return _unit(np.append(scaled, self.weight)) if self.weight else _unit(scaled, floor)

    def _with_length(self, factor: float) -> Vector:
        return np.concatenate([np.ones(self.plane), np.full(self.wrench_size - self.plane, factor)])

    def _checked(self, values: ArrayLike | None, name: str) -> Vector:
        if values is None:
            raise InputError(f"this classifier needs a {name}", expected=f"{self.wrench_size} numbers")
        vector = numbers_of(values, f"a {name}")
        if vector.shape != (self.wrench_size,):
            raise InputError(f"a {name} has {self.wrench_size} numbers here", found=f"an array of shape {vector.shape}")
        if not np.isfinite(vector).all():
            raise InputError(f"a {name} must be finite", found=str(vector.tolist()))
        return vector


def _unit(vector: Vector, floor: float = 0.0) -> Vector:
    size = math.sqrt(vector @ vector)
    return vector / size if size > max(floor, NOTHING) else np.zeros(len(vector))
