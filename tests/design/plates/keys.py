"""The key of `brute_force`, of fixtures that `enumerate_fixtures` found: from poses, holes and contact points."""

from __future__ import annotations

import numpy as np

from fixture_design.design.plates import Fixtures


def keys_of(fixtures: Fixtures) -> np.ndarray:
    """Shape (k, 12): edges, clamp's edge, places along them, plunger's direction in P, its length, margin."""
    vertices = np.asarray(fixtures.polygon)
    edges = np.column_stack([fixtures.edges, fixtures.clamp_edges])
    ahead = np.roll(vertices, -1, axis=0) - vertices
    tangents = ahead / np.linalg.norm(ahead, axis=1, keepdims=True)
    cos, sin = np.cos(fixtures.theta)[:, None], np.sin(fixtures.theta)[:, None]

    def in_part(v: np.ndarray) -> np.ndarray:
        return np.stack([cos * v[..., 0] + sin * v[..., 1], cos * v[..., 1] - sin * v[..., 0]], axis=-1)

    p_P = in_part(fixtures.points - fixtures.translation[:, None])
    along = ((p_P - vertices[edges]) * tangents[edges]).sum(axis=-1)
    ways = in_part(fixtures.clamp_directions[:, None].astype(float))[:, 0]
    plate = fixtures.plate
    tips = fixtures.points[:, 3] + plate.plunger.radius * fixtures.normals[:, 3]
    reach = np.linalg.norm(plate.pitch * fixtures.clamp_holes - tips, axis=1)
    return np.column_stack([edges, along, ways, reach, fixtures.margin])
