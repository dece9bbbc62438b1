"""A camera as numbers: where points of the view land on a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.viewing.scene import Camera, Scene
from fixture_design.viewing.scene.shapes import Points3, Vector3

#: Width for height that the scene's camera has everything in view for; narrower pictures are taken from further off.
_ASPECT = 1.25


@dataclass(frozen=True, eq=False)
class Projection:
    """A pinhole camera in the coordinates of the view (`Scene.to_view`).

    Attributes:
        eye: its place.  axes: rows right, down and forward.  fov: its height [rad].
        width, height: of the picture, in pixels.
    """

    eye: Vector3
    axes: Points3
    fov: float
    width: int
    height: int

    @classmethod
    def of(cls, scene: Scene, camera: Camera, width: int, height: int) -> Projection:
        """A camera of the scene for a picture of this size."""
        eye, target = scene.to_view(np.array([camera.eye, camera.target]))
        eye = target + (eye - target) * max(1.0, _ASPECT * height / width)
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, camera.up)
        right /= np.linalg.norm(right)
        return cls(eye, np.array([right, np.cross(forward, right), forward]), camera.fov, width, height)

    @property
    def clipping(self) -> tuple[float, float]:
        """Depths between which things are drawn."""
        distance = float(np.linalg.norm(self.eye))
        return 0.02 * distance, 4 * distance + 10

    def pixels(self, points: Points3) -> tuple[np.ndarray, np.ndarray]:
        """Pixels, shape (n, 2), x to the right and y down, and depths, shape (n,), of points of the view."""
        seen = (points - self.eye) @ self.axes.T
        depth = np.maximum(seen[:, 2], self.clipping[0])
        focal = self.height / 2 / np.tan(self.fov / 2)
        return seen[:, :2] / depth[:, None] * focal + [self.width / 2, self.height / 2], seen[:, 2]
