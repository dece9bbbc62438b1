"""What the closed loop is compared with: the same impedance, and a target that goes its way whatever is felt."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.simulation.insertion import Pace
from fixture_design.simulation.plan import Plan
from fixture_design.simulation.setup import Robot
from fixture_design.simulation.simulation import Sample


@dataclass(eq=False)
class FixedCompliance:
    """A target that runs along configurations at a constant speed.

    Attributes:
        goals: configurations in the robot's frame, the first one the start.  presses: force added on the way to each,
            [f; m], shape (n, 3) [N, N m].  radius: what angles are multiplied by in distances [m].
    """

    goals: np.ndarray
    presses: np.ndarray
    radius: float
    robot: Robot
    pace: Pace = field(default_factory=Pace)

    @classmethod
    def straight_down(cls, plan: Plan, robot: Robot) -> FixedCompliance:
        """Upright over where the hole should be, then down as deep as the plan goes."""
        last = plan.legs[-1].goal
        above = np.array([last[0], plan.legs[0].goal[1], last[2]])
        goals = np.array([above, last])
        return cls(goals, np.zeros((2, 3)), geometry_of(plan.graph.assembly).radius, robot)

    @classmethod
    def along(cls, plan: Plan, robot: Robot) -> FixedCompliance:
        """The goals of a plan with the presses of its contacts, as if nothing were displaced."""
        geometry = geometry_of(plan.graph.assembly)
        presses = []
        for leg in plan.legs:
            chosen = [geometry.names.index(name) for name in plan.graph.state(leg.state).contacts]
            q, pairs = leg.goal[None], np.array([chosen], dtype=int)
            rows = geometry.equations(q, pairs).face_vectors[0] if chosen else np.zeros((0, 3))
            presses.append(leg.press * rows.sum(axis=0))
        return cls(np.array([leg.goal for leg in plan.legs]), np.array(presses), geometry.radius, robot)

    @property
    def start(self) -> Vector:
        """The first of the goals."""
        return self.goals[0]

    def target(self, sample: Sample) -> Vector:
        """Where the target is now, and what it is pressed with, shape (3,)."""
        scale = np.array([1.0, 1.0, self.radius])
        lengths = np.linalg.norm(np.diff(self.goals, axis=0) * scale, axis=1)
        left = self.pace.speed * sample.time
        for k, length in enumerate(lengths.tolist()):
            if left <= length:
                share = left / max(length, np.finfo(float).tiny)
                return self.goals[k] + share * (self.goals[k + 1] - self.goals[k]) + self._given(k + 1)
            left -= length
        return self.goals[-1] + self._given(len(self.goals) - 1)

    def _given(self, k: int) -> np.ndarray:
        stiffness = np.array([self.robot.stiffness, self.robot.stiffness, self.robot.turning_stiffness])
        return self.presses[k] / stiffness
