"""Bounds over seats against where parts come to rest: least potential over all that the elements leave free.

With all errors drawn, the part under a wrench w rests where w . q is largest among the q with d_i . q <= s_i: a linear
program, which knows nothing of seats, circuits or weights.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import linprog

from fixture_design.analysis import accurate
from fixture_design.contacts import Contact, face_vectors
from fixture_design.layout import Answer, FeatureError, Finding, element_name
from fixture_design.verification.accuracy_proofs import accuracy_fault
from tests.analysis.locators import ROUND, feature, layout_of, only, pad, pin, tip

UM = 1e-6
#: The program's own tolerance, relative to the errors [-].
SOLVED = 1e-6
KINDS = ["tips", "pads", "pins", "form"]
#: Layouts drawn of each; pads have hundreds of seats.
LAYOUTS = {"tips": 12, "pads": 4, "pins": 12, "form": 4}


@dataclass
class Drawn:
    """A random layout that locates more than once, and what presses it."""

    kind: str
    seed: int

    def __post_init__(self) -> None:
        self.random = np.random.default_rng([KINDS.index(self.kind), self.seed])
        self.contacts = self._under() + self._aside()
        self.rows = face_vectors(
            np.array([c.point for c in self.contacts]), np.array([c.normals[0] for c in self.contacts])
        )
        names = dict.fromkeys(element_name(c.name) for c in self.contacts)
        self.errors = {name: self.random.uniform(1, 20) * UM for name in names}
        self.form = 2 * UM if self.kind == "form" else 0.0
        self.wrench = self.random.uniform(0.1, 1.0, len(self.rows)) @ self.rows
        self.target = feature(self.random.uniform(-0.02, 0.12, 3).tolist(), self.random.normal(size=3).tolist(), 1.0)

    def _under(self) -> list[Contact]:
        spots = np.array([[0.01, 0.01], [0.09, 0.01], [0.08, 0.07], [0.02, 0.08]]) + self.random.uniform(
            -0.01, 0.01, (4, 2)
        )
        if self.kind in ("pads", "form"):
            three = zip("ABC", spots[:3], strict=True)
            return [corner for name, spot in three for corner in pad(name, (*spot, 0.0), 0.01)]
        return [tip(name, [*spot, 0], [0, 0, -1]) for name, spot in zip("ABCG", spots, strict=True)]

    def _aside(self) -> list[Contact]:
        if self.kind == "pins":
            return [*pin("P", (0.02, 0.03, 0.0), 0.004, 0.0, ROUND), *pin("Q", (0.08, 0.04, 0.0), 0.003, 0.0, ROUND)]
        places = [*self.random.uniform([0.01, 0.07, 0.04], [0.03, 0.09, 0.06])]
        sides = [tip(name, [x, 0, 0.02], [0, -1, 0]) for name, x in zip("DEH", places, strict=True)]
        return [*sides[: 3 if self.kind == "tips" else 2], tip("F", [0, 0.04, 0.02], [-1, 0, 0])]

    def found(self, tolerance: float) -> Finding:
        """Confirmed by the checker."""
        target = feature(self.target.point.tolist(), self.target.direction.tolist(), tolerance)
        layout, group = layout_of(self.contacts, self.errors, [target], form=self.form, center=[0, 0, 0])
        finding = accurate(layout, group, np.zeros(3), weight=lambda _: self.wrench)
        if finding.answer is not Answer.UNDECIDED:
            assert accuracy_fault(finding, self.contacts) is None
        return finding

    def bound(self) -> FeatureError:
        return only(self.found(1.0))

    def rest(self, *, extreme: bool) -> float:
        """The feature's error with errors drawn, at the ends of tolerances or within."""
        errors = np.zeros(len(self.rows))
        for name, size in self.errors.items():
            own = [i for i, c in enumerate(self.contacts) if element_name(c.name) == name]
            errors[own] = size * (self.random.choice([-1, 1]) if extreme else self.random.uniform(-1, 1))
        form = self.random.choice([-1, 1], len(errors)) if extreme else self.random.uniform(-1, 1, len(errors))
        limits = (errors + self.form * form) / UM
        best = linprog(-self.wrench, A_ub=self.rows, b_ub=limits, bounds=[(None, None)] * 6)
        assert best.status == 0
        moved = best.x[:3] + np.cross(best.x[3:], self.target.point)
        return abs(float(self.target.direction @ moved / np.linalg.norm(self.target.direction))) * UM


@pytest.mark.parametrize("kind", ["tips", "pads", "form"])
def test_no_part_comes_to_rest_beyond_the_bound(kind: str) -> None:
    """40 draws a layout; and somewhere the bound is nearly reached, so that it is not just large."""
    nearest = []
    for seed in range(LAYOUTS[kind]):
        drawn = Drawn(kind, seed)
        worst = drawn.bound().worst
        errors = [drawn.rest(extreme=draw % 4 > 0) for draw in range(40)]
        seen = max(errors)
        assert seen <= worst * (1 + SOLVED)
        nearest.append(seen / worst)
    assert max(nearest) > 0.85


@pytest.mark.parametrize("kind", KINDS)
def test_just_below_the_bound_it_is_refused_or_left_open(kind: str) -> None:
    """Yes above the worst, never below it; where a displacement shows it, no, and the checker has confirmed that."""
    refused = 0
    for seed in range(LAYOUTS[kind]):
        drawn = Drawn(kind, seed)
        worst = drawn.bound().worst
        assert drawn.found(1.001 * worst).answer is Answer.YES
        below = drawn.found(0.999 * worst)
        assert below.answer is not Answer.YES
        refused += below.answer is Answer.NO
    assert refused >= LAYOUTS[kind] - 2
