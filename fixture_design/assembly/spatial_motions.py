"""Configurations in space: the region's, and motions between them."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.assembly import rotations
from fixture_design.assembly.assembly import Region
from fixture_design.tolerances import TOUCHING


class SpatialMotions:
    """What any `ContactGeometry` in space has of configurations [x, y, z, qw, qx, qy, qz]."""

    region: Region
    size: float

    @property
    def turns(self) -> slice:
        return slice(3, 6)

    def rotations(self, q: np.ndarray) -> np.ndarray:
        return rotations.matrices(q[:, 3:])

    def moved(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        turned = rotations.product(rotations.from_vectors(displacement[:, 3:]), q[:, 3:])
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        return np.concatenate([q[:, :3] + displacement[:, :3], turned], axis=1)

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        turn = rotations.vectors(rotations.product(end[:, 3:], rotations.inverse(start[:, 3:])))
        return np.concatenate([end[:, :3] - start[:, :3], turn], axis=1)

    def aligned(self, q: np.ndarray) -> np.ndarray:
        """None: coincident apices in space are not tried with facets along each other."""
        return q[:0]

    def canonical(self, q: np.ndarray) -> np.ndarray:
        return np.concatenate([q[:, :3], np.where(q[:, 3:4] < 0, -q[:, 3:], q[:, 3:])], axis=1)

    def random(self, rng: np.random.Generator, count: int) -> np.ndarray:
        position = rng.uniform(self.region.low, self.region.high, (count, 3))
        turned = rng.normal(size=(count, 4))
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        if self.region.turns is not None:
            axes = turned[:, 1:] / np.linalg.norm(turned[:, 1:], axis=1, keepdims=True)
            turned = rotations.from_vectors(axes * rng.uniform(*self.region.turns, (count, 1)))
        return np.concatenate([position, turned], axis=1)

    def inside(self, q: np.ndarray) -> Mask:
        low, high = self.region.low - TOUCHING * self.size, self.region.high + TOUCHING * self.size
        found = np.logical_and(q[:, :3] >= low, q[:, :3] <= high).all(axis=1).reshape(len(q))
        if self.region.turns is None:
            return found
        return found & (np.linalg.norm(rotations.vectors(q[:, 3:]), axis=1) <= self.region.turns[1] + TOUCHING)
