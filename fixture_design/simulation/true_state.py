"""The contact state that a simulation is in, from Drake's contact results: the truth that recognition is judged by."""

from __future__ import annotations

from typing import Any

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.assembly.features import PlanarFeatures
from fixture_design.simulation.belief import relative
from fixture_design.simulation.planar_world import PlanarWorld, SimulatedFeature

#: The point of a rectangle nearest to a ball that is beyond a corner is the corner: this near, relative to the ball's
#: radius [-]. The force is then between those of the sides.
_AT_CORNER = 1e-2

#: Contacts with less force than this are none [N]: the solver leaves some where bodies are near each other.
LEAST_FORCE = 1e-3


def true_contacts(world: PlanarWorld, results: Any, pose: Vector) -> tuple[str, ...]:
    """The contacting pairs as a graph names them, sorted; where two apices meet, the pairs of all their sides.

    Args:
        results: Drake's contact results.  pose: the moving part's, shape (3,).
    """
    found: set[str] = set()
    for k in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(k)
        if float(np.linalg.norm(info.contact_force())) < LEAST_FORCE:
            continue
        pair = info.point_pair()
        first, second = world.features[pair.id_A], world.features[pair.id_B]
        # witnesses are on the surfaces: that of the body with the sides is at one of them
        ball, body, p_W = (first, second, pair.p_WCb) if first.apex else (second, first, pair.p_WCa)
        frame = pose if body.moving else world.shift
        witness = np.array([*np.asarray(p_W).reshape(3)[:2], 0.0])
        found.update(_pairs(world, ball, body, relative(frame, witness)[:2]))
    return tuple(sorted(found))


def _pairs(world: PlanarWorld, ball: SimulatedFeature, body: SimulatedFeature, p: np.ndarray) -> set[str]:
    """Names of the pairs of an apex with the side at a point, in the body's frame, or with those at a corner."""
    side, other = world.sides if body.moving else world.sides[::-1]
    rows = np.array(body.rows)
    corner = int(np.linalg.norm(side.starts[rows] - p, axis=1).argmin())
    if np.linalg.norm(side.starts[rows[corner]] - p) > _AT_CORNER * world.radius:
        heights = np.einsum("ij,ij->i", side.normals[rows], side.starts[rows] - p)
        touched = [int(rows[np.abs(heights).argmin()])]
        return _named(ball.apex, [side.facet_names[row] for row in touched], body.moving)
    there = int(rows[corner])
    found = _named(ball.apex, [side.facet_names[row] for row in (there, _before(rows, corner))], body.moving)
    meeting = ball.rows[0]
    of_ball = next(rows for rows in _bodies(other) if meeting in rows)
    own = (meeting, _before(np.array(of_ball), of_ball.index(meeting)))
    return found | _named(side.apex_names[there], [other.facet_names[row] for row in own], ball.moving)


def _bodies(side: PlanarFeatures) -> list[list[int]]:
    """The rows of each body of a side."""
    ends = np.cumsum([len(polygon) for polygon in side.polygons])
    return [list(range(int(end) - len(polygon), int(end))) for end, polygon in zip(ends, side.polygons, strict=True)]


def _before(rows: np.ndarray, place: int) -> int:
    """The row of the facet that ends at an apex."""
    return int(rows[place - 1])


def _named(apex: str | None, facets: list[str | None], facets_move: bool) -> set[str]:
    """Pairs of an apex with facets that take part, the moving feature first."""
    if apex is None:
        return set()
    return {f"{name} - {apex}" if facets_move else f"{apex} - {name}" for name in facets if name is not None}
