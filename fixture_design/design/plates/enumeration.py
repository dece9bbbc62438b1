"""All fixtures of a plate: candidates, poses, clamps, and the tests that they must pass."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import ArrayLike
from fixture_design.design.plates.clamps import Clamps, clamp_candidates
from fixture_design.design.plates.clearance import plungers_clear, tips_clear, to_plungers
from fixture_design.design.plates.closure import closing, locating, margins, planar_rows
from fixture_design.design.plates.fixtures import Fixtures
from fixture_design.design.plates.grown_edges import GrownEdges, grown_edges
from fixture_design.design.plates.outline import Outline
from fixture_design.design.plates.placement import placed
from fixture_design.design.plates.plate import Plate
from fixture_design.design.plates.poses import Poses, in_part, solve_poses
from fixture_design.design.plates.triples import Triples, candidate_triples
from fixture_design.errors import InputError
from fixture_design.tolerances import HELD


def enumerate_fixtures(polygon: ArrayLike, plate: Plate, edge_margin: float = 0.0) -> Fixtures:
    """Every fixture of three locators and one clamp that holds a planar part in form closure, without friction.

    A fixture is: three locators in different holes, each touching an edge of the part strictly inside it; a clamp in a
    hole whose plunger, along a row or column of holes, pushes on an edge likewise; no tip, and no plunger, that touches
    or overlaps anything else; margin above `tolerances.HELD`. Two locators, or a locator and the clamp, may share an
    edge. The part may reach over the plate's border. Fixtures that differ by a translation or a turn of the grid are
    one. For one contact of the clamp the nearest hole is taken.

    Left out, since a hair decides about them: contacts at the very end of what the margin leaves of an edge, tips that
    just touch a second edge, and three contacts that do not locate the part (parallel normals, or normals that meet in
    a point). Vertices with an angle of 180 degrees end an edge like any other. A symmetric part has each fixture as
    often as its symmetries take it to other edges: edges have names.

    Args:
        polygon: simple, convex or not, counter-clockwise, shape (n, 2) [m].
        edge_margin: least distance of a contact from the ends of its edge [m].

    Returns:
        fixtures, in the same order each time; possibly none.

    Raises:
        GeometryError: no simple counter-clockwise polygon.  InputError: the margin is negative or not a number.

    Example:
        >>> found = enumerate_fixtures([[0, 0], [0.1, 0], [0, 0.08]], Plate(0.025, 5, 5, 0.005))
        >>> bool(len(found) and (found.margin > 0).all())
        True
    """
    if not (np.isfinite(edge_margin) and edge_margin >= 0):
        raise InputError("the edge margin must be a length >= 0", found=f"{edge_margin:g} m")
    outline = Outline.of(polygon)
    part = outline.centered()
    grown = grown_edges(part, plate.locator_radius, edge_margin)
    tips = grown_edges(part, plate.plunger.radius, edge_margin)
    parts = [_none(outline, plate, grown, tips)]
    for triples in candidate_triples(grown, plate, part.tie):
        poses = _located(part, plate, grown, triples)
        poses, clamps, margin = _clamped(part, plate, grown, tips, poses)
        parts.append(placed(outline, plate, poses, clamps, grown, tips, margin))
    return Fixtures.joined(parts)


def _located(part: Outline, plate: Plate, grown: GrownEdges, triples: Triples) -> Poses:
    """The poses of the candidates that locate the part without overlap."""
    poses = solve_poses(triples, grown, plate.pitch)
    poses = poses.kept(locating(_locator_rows(part, grown, poses)))
    for locator in range(3):
        own = grown.edges[poses.edges[:, locator]]
        poses = poses.kept(tips_clear(part, poses.centers[:, locator], own, plate.locator_radius))
    return poses


def _clamped(
    part: Outline, plate: Plate, grown: GrownEdges, tips: GrownEdges, poses: Poses
) -> tuple[Poses, Clamps, np.ndarray]:
    """Each pose with each of its clamps that holds the part and reaches it; and the margins."""
    clamps = clamp_candidates(poses, tips, plate, part.tie)
    locators = _locator_rows(part, grown, poses)
    rows = planar_rows(tips.touched(clamps.edges, clamps.along), tips.normals[clamps.edges], part.length)
    holding = np.flatnonzero(closing(locators[clamps.pose], rows))
    clamps, rows = clamps.kept(holding), rows[holding]
    margin = margins(np.concatenate([locators[clamps.pose], rows[:, None]], axis=1))
    held = np.flatnonzero(margin > HELD)
    clamps, margin = clamps.kept(held), margin[held]
    clear = np.flatnonzero(_reaching(part, plate, tips, poses, clamps))
    clamps = clamps.kept(clear)
    return poses.kept(clamps.pose), clamps, margin[clear]


def _reaching(part: Outline, plate: Plate, tips: GrownEdges, poses: Poses, clamps: Clamps) -> np.ndarray:
    """Whether the plunger is clear of the locators and of all of the part but the edge it pushes on."""
    radius = plate.plunger.radius
    centers = tips.centers(clamps.edges, clamps.along)
    bases = in_part(plate.pitch * clamps.holes, poses.turns[clamps.pose]) - poses.shifts[clamps.pose]
    apart = to_plungers(poses.centers[clamps.pose], centers, bases) > radius + plate.locator_radius + part.tie
    clear = np.flatnonzero(apart.all(axis=1))
    passed = np.zeros(len(apart), dtype=bool)
    passed[clear] = plungers_clear(part, centers[clear], bases[clear], tips.edges[clamps.edges[clear]], radius)
    return passed


def _locator_rows(part: Outline, grown: GrownEdges, poses: Poses) -> np.ndarray:
    return planar_rows(grown.touched(poses.edges, poses.along), grown.normals[poses.edges], part.length)


def _none(outline: Outline, plate: Plate, grown: GrownEdges, tips: GrownEdges) -> Fixtures:
    """No fixtures: what an empty plate gives."""
    none, pairs = np.zeros(0, dtype=np.int64), np.zeros((0, 2), dtype=np.int64)
    three = np.zeros((0, 3), dtype=np.int64)
    poses = solve_poses(Triples(three, np.zeros((0, 3, 2), dtype=np.int64)), grown, plate.pitch)
    return placed(outline, plate, poses, Clamps(none, none, pairs, pairs, np.zeros(0)), grown, tips, np.zeros(0))
