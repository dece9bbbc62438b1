"""A hand that can be moved: where its links are for given joint positions, what they are made of, how they move.

H is the frame of the hand's root link. Joint positions are arrays in the order of `HandModel.joints`; joints that
follow others are among them, and `HandModel.completed` gives them theirs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Point, Weights, read_only
from fixture_design.errors import UnknownNameError
from fixture_design.geometry.distance import guarded
from fixture_design.grasp.hand import Fingertip, Hand, HandError, Joint
from fixture_design.grasp.link_geometry import LinkGeometry
from fixture_design.layout import Pose
from fixture_design.tolerances import JOINT_SLACK

#: Links that overlap in this part of random configurations do so by construction [-], and by how much they may [m].
_ALWAYS, _GRAZE = 0.9, 1e-3

#: Random configurations looked at for that.
_LOOKED_AT = 40


@dataclass(frozen=True, eq=False)
class HandModel:
    """A hand loaded into Drake; made by `hand_loading`.

    Attributes:
        hand: what it was made of.
        joints: all movable ones, in Drake's order.
        fingertips: the hand's, or those that were guessed.
        links: those that are made of something, by name.
        notes: for people.
    """

    hand: Hand
    joints: tuple[Joint, ...]
    fingertips: tuple[Fingertip, ...]
    links: Mapping[str, LinkGeometry]
    notes: tuple[str, ...]
    _plant: Any
    _diagram: Any
    _context: Any

    @property
    def name(self) -> str:
        return self.hand.name

    @cached_property
    def lower(self) -> Weights:
        return read_only([joint.lower for joint in self.joints])

    @cached_property
    def upper(self) -> Weights:
        return read_only([joint.upper for joint in self.joints])

    @cached_property
    def free(self) -> Indices:
        """Numbers of the joints that move on their own."""
        return np.array([number for number, joint in enumerate(self.joints) if joint.follows is None], dtype=np.int64)

    @cached_property
    def following(self) -> tuple[Float[np.ndarray, "j f"], Weights]:
        """M and o of  q = M q_free + o: joints that follow others, in chains if need be."""
        numbers = {joint.name: number for number, joint in enumerate(self.joints)}
        columns = {int(number): column for column, number in enumerate(self.free)}
        matrix, offset = np.zeros((len(self.joints), len(self.free))), np.zeros(len(self.joints))
        for number in range(len(self.joints)):
            at, factor, shift = number, 1.0, 0.0
            for _ in self.joints:
                joint = self.joints[at]
                if joint.follows is None:
                    break
                factor, shift, at = factor * joint.multiplier, shift + factor * joint.offset, numbers[joint.follows]
            matrix[number, columns[at]], offset[number] = factor, shift
        return read_only(matrix), read_only(offset)

    def completed(self, free: Weights) -> Weights:
        """All positions, from those of the joints that move on their own."""
        matrix, offset = self.following
        return matrix @ free + offset

    def positions(self, given: Mapping[str, float]) -> Weights:
        """Positions by joint name as an array; joints that are not given are in the middle, or follow.

        Raises:
            UnknownNameError: there is no such joint.
            HandError: a position outside of its range, or of a joint that follows another.
        """
        numbers = {joint.name: number for number, joint in enumerate(self.joints)}
        q, file = self.middle.copy(), self.hand.source or self.hand.model
        for name, value in given.items():
            if name not in numbers:
                raise UnknownNameError("joint", name, numbers, source=file)
            joint = self.joints[numbers[name]]
            if joint.follows is not None:
                problem = f"joint {name!r} follows {joint.follows!r}, and cannot be set"
                expected = "positions of joints that move on their own"
                raise HandError(problem, source=file, found=f"{value:g}", expected=expected)
            if not joint.lower - JOINT_SLACK <= value <= joint.upper + JOINT_SLACK:
                found, expected = f"{value:g}", f"from {joint.lower:g} to {joint.upper:g}"
                raise HandError(f"joint {name!r} does not go there", source=file, found=found, expected=expected)
            q[numbers[name]] = value
        return self.completed(q[self.free])

    @cached_property
    def middle(self) -> Weights:
        """All joints in the middle of their ranges, as far as they move on their own."""
        return self.completed(((self.lower + self.upper) / 2)[self.free])

    def random(self, count: int, rng: np.random.Generator) -> Float[np.ndarray, "n j"]:
        """Random positions; joints that follow may be out of their own range and are then not given."""
        low, high = self.lower[self.free], self.upper[self.free]
        drawn = low + (high - low) * rng.random((count, len(self.free)))
        q = drawn @ self.following[0].T + self.following[1]
        return q[self.within(q)]

    def within(self, q: Float[np.ndarray, "n j"]) -> Mask:
        """Which positions are within all ranges, but for rounding."""
        return np.all((q >= self.lower - JOINT_SLACK) & (q <= self.upper + JOINT_SLACK), axis=1)

    def poses(self, q: Weights) -> dict[str, Pose]:
        """X_HL of every link that is made of something or has a fingertip."""
        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        names = {*self.links, *(tip.link for tip in self.fingertips)}
        return {name: self._pose(name) for name in names}

    def tips(self, q: Weights) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
        """Where the fingertips are and which way they look, in H."""
        poses = self.poses(q)
        at = [poses[tip.link].points(tip.at[None])[0] for tip in self.fingertips]
        facing = [poses[tip.link].vectors(tip.facing[None])[0] for tip in self.fingertips]
        return np.array(at).reshape(-1, 3), np.array(facing).reshape(-1, 3)

    def jacobian(self, q: Weights, link: str, p_LC: Point) -> Float[np.ndarray, "3 f"]:
        """dp_HC / dq of a point C that is fixed to a link, for the joints that move on their own [m/rad or 1]."""
        from pydrake.multibody.tree import JacobianWrtVariable

        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        frame, world = self._plant.GetBodyByName(link).body_frame(), self._plant.world_frame()
        by = JacobianWrtVariable.kQDot
        full = self._plant.CalcJacobianTranslationalVelocity(self._context, by, frame, p_LC, world, world)
        return full @ self.following[0]

    def spin_jacobian(self, q: Weights, link: str) -> Float[np.ndarray, "3 f"]:
        """The angular velocity of a link in H for each joint that moves on its own [1 or rad/m]."""
        from pydrake.multibody.tree import JacobianWrtVariable

        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        frame, world = self._plant.GetBodyByName(link).body_frame(), self._plant.world_frame()
        full = self._plant.CalcJacobianAngularVelocity(self._context, JacobianWrtVariable.kQDot, frame, world, world)
        return full @ self.following[0]

    @cached_property
    def efforts(self) -> Weights:
        """Largest torque or force of each joint that moves on its own; inf where nobody gives one."""
        return read_only([self.joints[number].effort for number in self.free.tolist()])

    def collides_with_itself(self, q: Weights) -> tuple[str, str] | None:
        """Two links of which one is in the other; None if there are none. Meshes count as their hulls here."""
        for pair in self._overlaps(q):
            if pair not in self._by_construction:
                return pair
        return None

    @cached_property
    def _by_construction(self) -> frozenset[tuple[str, str]]:
        """Pairs of links that overlap nearly always: hulls are fatter than links."""
        drawn = self.random(4 * _LOOKED_AT, np.random.default_rng(0))[:_LOOKED_AT]
        counts: dict[tuple[str, str], int] = {}
        for q in drawn:
            for pair in self._overlaps(q):
                counts[pair] = counts.get(pair, 0) + 1
        return frozenset(pair for pair, count in counts.items() if count >= _ALWAYS * max(len(drawn), 1))

    def _overlaps(self, q: Weights) -> set[tuple[str, str]]:
        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        query = self._plant.get_geometry_query_input_port().Eval(self._context)
        inspector, found = query.inspector(), set()
        for hit in guarded(query.ComputePointPairPenetration, self.name):
            if hit.depth > _GRAZE:
                frames = (inspector.GetFrameId(hit.id_A), inspector.GetFrameId(hit.id_B))
                names = sorted(self._plant.GetBodyFromFrameId(frame).name() for frame in frames)
                found.add((names[0], names[1]))
        return found

    def _pose(self, link: str) -> Pose:
        X_HL = self._plant.EvalBodyPoseInWorld(self._context, self._plant.GetBodyByName(link))
        return Pose(read_only(X_HL.rotation().matrix()), read_only(X_HL.translation()))
