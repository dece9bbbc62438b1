"""The pairs that a turned body and drilled blocks form in a region, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.arrays import Points
from fixture_design.assembly import round_touch
from fixture_design.assembly.assembly import Region
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.round_touch import ALONG, Circles, Cones, Touch, dots
from fixture_design.assembly.turned_body import TurnedBody
from fixture_design.errors import AssemblyError, UnsupportedError

#: Slices of the turned body by which it is told whether an edge is in reach.
_SLICES = 24

#: How a pair that touches at two places at once is told from one that touches at one.
AGAIN = " again"


@dataclass(frozen=True, eq=False)
class Placement:
    """The turned body at n configurations.

    Attributes:
        R, position: of its frame, shapes (n, 3, 3) and (n, 3).
        slides: whether `Touch.slide` is wanted, which takes time.
    """

    body: TurnedBody
    R: np.ndarray
    position: np.ndarray
    slides: bool = False

    @cached_property
    def axis(self) -> np.ndarray:
        return self.R @ self.body.axis

    def of(self, rows: np.ndarray) -> Placement:
        """Some of the placements."""
        return Placement(self.body, self.R[rows], self.position[rows], self.slides)

    @property
    def origin(self) -> np.ndarray:
        return self.R @ self.body.foot + self.position

    def circle(self, k: int) -> Circles:
        return self._circles[k]

    @cached_property
    def _circles(self) -> list[Circles]:
        """All of them, so that each has its basis once."""
        rows = zip(self.body.centers, self.body.radii.tolist(), strict=True)
        return [Circles.around(self.R @ center + self.position, self.axis, radius) for center, radius in rows]

    def surface(self, k: int) -> Cones:
        s, c = self.body.slopes[k].tolist()
        origin = self.R @ self.body.centers[k] + self.position
        return Cones(origin, self.axis, float(self.body.radii[k]), (s, c), float(self.body.lengths[k]))


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
    """

    names: tuple[str, ...]
    touch: Callable[[Placement], tuple[Touch, ...]]
    lever: float
    block: int
    fixed_point: np.ndarray | None = None
    flat: Flat | None = None
    joins: tuple[str, ...] = ()


def pairs_of(moving: TurnedBody, fixed: tuple[DrilledBlock, ...], region: Region, reach: float) -> list[RoundPair]:
    """All pairs that can meet in a region.

    Raises:
        UnsupportedError: edges of blocks in reach; circles that are as large as a hole in reach.
        AssemblyError: no pairs.
    """
    boxes = _boxes(moving, region)
    names = _Names(moving, fixed)
    pairs: list[RoundPair] = []
    for number, block in enumerate(fixed):
        _refuse_edges(moving, block, region)
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
        plane = _Plane(normal, offset, block, facet, opening)
        word = names.facets[number, facet]
        pairs += _on_plane(moving, plane, _reaching(boxes, ring, normal, offset), word, number, names)
    return pairs


