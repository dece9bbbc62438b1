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
from fixture_design.simulation.belief import Belief, relative, turned
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
        surprises: how often another leg was taken since a state was not expected, or a leg took too long.
    """

    plan: Plan
    robot: Robot
    belief: Belief
    rng: np.random.Generator
    pace: Pace = field(default_factory=Pace)
    leg: int = 0
    history: list[tuple[float, str, int]] = field(default_factory=list)
    surprises: int = 0
    _surprised: float = 0.0
    _since: float = 0.0
    _unpressed: Vector | None = None

    def __post_init__(self) -> None:
        geometry = self.belief.states.geometry
        self._scale = np.array([1.0, 1.0, geometry.radius])
        robot = self.robot
        self._stiffness = np.array([robot.stiffness, robot.stiffness, robot.turning_stiffness]) / self._scale**2

    @property
    def start(self) -> Vector:
        """The first goal of the plan."""
        return self.plan.legs[0].goal

    def target(self, sample: Sample) -> Vector:
        """The next virtual target, in the robot's frame, shape (3,)."""
        expected = self.plan.legs[self.leg].allowed
        found = self.belief.after(sample.pose, sample.wrench, sample.possible, self.rng, expected)
        self.belief, state, shift = found.belief, found.state, found.shift
        q = relative(shift, sample.pose)
        self._choose_leg(sample.time, state, q)
        control, press = self._control(state, q)
        wish = self._scale * (self.plan.legs[self.leg].goal - q)
        share = self.pace.speed * self.pace.period / max(float(np.linalg.norm(wish)), np.finfo(float).tiny)
        moved, force = commanded_pair(control, wish * min(1.0, share), press)
        ahead = self._limited(_admissible(control, self._ahead(sample.pose, shift) + moved))
        self._unpressed = sample.pose + turned(ahead / self._scale, shift[2])
        return self._unpressed + turned(force / self._stiffness / self._scale, shift[2])

    def _ahead(self, pose: Vector, shift: Vector) -> np.ndarray:
        """How far the latest target, without its press, is ahead of the part now; scaled, as the fixed parts lie."""
        if self._unpressed is None:
            return np.zeros(3)
        return self._scale * turned(self._unpressed - pose, -shift[2])

    def _limited(self, offset: np.ndarray) -> np.ndarray:
        pull = float(np.abs(offset * self._stiffness).max())
        return offset if pull <= self.pace.most_force else offset * (self.pace.most_force / pull)

    def _control(self, state: str, q: Vector) -> tuple[HybridControl, np.ndarray]:
        """A and F of a state near a configuration, scaled, and the wished press on all its contacts."""
        states = self.belief.states
        touching = states.touching[states.ids.index(state)]
        found = states.geometry.equations(q[None], states.pairs[None]).face_vectors[0][touching]
        rows = found / self._scale
        control = hybrid_control(ConeUnion.of([PolyhedralConvexCone.from_faces(rows, dimension=3)]))
        return control, self.plan.legs[self.leg].press * rows.sum(axis=0)

    def _choose_leg(self, time: float, state: str, q: Vector) -> None:
        """The next leg where the goal is reached; another one after a surprise, or where patience ends."""
        leg, last = self.plan.legs[self.leg], self.leg + 1 == len(self.plan.legs)
        self._surprised = 0.0 if state in leg.allowed else self._surprised + self.pace.period
        chosen = self.leg
        if not last and float(np.linalg.norm(self._scale * (leg.goal - q))) <= self.pace.near:
            chosen = self.leg + 1
        elif self._surprised > self.pace.surprised:
            chosen = self.plan.joining(state, self.leg)
        elif time - self._since > self.pace.patience:
            chosen = 0
        self.surprises += chosen < self.leg
        if chosen != self.leg or chosen == 0 < self._surprised:
            self._surprised, self._since, self.leg = 0.0, time, chosen
        if not self.history or self.history[-1][1:] != (state, self.leg):
            self.history.append((time, state, self.leg))


def _admissible(control: HybridControl, offset: np.ndarray) -> np.ndarray:
    """The nearest displacement in A: contacts are pressed by the force alone, not by a target that ran into them."""
    nearest = [nearest_in(convert(cone), offset) for cone in control.displacements]
    return min(nearest, key=lambda found: float(np.linalg.norm(found - offset)))
