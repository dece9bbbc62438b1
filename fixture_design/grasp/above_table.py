"""A hand whose pads slide over the part until it is above the table.

Pads may lie on the part in part only: of a flat part on a table they must, as they are higher than it is. Where all
faces that the fingers touch are upright or steep, the hand is moved in their planes, upwards as far as it is in the
table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fixture_design.arrays import read_only
from fixture_design.grasp.hand import Fingertip
from fixture_design.grasp.judging import Site, lowest
from fixture_design.grasp.posture import Posture
from fixture_design.layout import Pose
from fixture_design.tolerances import FLAT_ENOUGH

#: Least rise for each metre in the pads' planes [-]: less would slide them off sideways.
_STEEP = 0.3


def raised(posture: Posture, site: Site, tips: Sequence[Fingertip]) -> Posture | None:
    """The hand with its lowest point on the table; None where pads cannot slide there and still be on the part.

    Args:
        tips: those that are to touch; all must be pads.
    """
    sizes = [max(tip.pad) for tip in tips if tip.pad is not None]
    if site.table is None or len(sizes) < len(tips):
        return None
    poses = posture.links()
    normals = np.array([poses[tip.link].vectors(tip.facing[None])[0] for tip in tips])
    up = np.array([0.0, 0.0, 1.0])
    along = up - np.linalg.pinv(normals, rcond=FLAT_ENOUGH) @ (normals @ up)
    rise = along @ up
    depth = site.table - lowest(posture)
    if rise < _STEEP or depth > max(sizes):
        return None
    X_WH = posture.X_WH
    return replace(posture, X_WH=Pose(X_WH.rotation, read_only(X_WH.translation + depth / rise * along)))
