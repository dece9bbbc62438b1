"""All fixtures of a plate by trying everything: plain numbers, plain loops, nothing from `fixture_design.design`.

A fixture's key has no grid in it: where the locators and the clamp touch the part, from which side the plunger comes
as the part sees it, and how far out it is. Fixtures that the grid's translations and turns take to each other, and only
those, have one key.
"""

from __future__ import annotations

from itertools import combinations_with_replacement, product
from math import atan2, cos, hypot, sin, sqrt

import numpy as np
import shapely

from fixture_design.design.plates import Plate
from fixture_design.tolerances import HELD, PARALLEL_EDGES, PLATE_TIE

Vec = tuple[float, float]
Key = tuple[float, ...]


class Edge:
    def __init__(self, start: Vec, end: Vec) -> None:
        self.start, self.end = start, end
        self.length = hypot(end[0] - start[0], end[1] - start[1])
        self.tangent = ((end[0] - start[0]) / self.length, (end[1] - start[1]) / self.length)
        self.normal = (self.tangent[1], -self.tangent[0])
        self.line = shapely.LineString([start, end])

    def along(self, p: Vec) -> float:
        return (p[0] - self.start[0]) * self.tangent[0] + (p[1] - self.start[1]) * self.tangent[1]

    def point(self, along: float, out: float) -> Vec:
        (x, y), (tx, ty), (nx, ny) = self.start, self.tangent, self.normal
        return (x + along * tx + out * nx, y + along * ty + out * ny)


