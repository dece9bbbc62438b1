"""How a hand reaches points of a part: joint positions and a pose, by Drake's inverse kinematics.

The part's frame P is a free body beside the hand, whose root link rests. Of every fingertip the place is prescribed: of
a ball its centre, its radius above the surface; of a pad, which must lie flat, two more points in the surface's tangent
plane; and how far it may look past the normal. Joints that follow others do so. SNOPT starts from a seed of `library`.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.arrays import Weights, read_only
from fixture_design.geometry.distance import guarded
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.hand_loading import built_plant
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.library import Seed, Spots
from fixture_design.grasp.model_text import model_text
from fixture_design.layout import Pose
from fixture_design.tolerances import FLAT_ENOUGH

#: Name of the free body that is the part's frame.
_PART = "part of this grasp"

#: What positions may miss [m]; SNOPT's own tolerance is about that.
_NEAR = 2e-6

#: What part of a fingertip's spread is used: all of it would be a tie [-].
_INSIDE = 0.98

#: Constraints hold if they are missed by no more than this [m, rad].
_HOLDS = 1e-5

#: How far a pad may be beside its point where more than two must lie flat [m]: few hands reach three exactly.
_ASIDE = 5e-3

#: How far from a pad's middle its other two points are [m].
_BESIDE = 0.01


@dataclass(frozen=True, eq=False)
class Reach:
    """The inverse kinematics of a hand; made by `Reach.of`."""

    model: HandModel
    _plant: Any

    @classmethod
    def of(cls, model: HandModel) -> Reach:
        with tempfile.TemporaryDirectory() as folder:
            text = model_text(model.hand.model, Path(folder))
            plant, _, _ = guarded(lambda: built_plant(text, _PART), model.name)
        return cls(model, plant)

    def solve(self, spots: Spots, seed: Seed) -> tuple[Weights, Pose] | None:
        """Joint positions and X_PH with which the seed's fingertips touch at the spots, given in P.

        None if none is found.
        """
        from pydrake.multibody.inverse_kinematics import InverseKinematics
        from pydrake.solvers import SnoptSolver

        ik: Any = InverseKinematics(self._plant, with_joint_limits=False)
        program, q = ik.prog(), ik.q()
        start = self._plant.GetBodyByName(_PART).floating_positions_start()
        mine = [self._plant.GetJointByName(joint.name).position_start() for joint in self.model.joints]
        program.AddBoundingBoxConstraint(self.model.lower, self.model.upper, q[mine])
        for number, joint in enumerate(self.model.joints):
            if joint.follows is not None:
                other = [one.name for one in self.model.joints].index(joint.follows)
                row = np.array([[1.0, -joint.multiplier]])
                both = np.array([q[mine[number]], q[mine[other]]])
                program.AddLinearEqualityConstraint(row, np.array([joint.offset]), both)
        aside = _ASIDE if len(seed.tips) > 2 else _NEAR
        for tip, point, normal in zip(seed.tips, spots.points, spots.normals, strict=True):
            self._prescribe(ik, self.model.fingertips[tip], point, normal, aside)
        solver: Any = SnoptSolver()
        guess = np.zeros(len(q))
        guess[mine] = np.clip(seed.q, self.model.lower, self.model.upper)
        guess[start : start + 7] = _quaternion_pose(seed.X_PH.inverse())
        program.AddQuadraticErrorCost(np.eye(len(mine)), guess[mine], q[mine])
        result = guarded(lambda: solver.Solve(program, guess), self.model.name)
        # SNOPT may stop for other reasons where it is; what counts is whether the constraints hold
        if not result.is_success() and result.GetInfeasibleConstraintNames(program, _HOLDS):
            return None
        values = result.GetSolution(q)
        X_HP = _pose_of(values[start : start + 7])
        return self.model.completed(values[mine][self.model.free]), X_HP.inverse()

    def _prescribe(self, ik: Any, tip: Fingertip, point: np.ndarray, normal: np.ndarray, aside: float) -> None:
        """Where a tip is; of a pad up to ``aside`` [m] beside the point."""
        link, part = self._plant.GetFrameByName(tip.link), self._plant.GetFrameByName(_PART)
        if tip.pad is None:
            wanted = point + tip.radius * normal
            ik.AddPositionConstraint(link, tip.at, part, wanted - _NEAR, wanted + _NEAR)
            ik.AddAngleBetweenVectorsConstraint(link, tip.facing, part, -normal, 0.0, tip.spread * _INSIDE)
            return
        X_PN = _tangent_frame(point + tip.radius * normal, normal)
        middle = np.array([aside, aside, _NEAR])
        ik.AddPositionConstraint(link, tip.at, part, X_PN, -middle, middle)
        everywhere = np.full(2, np.inf)
        for beside in (tip.sideways, tip.across):
            p_LQ = tip.at + _BESIDE * beside
            low, high = np.append(-everywhere, -_NEAR), np.append(everywhere, _NEAR)
            ik.AddPositionConstraint(link, p_LQ, part, X_PN, low, high)
        ik.AddAngleBetweenVectorsConstraint(link, tip.facing, part, -normal, 0.0, 10 * FLAT_ENOUGH)


def _tangent_frame(point: np.ndarray, normal: np.ndarray) -> Any:
    """X_PN with N's z along the normal."""
    from pydrake.math import RigidTransform, RotationMatrix

    rotation: Any = RotationMatrix
    made: Any = RigidTransform
    return made(rotation.MakeFromOneVector(normal, 2), point)


def _quaternion_pose(X_HP: Pose) -> np.ndarray:
    from pydrake.math import RotationMatrix

    quaternion = RotationMatrix(X_HP.rotation).ToQuaternion()
    return np.concatenate([quaternion.wxyz(), X_HP.translation])


def _pose_of(values: np.ndarray) -> Pose:
    from pydrake.common.eigen_geometry import Quaternion
    from pydrake.math import RotationMatrix

    quaternion: Any = Quaternion
    turned = RotationMatrix(quaternion(values[:4] / np.linalg.norm(values[:4])))
    return Pose(read_only(np.array(turned.matrix())), read_only(values[4:]))
