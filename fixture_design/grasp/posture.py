"""A hand in a place: its joint positions and the pose of its root link."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Weights
from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.hand_model import HandModel
from fixture_design.layout import Pose


@dataclass(frozen=True, eq=False)
class Posture:
    """A hand in a place.

    Attributes:
        q: positions of all joints of the model, shape (j,) [rad or m].
        X_WH: pose of the hand's root link.
    """

    model: HandModel
    q: Weights
    X_WH: Pose

    def links(self) -> dict[str, Pose]:
        """X_WL of the links."""
        return {name: composed(self.X_WH, X_HL) for name, X_HL in self.model.poses(self.q).items()}

    def tips(self) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
        """Where the fingertips are and which way they look, in W."""
        at, facing = self.model.tips(self.q)
        return self.X_WH.points(at), self.X_WH.vectors(facing)

    def positions(self) -> dict[str, float]:
        """Joint positions by name."""
        return {joint.name: float(value) for joint, value in zip(self.model.joints, self.q, strict=True)}
