"""Points on a hand's links, to tell roughly and soon how far a hand would be in the part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.geometry import PartGeometry
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.library import Seed

#: Points on each link.
_POINTS = 16


@dataclass(frozen=True, eq=False)
class Skin:
    """A hand with some points on each of its links, in the links' frames, shape (n, 3)."""

    model: HandModel
    points: Mapping[str, Float[np.ndarray, "n 3"]]

    @classmethod
    def of(cls, model: HandModel) -> Skin:
        """The points are spread over the links' surfaces as far apart as their vertices and facets let them."""
        return cls(model, {name: _spread(link.geometry) for name, link in model.links.items()})

    def depth(self, seed: Seed, geometry: PartGeometry) -> float:
        """How deep the deepest of the points is in the part, without the links of the seed's fingertips [m]."""
        touching = {self.model.fingertips[tip].link for tip in seed.tips}
        poses = self.model.poses(seed.q)
        points = [poses[name].points(own) for name, own in self.points.items() if name not in touching]
        if not points:
            return 0.0
        p_PQ = seed.X_PH.points(np.vstack(points))
        inside = ((p_PQ > geometry.low) & (p_PQ < geometry.high)).all(axis=1)
        if not inside.any():
            return 0.0
        return float(max(0.0, -geometry.surface.distances(p_PQ[inside]).min()))


def _spread(geometry: PartGeometry) -> Float[np.ndarray, "n 3"]:
    """Vertices and middles of triangles, each next one the farthest from those before it."""
    corners = geometry.vertices[geometry.triangles]
    candidates = np.vstack([corners.mean(axis=1), geometry.vertices])
    chosen = [0]
    away = np.linalg.norm(candidates - candidates[0], axis=1)
    while len(chosen) < min(_POINTS, len(candidates)):
        chosen.append(int(np.argmax(away)))
        away = np.minimum(away, np.linalg.norm(candidates - candidates[chosen[-1]], axis=1))
    return candidates[chosen]
