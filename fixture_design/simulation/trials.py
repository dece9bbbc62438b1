"""Insertions with random start errors: one run each for whoever moves the target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.recognition import Classifier
from fixture_design.simulation.belief import Belief
from fixture_design.simulation.fixed_compliance import FixedCompliance
from fixture_design.simulation.insertion import ClosedLoop
from fixture_design.simulation.plan import Plan
from fixture_design.simulation.setup import Setup
from fixture_design.simulation.simulation import Controller, Run, Simulation

#: Makes whoever moves the target, from the trial and a seed.
Maker = Callable[["Trial", int], Controller]


@dataclass(frozen=True, eq=False)
class Trial:
    """What an insertion is.

    Attributes:
        plan: of the insertion.  classifier: of the recogniser.  setup: robot, surfaces, sensor.
        errors: largest start errors of the fixed parts, [x, y, theta], each way, shape (3,) [m, m, rad].
        depth: that counts as inserted [m].  duration: after which a run has failed [s].
    """

    plan: Plan
    classifier: Classifier
    setup: Setup = field(default_factory=Setup)
    errors: Vector = field(default_factory=lambda: np.array([0.012, 0.002, 0.05]))
    depth: float = 0.02
    duration: float = 15.0

    def shifts(self, count: int, seed: int) -> Rows:
        """Random start errors, uniform, shape (count, 3)."""
        return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3)) * self.errors


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a run ended.

    Attributes:
        inserted: time at which the depth was reached [s]; None: it was not.  run: all that happened.
        surprises: how often the closed loop was in a state that its leg did not expect.
    """

    inserted: float | None
    run: Run
    surprises: int = 0


def closed_loop(trial: Trial, seed: int) -> ClosedLoop:
    """The recognised state moves the target."""
    rng = np.random.default_rng(seed)
    # as wide as the errors: the standard deviation of a uniform error is its bound by the root of three
    belief = Belief.start(trial.plan.graph, trial.classifier, trial.errors / np.sqrt(3.0), rng)
    return ClosedLoop(trial.plan, trial.setup.robot, belief, rng)


def straight_down(trial: Trial, seed: int) -> FixedCompliance:
    """The target goes straight down where the hole should be."""
    return FixedCompliance.straight_down(trial.plan, trial.setup.robot)


def without_looking(trial: Trial, seed: int) -> FixedCompliance:
    """The target goes the plan's way as if nothing were displaced."""
    return FixedCompliance.along(trial.plan, trial.setup.robot)


def insert(trial: Trial, shift: Vector, seed: int, maker: Maker = closed_loop) -> Outcome:
    """One insertion.

    Args:
        shift: where the hole really is.  seed: of the sensor's noise and the controller's particles.
        maker: of the controller.
    """
    setup = replace(trial.setup, sensor=replace(trial.setup.sensor, seed=seed))
    free = next(state.id for state in trial.plan.graph.states if not state.contacts)
    simulation = Simulation.of(trial.plan.graph.assembly, trial.classifier, setup, shift, free)
    controller = maker(trial, seed)
    run = simulation.run(controller, trial.duration, until=lambda q: bool(q[1] <= -trial.depth))
    inserted = float(run.log.times[-1]) if run.true_final[1] <= -trial.depth else None
    return Outcome(inserted, run, getattr(controller, "surprises", 0))
