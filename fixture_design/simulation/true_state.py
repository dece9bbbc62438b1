"""The contact state that a simulation is in, from Drake's contact results: the truth that recognition is judged by."""

from __future__ import annotations

from typing import Any

import numpy as np

from fixture_design.assembly.features import PlanarFeatures
from fixture_design.simulation.planar_world import PlanarWorld, SimulatedFeature

#: A normal belongs to a side whose own is within this cosine [-]; between two sides the apex is at both their ends.
_ALONG = 0.99

#: Contacts with less force than this are none [N]: the solver leaves some where bodies are near each other.
LEAST_FORCE = 1e-3


def true_contacts(world: PlanarWorld, results: Any, theta: float) -> tuple[str, ...]:
    """The contacting pairs as a graph names them, sorted; an apex at an apex has the pairs of all their sides.

    Args:
        results: Drake's contact results.  theta: the moving part's angle [rad].
    """
    found: set[str] = set()
    for k in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(k)
        if float(np.linalg.norm(info.contact_force())) < LEAST_FORCE:
            continue
        pair = info.point_pair()
        first, second = world.features[pair.id_A], world.features[pair.id_B]
        ball, body = (first, second) if first.apex else (second, first)
        # nhat_BA_W points from B into A; what is wanted is the outward normal of the body with the side
        outward = np.asarray(pair.nhat_BA_W).reshape(3)[:2] * (1.0 if body is second else -1.0)
        found.update(_pairs(world, ball, body, outward, theta))
    return tuple(sorted(found))


def _pairs(
    world: PlanarWorld, ball: SimulatedFeature, body: SimulatedFeature, outward: np.ndarray, theta: float
) -> list[str]:
    """Names of the pairs of an apex with the side that has the normal, or at a corner with both sides there."""
    angle = theta if body.moving else float(world.shift[2])
    c, s = np.cos(angle), np.sin(angle)
    side = world.sides[0 if body.moving else 1]
    seen = np.array([c * outward[0] + s * outward[1], -s * outward[0] + c * outward[1]])
    rows = np.array(body.rows)
    cosines = side.normals[rows] @ seen
    touched = rows[cosines >= _ALONG] if (cosines >= _ALONG).any() else rows[cosines > 1 - _ALONG]
    assert ball.apex is not None
    names = [_named(side, int(row)) for row in touched]
    return [f"{name} - {ball.apex}" if body.moving else f"{ball.apex} - {name}" for name in names if name is not None]


def _named(side: PlanarFeatures, row: int) -> str | None:
    return side.facet_names[row]
