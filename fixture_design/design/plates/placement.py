"""Placement: fixtures that were found from their first locator's hole, put on the plate."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Points, Weights
from fixture_design.design.plates.clamps import Clamps
from fixture_design.design.plates.fixtures import Fixtures
from fixture_design.design.plates.grown_edges import GrownEdges
from fixture_design.design.plates.outline import Outline
from fixture_design.design.plates.plate import Plate
from fixture_design.design.plates.poses import Poses, in_world


def placed(
    outline: Outline,
    plate: Plate,
    poses: Poses,
    clamps: Clamps,
    grown: GrownEdges,
    tips: GrownEdges,
    margin: Weights,
) -> Fixtures:
    """Fixtures of one pose and clamp a row, turned by 90 degrees where they only fit so, and moved to the lower left.

    Args:
        outline: as it was given; poses and clamps are those of the centred one.  grown, tips: of locators and clamp.
    """
    holes = np.concatenate([poses.holes, clamps.holes[:, None]], axis=1)
    extents = holes.max(axis=1) - holes.min(axis=1)
    turned = (extents[:, 0] >= plate.columns) | (extents[:, 1] >= plate.rows)
    holes, ways = _quarter_turn(holes, turned), _quarter_turn(clamps.directions, turned)
    shifts = poses.shifts - outline.center
    turns = _quarter_turn(poses.turns, turned)
    corner = holes.min(axis=1)
    holes = holes - corner[:, None]
    # without the negative zeros that turning leaves
    move = in_world(shifts, turns) - plate.pitch * corner + 0.0
    touched = np.concatenate(
        [grown.touched(poses.edges, poses.along), tips.touched(clamps.edges, clamps.along)[:, None]], axis=1
    )
    normals = np.concatenate([grown.normals[poses.edges], tips.normals[clamps.edges][:, None]], axis=1)
    return Fixtures(
        polygon=outline.vertices,
        plate=plate,
        theta=np.arctan2(turns[:, 1], turns[:, 0]),
        translation=move,
        edges=grown.edges[poses.edges],
        holes=holes[:, :3],
        clamp_edges=tips.edges[clamps.edges],
        clamp_holes=holes[:, 3],
        clamp_directions=ways,
        points=in_world(touched + outline.center, turns[:, None]) + move[:, None],
        normals=in_world(normals, turns[:, None]),
        margin=margin,
    )


def _quarter_turn(vectors: Points | np.ndarray, turned: np.ndarray) -> np.ndarray:
    """[x, y] to [-y, x] where ``turned``: of holes, directions, or [cos, sin]."""
    quarter = np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)
    return np.where(turned.reshape(-1, *[1] * (vectors.ndim - 1)), quarter, vectors)
