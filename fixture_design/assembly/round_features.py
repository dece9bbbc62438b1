"""The pairs that a turned body and drilled blocks form in a region, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fixture_design.assembly import circle_crossings, round_touch
from fixture_design.assembly.assembly import Region
from fixture_design.assembly.circles import Circles, Cones
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.placement import Placement
from fixture_design.assembly.round_planes import Flat, Plane
from fixture_design.assembly.round_reach import bounds_of, boxes_of, meeting, reaching, refuse_edges
from fixture_design.assembly.touch import Touch
from fixture_design.assembly.turned_body import TurnedBody
from fixture_design.errors import AssemblyError, UnsupportedError

#: How a pair that touches at two places at once is told from one that touches at one.
AGAIN = " again"


@dataclass(frozen=True, eq=False)
class RoundPair:
    """One pair, or with two names a pair that may touch at two places.

    Attributes:
        touch: the places, as many as names.
        lever: how far its points may be from the moving body's origin, beside the distance of ``fixed_point`` [m].
        fixed_point: of features of the fixed body whose points touch; None for features of the moving one.
        flat: of a disk on a plane.
        block: number of the fixed body.
        joins: of a circle across a rim the pairs that it continues: where these end on the rim, both touch.
        rim_axis: of a circle across a rim the rim's axis; None for others.
    """

    names: tuple[str, ...]
    touch: Callable[[Placement], tuple[Touch, ...]]
    lever: float
    block: int
    fixed_point: np.ndarray | None = None
    flat: Flat | None = None
    joins: tuple[str, ...] = ()
    rim_axis: np.ndarray | None = None


def pairs_of(moving: TurnedBody, fixed: tuple[DrilledBlock, ...], region: Region, reach: float) -> list[RoundPair]:
    """All pairs that can meet in a region.

    Raises:
        UnsupportedError: edges of blocks in reach; circles that are as large as a hole in reach.
        AssemblyError: no pairs.
    """
    boxes = boxes_of(moving, region)
    names = _Names(moving, fixed)
    pairs: list[RoundPair] = []
    for number, block in enumerate(fixed):
        refuse_edges(moving, block, region)
        pairs += _with_facets(moving, block, number, boxes, names)
        for h, hole in enumerate(block.holes):
            pairs += _with_hole(moving, hole, (number, h), boxes, names)
    if not pairs:
        raise AssemblyError("nothing of the fixed bodies is in reach of the moving one in this region")
    return pairs


class _Names:
    """Names of all features: numbers from 1 through the moving, then the fixed bodies, each kind on its own."""

    def __init__(self, moving: TurnedBody, fixed: tuple[DrilledBlock, ...]) -> None:
        self.circles = [f"circle {k + 1}" for k in range(len(moving.radii))]
        self.disks = ["disk 1", "disk 2"]
        self.surfaces: list[str] = []
        for word in moving.words():
            self.surfaces.append(f"{word} {sum(name.startswith(word) for name in self.surfaces) + 1}")
        circle, facet = len(self.circles), 0
        cylinder = sum(name.startswith("cylinder") for name in self.surfaces)
        self.facets: dict[tuple[int, int], str] = {}
        self.walls: dict[tuple[int, int], str] = {}
        self.floors: dict[tuple[int, int], str] = {}
        self.rims: dict[tuple[int, int, int], str] = {}
        for b, block in enumerate(fixed):
            for k in range(len(block.normals)):
                facet += 1
                self.facets[b, k] = f"facet {facet}"
            for h, hole in enumerate(block.holes):
                cylinder += 1
                self.walls[b, h] = f"cylinder {cylinder}"
                if hole.blind:
                    facet += 1
                    self.floors[b, h] = f"facet {facet}"
                for k in range(len(hole.openings)):
                    circle += 1
                    self.rims[b, h, k] = f"circle {circle}"


def _with_facets(
    moving: TurnedBody, block: DrilledBlock, number: int, boxes: np.ndarray, names: _Names
) -> list[RoundPair]:
    pairs = []
    for facet in range(len(block.normals)):
        ring = block.hull.vertices[block.hull.corners[facet]]
        normal, offset = block.normals[facet], float(block.offsets[facet])
        opening = next((hole for hole in block.holes if facet in hole.openings), None)
        plane = Plane(normal, offset, block, facet, opening)
        word = names.facets[number, facet]
        pairs += _on_plane(moving, plane, reaching(boxes, ring, normal, offset), word, number, names)
    return pairs


def _on_plane(
    moving: TurnedBody, plane: Plane, near: np.ndarray, word: str, number: int, names: _Names
) -> list[RoundPair]:
    pairs = []
    for k in np.flatnonzero(near).tolist():

        def touch(place: Placement, k: int = k) -> tuple[Touch, ...]:
            circle = place.circle(k)
            aside = plane.aside(circle.center)
            return (round_touch.on_plane(circle, plane.normal, plane.offset, aside, plane.border),)

        pairs.append(RoundPair((f"{names.circles[k]} - {word}",), touch, float(moving.reaches[k]), number))
        if k in (0, len(moving.radii) - 1):
            end = 0 if k == 0 else 1
            flat = Flat(plane, k, -1.0 if end == 0 else 1.0, f"{names.circles[k]} - {word}")

            def lying(place: Placement, flat: Flat = flat) -> tuple[Touch, ...]:
                circle = place.circle(flat.circle)
                height = circle.center @ plane.normal - plane.offset
                beyond, out = plane.disk_border(circle.center, circle.radius)
                facing = flat.sense * (circle.axis @ plane.normal) < 0
                normal = np.broadcast_to(plane.normal, circle.center.shape)
                return (Touch(height, normal, circle.center, beyond, facing, np.concatenate([out, 0 * out], axis=1)),)

            pairs.append(
                RoundPair((f"{names.disks[end]} - {word}",), lying, float(moving.reaches[k]), number, flat=flat)
            )
    return pairs


def _with_hole(
    moving: TurnedBody, hole: Hole, which: tuple[int, int], boxes: np.ndarray, names: _Names
) -> list[RoundPair]:
    number = which[0]
    wall = Cones(
        (hole.point + hole.low * hole.axis)[None], hole.axis[None], hole.radius, (0.0, 1.0), hole.high - hole.low
    )
    corners = bounds_of(hole.point + np.array([[hole.low], [hole.high]]) * hole.axis, hole)
    pairs = []
    near = meeting(boxes, corners)
    if (moving.radii[near] >= hole.radius).any():
        raise UnsupportedError(
            f"a circle of radius {moving.radii[near].max():g} m does not go into the hole of radius {hole.radius:g} m, "
            "and would seat on its rim all around",
            expected="turned bodies that are smaller than the holes in reach",
        )
    for k in np.flatnonzero(near).tolist():
        name = f"{names.circles[k]} - {names.walls[which]}"

        def touch(place: Placement, k: int = k) -> tuple[Touch, ...]:
            return round_touch.in_hole(place.circle(k), wall)

        pairs.append(RoundPair((name, name + AGAIN), touch, float(moving.reaches[k]), number))
    if hole.blind:
        floor = Plane(*hole.floor, None, -1, hole)
        at_floor = bounds_of((hole.point + hole.low * hole.axis)[None], hole)
        pairs += _on_plane(moving, floor, meeting(boxes, at_floor), names.floors[which], number, names)
    for k, (center, axis, _) in enumerate(hole.rims()):
        rim = Circles.around(center[None], axis[None], hole.radius)
        beside = names.walls[which], names.facets[number, hole.openings[k]]
        pairs += _with_rim(moving, rim, (*which, k), boxes, names, beside)
    return pairs


def _with_rim(
    moving: TurnedBody,
    rim: Circles,
    which: tuple[int, int, int],
    boxes: np.ndarray,
    names: _Names,
    beside: tuple[str, str],
) -> list[RoundPair]:
    pairs = []
    around = rim.radius * np.sqrt(np.maximum(1 - rim.axis[0] ** 2, 0.0))
    corners = np.array([rim.center[0] - around, rim.center[0] + around])
    for k in np.flatnonzero(meeting(boxes, corners)).tolist():
        name = f"{names.circles[k]} - {names.rims[which]}"
        wedge = _wedge(moving, k)

        def cross(place: Placement, k: int = k, wedge: tuple = wedge) -> tuple[Touch, ...]:
            return circle_crossings.crossing(place.circle(k), _repeated(rim, len(place.R)), wedge, place.slides)

        joins = [f"{names.circles[k]} - {other}" for other in beside]
        joins += [f"{surface} - {names.rims[which]}" for surface in names.surfaces[max(k - 1, 0) : k + 1]]
        reach = float(moving.reaches[k])
        pairs.append(RoundPair((name, name + AGAIN), cross, reach, which[0], joins=tuple(joins), rim_axis=rim.axis[0]))
    sides = np.stack([np.minimum(boxes[:-1, 0], boxes[1:, 0]), np.maximum(boxes[:-1, 1], boxes[1:, 1])], axis=1)
    for k in np.flatnonzero(meeting(sides, corners)).tolist():
        name = f"{names.surfaces[k]} - {names.rims[which]}"

        def touch(place: Placement, k: int = k) -> tuple[Touch, ...]:
            return round_touch.over_rim(place.surface(k), _repeated(rim, len(place.R)))

        pairs.append(RoundPair((name, name + AGAIN), touch, rim.radius, which[0], fixed_point=rim.center[0]))
    return pairs


def _repeated(rim: Circles, count: int) -> Circles:
    return Circles.around(np.repeat(rim.center, count, axis=0), np.repeat(rim.axis, count, axis=0), rim.radius)


def _wedge(moving: TurnedBody, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Normals [outward, along] of the surfaces below and above a circle."""
    normals = np.column_stack([moving.slopes[:, 1], -moving.slopes[:, 0]])
    below = np.array([0.0, -1.0]) if k == 0 else normals[k - 1]
    above = np.array([0.0, 1.0]) if k == len(moving.radii) - 1 else normals[k]
    return below, above
