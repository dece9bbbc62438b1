"""Errors to first order against real geometry, moved rigidly until it touches, at the ends of all tolerances."""

from itertools import product

import numpy as np
import pytest

from fixture_design.contacts import Contact
from tests.analysis.locators import ROUND, asked, feature, only, pin, tip
from tests.analysis.rigid_placement import Axis, Plane, placements, shift, turns

LAYOUTS = 30
#: First order is this near, relative to the error [-].
FIRST_ORDER = 0.01
#: Tolerances relative to the part's size, up to the coarsest that anybody locates with [-].
SIZES = [1e-5, 1e-4, 1e-3]


def turned(contacts: list[Contact], R: np.ndarray, t: np.ndarray) -> list[Contact]:
    return [
        Contact(
            c.name, c.role, R @ c.point + t, tuple(tuple(R @ n for n in o) for o in c.clauses), clearance=c.clearance
        )
        for c in contacts
    ]


class Sample:
    """A random box with three tips under it, and two and one on its sides or a pin in a hole and one in a slot."""

    def __init__(self, seed: int, relative: float, angles: int, *, pins: bool) -> None:
        self.random = np.random.default_rng(seed)
        self.size = self.random.uniform(0.05, 0.3)
        self.tolerances = {name: self.size * relative * self.random.uniform(0.1, 1.0) for name in "ABCDEFPQ"}
        self.pins = pins
        contacts = self._under() + (self._pins(relative) if pins else self._sides())
        R, t = turns(self.random.normal(size=(1, 3)))[0], self.random.uniform(-1, 1, 3) * self.size
        self.contacts = turned(contacts, R, t)
        self.point = R @ (self.size * self.random.uniform(0.0, 1.0, 3)) + t
        direction = self.random.normal(size=3)
        self.direction = direction / np.linalg.norm(direction)
        self.angles = angles

    def _under(self) -> list[Contact]:
        corners = self.size * np.array([[0.1, 0.1], [0.9, 0.15], [0.5, 0.9]])
        spots = corners + self.size * self.random.uniform(-0.1, 0.1, (3, 2))
        return [tip(name, [*spot, 0.0], [0, 0, -1]) for name, spot in zip("ABC", spots, strict=True)]

    def _sides(self) -> list[Contact]:
        a, b, c = self.size * self.random.uniform([0.05, 0.7, 0.2], [0.3, 0.95, 0.8])
        height = self.size * self.random.uniform(0.05, 0.4, 3)
        return [
            tip("D", [a, 0, height[0]], [0, -1, 0]),
            tip("E", [b, 0, height[1]], [0, -1, 0]),
            tip("F", [0, c, height[2]], [-1, 0, 0]),
        ]

    def _pins(self, relative: float) -> list[Contact]:
        first, second = self.size * self.random.uniform([[0.1, 0.1], [0.6, 0.1]], [[0.4, 0.9], [0.9, 0.9]])
        self.clearances = self.size * relative * self.random.uniform(0.0, 1.0, 2)
        along = np.array([*(second - first), 0.0]) / np.linalg.norm(second - first)
        across = np.cross([0, 0, 1], along)
        hole = pin("P", [*first, 0.1 * self.size], 0.03 * self.size, self.clearances[0], ROUND)
        return hole + pin("Q", [*second, 0.1 * self.size], 0.03 * self.size, self.clearances[1], (across, -across))

    def geometry(self) -> tuple[list[Plane | Axis], np.ndarray]:
        """What the part is made of, and all errors at the ends of the tolerances, shape (n, constraints, 3)."""
        planes = [Plane(c.point, c.normals[0]) for c in self.contacts[: 3 if self.pins else 6]]
        ends = [
            [sign * self.tolerances[c.name] * c.normals[0] for sign in (-1, 1)] for c in self.contacts[: len(planes)]
        ]
        constraints: list[Plane | Axis] = list(planes)
        if self.pins:
            hole, slot = self.contacts[3:7], self.contacts[7:9]
            across = np.array([hole[0].normals[0], hole[1].normals[0]])
            middle = (slot[0].point + slot[1].point) / 2
            constraints += [Axis((hole[0].point + hole[2].point) / 2, across), Plane(middle, slot[0].normals[0])]
            radii = [
                self.tolerances[name] + clearance / 2 for name, clearance in zip("PQ", self.clearances, strict=True)
            ]
            circle = 2 * np.pi * np.arange(self.angles) / self.angles
            ends.append(list(radii[0] * (np.cos(circle)[:, None] * across[0] + np.sin(circle)[:, None] * across[1])))
            ends.append([sign * radii[1] * slot[0].normals[0] for sign in (-1, 1)])
        return constraints, np.array(list(product(*ends)))

    def worst(self) -> float:
        """The largest error over all samples of the moved geometry."""
        constraints, errors = self.geometry()
        return float(np.abs(shift(*placements(constraints, errors), self.point, self.direction)).max())

    def predicted(self) -> float:
        used = {name: self.tolerances[name] for name in ("ABCPQ" if self.pins else "ABCDEF")}
        return only(asked(self.contacts, used, [feature(self.point, self.direction, 1.0)])).worst


def deviations(relative: float, angles: int, *, pins: bool) -> np.ndarray:
    samples = [Sample(seed, relative, angles, pins=pins) for seed in range(LAYOUTS)]
    return np.array([abs(sample.worst() / sample.predicted() - 1) for sample in samples])


@pytest.mark.parametrize("relative", SIZES)
@pytest.mark.parametrize("pins", [False, True])
def test_first_order_is_near_the_moved_part(relative: float, pins: bool) -> None:
    """64 samples a layout of six tips, 1024 with a pin's circle in 64 steps."""
    assert deviations(relative, 64, pins=pins).max() < FIRST_ORDER


@pytest.mark.slow
@pytest.mark.parametrize("relative", SIZES)
def test_first_order_is_near_the_moved_part_in_fine_steps(relative: float) -> None:
    """6e4 samples a layout."""
    assert deviations(relative, 4096, pins=True).max() < FIRST_ORDER


def test_the_error_of_first_order_falls_with_the_tolerances() -> None:
    """It is of second order: a hundredth of the tolerance has a hundredth of the relative error."""
    coarse, fine = deviations(1e-3, 64, pins=False).max(), deviations(1e-5, 64, pins=False).max()
    assert fine < 0.02 * coarse


def test_errors_within_the_tolerances_stay_within_the_bound() -> None:
    """Not only the ends: random errors of tips and pins, the pins' anywhere in their discs."""
    sample = Sample(5, 1e-4, 8, pins=True)
    constraints, ends = sample.geometry()
    inside = np.random.default_rng(0).uniform(0, 1, (1000, 5, 1)) * ends[np.arange(1000) % len(ends)]
    errors = np.abs(shift(*placements(constraints, inside), sample.point, sample.direction))
    assert errors.max() < sample.predicted() * (1 + FIRST_ORDER)
    assert errors.max() > 0.5 * sample.predicted()