@dataclass(frozen=True, eq=False)
class _Plane:
    """A plane facet: its border is that of a block's facet, or the wall of a blind hole around its floor."""

    normal: np.ndarray
    offset: float
    block: DrilledBlock | None
    facet: int
    hole: Hole | None

    def border(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far points in the plane are beyond the border, and which way is out of it."""
        if self.block is not None:
            return self.block.border(points, self.facet)
        assert self.hole is not None
        radial, rho = self.hole.seen(points)
        return rho - self.hole.radius, radial

    def disk_border(self, center: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """How far all of a disk is beyond the border, and which way is out of it."""
        if self.block is None or self.hole is None:
            beyond, out = self.border(center)
            return beyond - radius, out
        radial, rho = self.hole.seen(center)
        return self.hole.radius - rho - radius, -radial

    def aside(self, center: np.ndarray) -> np.ndarray:
        """Where a circle along the plane touches it for sure if it does: away from the hole."""
        if self.hole is None:
            return np.broadcast_to(np.linalg.svd(self.normal[None])[2][1], center.shape)
        away = center - self.hole.point
        away = away - dots(away, self.hole.axis)[:, None] * self.hole.axis
        away = away if self.block is not None else -away
        some = np.linalg.norm(away, axis=1, keepdims=True) > ALONG * self.hole.radius
        return np.where(some, away, np.linalg.svd(self.normal[None])[2][1])


@dataclass(frozen=True, eq=False)
class Flat:
    """A disk on a plane: the facet, the numbers of the disk's circle and of its pair with the facet, the disk's sense.

    Attributes:
        sense: 1 where the disk's outward normal is along the axis.  below: the name of the circle's pair.
    """

    plane: _Plane
    circle: int
    sense: float
    below: str

    def tilts(self, place: Placement) -> tuple[np.ndarray, np.ndarray]:
        """Components of the axis along the plane (n, 2), and their directions (2, 3)."""
        basis = np.linalg.svd(self.plane.normal[None])[2][1:]
        return place.axis @ basis.T, basis

    def rim_points(self, place: Placement, count: int) -> np.ndarray:
        """Of ``count`` points around the rim those that are on the facet, of the first placement, shape (m, 3)."""
        circle = place.circle(self.circle)
        first = circle.angles_of(circle.center + self.plane.aside(circle.center))
        points = circle.points(first[:, None] + np.arange(count) * 2 * np.pi / count)[0]
        return points[self.plane.border(points)[0] <= 0]


def _from_axis(points: np.ndarray, hole: Hole) -> np.ndarray:
    return np.linalg.norm(np.cross(points - hole.point, hole.axis), axis=-1)


def _on_plane(
    moving: TurnedBody, plane: _Plane, near: np.ndarray, word: str, number: int, names: _Names
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
    corners = _bounds(hole.point + np.array([[hole.low], [hole.high]]) * hole.axis, hole)
    pairs = []
    near = _meeting(boxes, corners)
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
        floor = _Plane(*hole.floor, None, -1, hole)
        at_floor = _bounds((hole.point + hole.low * hole.axis)[None], hole)
        pairs += _on_plane(moving, floor, _meeting(boxes, at_floor), names.floors[which], number, names)
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
    for k in np.flatnonzero(_meeting(boxes, corners)).tolist():
        name = f"{names.circles[k]} - {names.rims[which]}"
        wedge = _wedge(moving, k)

        def cross(place: Placement, k: int = k, wedge: tuple = wedge) -> tuple[Touch, ...]:
            return round_touch.crossing(place.circle(k), _repeated(rim, len(place.R)), wedge, place.slides)

        joins = [f"{names.circles[k]} - {other}" for other in beside]
        joins += [f"{surface} - {names.rims[which]}" for surface in names.surfaces[max(k - 1, 0) : k + 1]]
        pair = RoundPair((name, name + AGAIN), cross, float(moving.reaches[k]), which[0], joins=tuple(joins))
        pairs.append(pair)
    sides = np.stack([np.minimum(boxes[:-1, 0], boxes[1:, 0]), np.maximum(boxes[:-1, 1], boxes[1:, 1])], axis=1)
    for k in np.flatnonzero(_meeting(sides, corners)).tolist():
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


def _boxes(moving: TurnedBody, region: Region) -> np.ndarray:
    """Boxes in W that the points of each circle cannot leave, shape (k, 2, 3): low and high corners."""
    return np.array(
        [_box(center, radius, moving, region) for center, radius in zip(moving.centers, moving.radii, strict=True)]
    )


def _box(center: np.ndarray, radius: float, moving: TurnedBody, region: Region) -> np.ndarray:
    around = radius * np.sqrt(np.maximum(1 - moving.axis**2, 0.0))
    low, high = center - around, center + around
    farthest = float(np.linalg.norm(center)) + radius
    angle = np.pi if region.turns is None else min(region.turns[1], np.pi)
    turning = 2 * np.sin(angle / 2) * farthest
    return np.array([low - turning + region.low, high + turning + region.high])


def _meeting(boxes: np.ndarray, corners: np.ndarray) -> np.ndarray:
    low, high = corners.min(axis=0), corners.max(axis=0)
    return ((boxes[:, 0] <= high) & (boxes[:, 1] >= low)).all(axis=1)


def _reaching(boxes: np.ndarray, ring: Points, normal: np.ndarray, offset: float) -> np.ndarray:
    """Which boxes meet a facet's bounding box and have a corner on its plane or below."""
    lowest = np.where(normal > 0, boxes[:, 0], boxes[:, 1]) @ normal
    return _meeting(boxes, ring) & (lowest <= offset)


def _bounds(centers: Points, hole: Hole) -> np.ndarray:
    around = hole.radius * np.sqrt(np.maximum(1 - hole.axis**2, 0.0))
    return np.vstack([centers - around, centers + around])


def _refuse_edges(moving: TurnedBody, block: DrilledBlock, region: Region) -> None:
    shares = np.linspace(moving.heights[0], moving.heights[-1], _SLICES + 1)
    radii = np.interp(shares, moving.heights, moving.radii)
    ends = np.array(
        [_box(moving.foot + s * moving.axis, float(r), moving, region) for s, r in zip(shares, radii, strict=True)]
    )
    slices = np.stack([np.minimum(ends[:-1, 0], ends[1:, 0]), np.maximum(ends[:-1, 1], ends[1:, 1])], axis=1)
    for edge in block.edges:
        if _meeting(slices, edge).any():
            raise UnsupportedError(
                "in this region the turned body reaches the straight edge of a block from "
                f"{np.round(edge[0], 6).tolist()} to {np.round(edge[1], 6).tolist()}, and round surfaces form no "
                "contact pairs with straight edges",
                expected="a region with smaller positions or a smaller rotation",
            )