def brute_force(polygon: np.ndarray, plate: Plate, edge_margin: float) -> list[Key]:
    corners = [(float(x), float(y)) for x, y in polygon]
    edges = [Edge(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    size = float(np.linalg.norm(np.ptp(polygon, axis=0)))
    tie = PLATE_TIE * size
    steps = list(product(range(1 - plate.columns, plate.columns), range(1 - plate.rows, plate.rows)))
    # half a turn of any plate takes second to -second
    patterns = [[(0, 0), second, third] for second in steps for third in steps if second > (0, 0)]
    patterns = [holes for holes in patterns if len(set(holes)) == 3 and fits(holes, plate)]
    # centres of tips that touch the part are no further apart than its corners and two radii
    widest = max(hypot(a[0] - b[0], a[1] - b[1]) for a in corners for b in corners) + 2 * plate.locator_radius + tie
    patterns = [holes for holes in patterns if widest >= spread(holes) * plate.pitch]
    keys: list[Key] = []
    for triple in combinations_with_replacement(range(len(edges)), 3):
        contacts = Contacts([edges[k] for k in triple], plate.locator_radius)
        for holes in patterns:
            for pose in contacts.poses([(plate.pitch * i, plate.pitch * j) for i, j in holes]):
                touches = locator_touches(edges, triple, holes, pose, plate, edge_margin, tie)
                if touches is not None:
                    keys += clamped(edges, triple, touches, holes, pose, plate, edge_margin, tie, polygon)
    return distinct(keys)


def fits(holes: list[tuple[int, int]], plate: Plate) -> bool:
    columns, rows = [h[0] for h in holes], [h[1] for h in holes]
    return max(columns) - min(columns) < plate.columns and max(rows) - min(rows) < plate.rows


def spread(holes: list[tuple[int, int]]) -> float:
    return max(hypot(a[0] - b[0], a[1] - b[1]) for a in holes for b in holes)


class Contacts:
    """Three locators on three edges: where R^T h - u is on each grown edge, for the holes h and the pose (R, R u)."""

    def __init__(self, edges: list[Edge], radius: float) -> None:
        pairs = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
        sines = [(abs(cross(edges[i].normal, edges[j].normal)), i, j, k) for i, j, k in pairs]
        sine, *self.order = max(sines)
        self.parallel = sine < PARALLEL_EDGES
        self.normals = [edges[q].normal for q in self.order]
        starts = [edges[q].start for q in self.order]
        self.levels = [n[0] * p[0] + n[1] * p[1] + radius for n, p in zip(self.normals, starts, strict=True)]

    def shift(self, q: list[Vec]) -> Vec:
        """u from the two edges that are furthest from parallel, with the holes at q as the part sees them."""
        (ax, ay), (bx, by), _ = self.normals
        first = ax * q[0][0] + ay * q[0][1] - self.levels[0]
        second = bx * q[1][0] + by * q[1][1] - self.levels[1]
        sine = ax * by - ay * bx
        return ((first * by - second * ay) / sine, (ax * second - bx * first) / sine)

    def miss(self, q: list[Vec]) -> float:
        """How far the third locator is off its edge."""
        (x, y), (nx, ny) = self.shift(q), self.normals[2]
        return nx * (q[2][0] - x) + ny * (q[2][1] - y) - self.levels[2]

    def poses(self, holes: list[Vec]) -> list[tuple[float, float, float]]:
        """All (theta, x, y): what the third locator misses by is a constant and one harmonic of theta."""
        if self.parallel:
            return []
        h = [holes[q] for q in self.order]
        at_0, at_90 = self.miss(h), self.miss([(y, -x) for x, y in h])
        constant = (at_0 + self.miss([(-x, -y) for x, y in h])) / 2
        harmonic = (at_0 - constant, at_90 - constant)
        size = hypot(*harmonic)
        if size <= abs(constant):
            return []
        middle = atan2(harmonic[1], harmonic[0])
        half = atan2(sqrt((size - constant) * (size + constant)), -constant)
        thetas = (middle + half, middle - half)
        return [(t, *turned(self.shift([turned(p, -t) for p in h]), t)) for t in thetas]


def locator_touches(edges, triple, holes, pose, plate, edge_margin, tie) -> list[float] | None:
    """How far along their edges the locators touch; None if one does not, or touches anything else."""
    touches = []
    for hole, k in zip(holes, triple, strict=True):
        center = to_part((hole[0] * plate.pitch, hole[1] * plate.pitch), pose)
        along = edges[k].along(center)
        if not inside(along, edges[k], edge_margin, tie):
            return None
        touches.append(along)
    for first, second in ((0, 1), (1, 2)):
        if triple[first] == triple[second] and touches[first] > touches[second]:
            return None
    for along, k in zip(touches, triple, strict=True):
        tip = shapely.Point(edges[k].point(along, plate.locator_radius))
        for other, edge in enumerate(edges):
            if other != k and tip.distance(edge.line) <= plate.locator_radius + tie:
                return None
    return touches


def clamped(edges, triple, touches, holes, pose, plate, edge_margin, tie, polygon) -> list[Key]:
    """The keys of a pose with all its clamps."""
    clamp, theta = plate.plunger, pose[0]
    centers = [edges[k].point(s, plate.locator_radius) for k, s in zip(triple, touches, strict=True)]
    rows = [row(edges[k], s, polygon) for k, s in zip(triple, touches, strict=True)]
    reach = max(plate.columns, plate.rows)
    keys = []
    for k, edge in enumerate(edges):
        normal = turned(edge.normal, theta)
        for way in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if -(way[0] * normal[0] + way[1] * normal[1]) < cos(clamp.slant) - 1e-9:
                continue
            for number in range(-reach, reach + 1):
                along = along_on_line(edge, clamp.radius, pose, abs(way[0]), number * plate.pitch)
                if not inside(along, edge, edge_margin, tie):
                    continue
                tip = edge.point(along, clamp.radius)
                base = clamp_hole(to_world(tip, pose), way, number, holes, plate, tie)
                if base is None or not fits([*holes, base], plate):
                    continue
                margin = closure([*rows, row(edge, along, polygon)])
                if margin <= HELD:
                    continue
                end = to_part((base[0] * plate.pitch, base[1] * plate.pitch), pose)
                plunger = shapely.LineString([tip, end])
                if any(plunger.distance(other.line) <= clamp.radius + tie for o, other in enumerate(edges) if o != k):
                    continue
                if any(
                    plunger.distance(shapely.Point(c)) <= clamp.radius + plate.locator_radius + tie for c in centers
                ):
                    continue
                seen = turned(way, -theta)
                keys.append((*triple, k, *touches, along, *seen, hypot(end[0] - tip[0], end[1] - tip[1]), margin))
    return keys


def along_on_line(edge: Edge, radius: float, pose, axis: int, level: float) -> float:
    """How far along the edge a tip has the coordinate ``level`` on an axis of the grid."""
    start, end = (to_world(edge.point(s, radius), pose)[axis] for s in (0.0, edge.length))
    return edge.length * (level - start) / (end - start)


def clamp_hole(tip: Vec, way, number: int, holes, plate: Plate, tie: float) -> tuple[int, int] | None:
    """The nearest hole behind the tip that the plunger reaches from; those further than the plate are of no use."""
    axis = 0 if way[0] else 1
    far = 3 * max(plate.columns, plate.rows)
    fitting = []
    for place in range(-far, far + 1):
        distance = -way[axis] * (place * plate.pitch - tip[axis])
        if plate.plunger.shortest - tie <= distance <= plate.plunger.longest + tie:
            fitting.append((distance, (place, number) if axis == 0 else (number, place)))
    return min(fitting)[1] if fitting else None


def closure(rows: list[np.ndarray]) -> float:
    """The distance from the origin to the tetrahedron's nearest face; 0 unless it is inside."""
    signs, nearest = [], float("inf")
    for out in range(4):
        a, b, c = (rows[q] for q in range(4) if q != out)
        volume = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        volume += a[2] * (b[0] * c[1] - b[1] * c[0])
        signs.append(volume * (-1) ** out)
        u, v = [b[q] - a[q] for q in range(3)], [c[q] - a[q] for q in range(3)]
        area = hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        nearest = min(nearest, abs(volume) / area if area else 0.0)
    return nearest if min(signs) > 0 or max(signs) < 0 else 0.0


def row(edge: Edge, along: float, polygon: np.ndarray) -> list[float]:
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    x, y = edge.point(along, 0.0)
    x, y = x - (low[0] + high[0]) / 2, y - (low[1] + high[1]) / 2
    nx, ny = edge.normal
    return [nx, ny, (x * ny - y * nx) / (hypot(*(high - low)) / 2)]


def distinct(keys: list[Key]) -> list[Key]:
    """Each once, sorted; keys within 1e-7 are one."""
    kept: list[Key] = []
    buckets: dict[tuple[float, ...], list[Key]] = {}
    for key in sorted(keys):
        bucket = buckets.setdefault(key[:4], [])
        if not any(max(abs(a - b) for a, b in zip(key, other, strict=True)) < 1e-7 for other in bucket):
            bucket.append(key)
            kept.append(key)
    return kept


def inside(along: float, edge: Edge, edge_margin: float, tie: float) -> bool:
    return edge_margin + tie < along < edge.length - edge_margin - tie


def to_world(p: Vec, pose: tuple[float, float, float]) -> Vec:
    x, y = turned(p, pose[0])
    return (x + pose[1], y + pose[2])


def to_part(p: Vec, pose: tuple[float, float, float]) -> Vec:
    return turned((p[0] - pose[1], p[1] - pose[2]), -pose[0])


def turned(v, theta: float) -> Vec:
    c, s = cos(theta), sin(theta)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1])


def cross(a: Vec, b: Vec) -> float:
    return a[0] * b[1] - a[1] * b[0]
