"""Closing the loop: the recognised state chooses what is controlled in position and what in force, and the next motion.

Each time a sample comes: the states that remain possible and the robot's pose move the belief of where the fixed parts
are; the likely state has its admissible displacements A and forces F (2-56); the plan wishes a displacement, and its
contacts a press; the command is the reciprocal pair nearest to both (2.6 (d)), the displacement for the target to go on
in A, the force added to it as the impedance needs.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fixture_design.analysis.hybrid_control import HybridControl, commanded_pair, hybrid_control, nearest_in
from fixture_design.arrays import Vector
from fixture_design.cones import ConeUnion, PolyhedralConvexCone, convert
from fixture_design.simulation.belief import Belief, relative
from fixture_design.simulation.plan import Plan
from fixture_design.simulation.setup import Robot
from fixture_design.simulation.simulation import Sample


@dataclass(frozen=True)
class Pace:
    """How a plan is carried out.

    Attributes:
        speed: of the target, angles times the part's radius [m/s].  period: between targets [s].
        most_force: that the target may pull with [N].  near: goals count as reached within this [m].
        surprised: time in an unexpected state before another leg is taken [s].  patience: most time for a leg [s].
    """

    speed: float = 0.015
    period: float = 0.02
    most_force: float = 8.0
    near: float = 8e-4
    surprised: float = 0.2
    patience: float = 5.0


@dataclass(eq=False)
class ClosedLoop:
    """The controller; it sees samples only.

    Attributes:
        leg: of the plan, which it is on.  history: (time, state, leg) whenever one of them changed.
    """

    plan: Plan
    robot: Robot
    belief: Belief
    rng: np.random.Generator
    pace: Pace = field(default_factory=Pace)
    leg: int = 0
    history: list[tuple[float, str, int]] = field(default_factory=list)
    _offset: np.ndarray = field(default_factory=lambda: np.zeros(3))
    _surprised: float = 0.0
    _since: float = 0.0

    def __post_init__(self) -> None:
        geometry = self.belief.states.geometry
        self._scale = np.array([1.0, 1.0, geometry.radius])
        robot = self.robot
        self._stiffness = np.array([robot.stiffness, robot.stiffness, robot.turning_stiffness]) / self._scale**2

    def target(self, sample: Sample) -> Vector:
        """The next virtual target, in the robot's frame, shape (3,)."""
        expected = self.plan.legs[self.leg].allowed
        self.belief, state, shift = self.belief.after(sample.pose, sample.possible, expected, self.rng)
        q = relative(shift, sample.pose)
        self._choose_leg(sample.time, state, q)
        control, pressed = self._control(state, q)
        wish = self._scale * (self.plan.legs[self.leg].goal - q)
        length = float(np.linalg.norm(wish))
        step = wish * min(1.0, self.pace.speed * self.pace.period / max(length, np.finfo(float).tiny))
        moved, force = commanded_pair(control, step, pressed)
        self._offset = self._limited(self._admissible(control, self._offset_now(sample, shift) + moved))
        ahead = (self._offset + force / self._stiffness) / self._scale
        self._before = sample.pose
        target = sample.pose + _turned(ahead, shift[2])
        self._target = sample.pose + _turned(self._offset / self._scale, shift[2])
        return target

    _before: Vector | None = None
    _target: Vector | None = None

    def _offset_now(self, sample: Sample, shift: Vector) -> np.ndarray:
        """How far the target without its press is ahead of the part now, scaled, as the fixed parts lie."""
        if self._target is None:
            return np.zeros(3)
        return self._scale * _turned(self._target - sample.pose, -shift[2])

    def _admissible(self, control: HybridControl, offset: np.ndarray) -> np.ndarray:
        cones = [convert(cone) for cone in control.displacements]
        return min((nearest_in(cone, offset) for cone in cones), key=lambda x: float(np.linalg.norm(x - offset)))

    def _limited(self, offset: np.ndarray) -> np.ndarray:
        return offset * min(1.0, self.pace.most_force / max(float(np.abs(offset * self._stiffness).max()), 1e-12))

    def _control(self, state: str, q: Vector) -> tuple[HybridControl, np.ndarray]:
        """A and F of a state near a configuration, scaled, and the wished press on all its contacts."""
        states = self.belief.states
        touching = states.touching[states.ids.index(state)]
        found = states.geometry.equations(q[None], states.pairs[None]).face_vectors[0][touching]
        rows = found / self._scale
        control = hybrid_control(ConeUnion.of([PolyhedralConvexCone.from_faces(rows, dimension=3)]))
        return control, self.plan.legs[self.leg].press * rows.sum(axis=0)

    def _choose_leg(self, time: float, state: str, q: Vector) -> None:
        leg, before = self.plan.legs[self.leg], self.leg
        apart = float(np.linalg.norm(self._scale * (leg.goal - q)))
        if apart <= self.pace.near and self.leg + 1 < len(self.plan.legs):
            self.leg += 1
        elif time - self._since > self.pace.patience and self.leg + 1 < len(self.plan.legs):
            self.leg = 0
        else:
            self._surprised = 0.0 if state in leg.allowed else self._surprised + self.pace.period
            if self._surprised > self.pace.surprised:
                self.leg = self.plan.joining(state, self.leg)
        if self.leg != before:
            self._surprised, self._since = 0.0, time
        if not self.history or self.history[-1][1:] != (state, self.leg):
            self.history.append((time, state, self.leg))


def _turned(vector: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])
