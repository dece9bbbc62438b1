"""Parts for design's tests without any geometry: points on the faces of convex solids and polygons."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fixture_design.analysis.acting import load_wrench
from fixture_design.arrays import Mask, Point, Points
from fixture_design.contacts import Contact, Provenance, Scale
from fixture_design.design import CandidateRules, Task
from fixture_design.design.candidates import Candidates
from fixture_design.design.ways import Hole
from fixture_design.layout import Element, Layout, Part, Pose, Stem, Verdict
from fixture_design.verification import verify


@dataclass(frozen=True, eq=False)
class Spots:
    points: Points
    normals: Points
    features: tuple[str, ...]

    @property
    def provenance(self) -> tuple[Provenance, ...]:
        return (Provenance(),) * len(self.points)


@dataclass(frozen=True, eq=False)
class Fake:
    """A part that is nothing but its spots; elements touch it at the nearest one."""

    given: Spots
    answers: frozenset[str] = field(default=frozenset({"deterministic", "strongly_accessible", "form_closure"}))

    def scale(self) -> Scale:
        low, high = self.given.points.min(axis=0), self.given.points.max(axis=0)
        return Scale((low + high) / 2, float(np.linalg.norm(high - low)) / 2)

    def spots(self, rules: CandidateRules, seed: int) -> Spots:
        return self.given

    def touching(self, elements: Sequence[Element]) -> list[tuple[Contact, ...]]:
        layout = Layout("alone")
        return [self.contacts(replace(layout, elements=(element,))) for element in elements]

    def holes(self) -> tuple[Hole, ...]:
        return ()

    def fits(self, points: Points, normals: Points, stem: Stem, out: Point | None = None) -> Mask:
        return np.ones(len(points), dtype=bool)

    def wrenches(self, layout: Layout) -> tuple[np.ndarray, list[np.ndarray]]:
        p = self.given.points.shape[1]
        wrenches = [load_wrench(load, p) for load in layout.loads]
        return np.zeros(3 * (p - 1)), wrenches or [np.zeros(3 * (p - 1))]

    def contacts(self, layout: Layout) -> tuple[Contact, ...]:
        found = []
        for element in layout.elements:
            index = int(np.argmin(np.linalg.norm(self.given.points - element.at, axis=1)))
            friction = layout.friction if element.friction is None else element.friction
            normal, feature = self.given.normals[index], self.given.features[index]
            found.append(
                Contact(element.name, element.role, element.at, ((normal,),), friction, distance=0.0, feature=feature)
            )
        return (*found, *layout.contacts)

    def verify(self, layout: Layout) -> Verdict:
        alone = replace(layout, part=None, elements=(), contacts=self.contacts(layout))
        return verify(alone)


def solid(normals: Points, offsets: Points, size: float, count: int, seed: int) -> Spots:
    """Points on the faces of {x : n . x <= h}, as many on each as ``count``; unit normals."""
    rng = np.random.default_rng(seed)
    points, outward, features = [], [], []
    for face, (normal, offset) in enumerate(zip(normals, offsets, strict=True)):
        across = np.linalg.svd(normal[None])[2][1:]
        taken = 0
        for _ in range(2000):
            x = offset * normal + rng.uniform(-size, size, len(across)) @ across
            others = np.delete(np.arange(len(normals)), face)
            if taken < count and (normals[others] @ x < offsets[others] - 0.05 * size).all():
                points.append(x)
                outward.append(normal)
                features.append(f"facet {face + 1}")
                taken += 1
    return Spots(np.array(points), np.array(outward), tuple(features))


def box(count: int = 8, seed: int = 0, sides: tuple[float, ...] = (0.05, 0.03, 0.02)) -> Spots:
    """A box, or in the plane a rectangle."""
    p = len(sides)
    return solid(np.vstack([np.eye(p), -np.eye(p)]), np.array([*sides, *sides]), max(sides), count, seed)


def chamfered(count: int = 8, seed: int = 0) -> Spots:
    """A cube with its corner (1, 1, 1) cut off: one clamp there holds it in the opposite corner."""
    corner = np.ones(3) / np.sqrt(3)
    return solid(np.vstack([np.eye(3), -np.eye(3), corner]), np.array([1.0] * 6 + [1.1]), 1.2, count, seed)


def polygon(corners: Points, count: int = 8) -> Spots:
    """Points spread along the edges of a counter-clockwise polygon."""
    points, normals, features = [], [], []
    for edge, (start, end) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
        along = end - start
        for part in (np.arange(count) + 1) / (count + 1):
            points.append(start + part * along)
            normals.append(np.array([along[1], -along[0]]) / np.linalg.norm(along))
            features.append(f"facet {edge + 1}")
    return Spots(np.array(points), np.array(normals), tuple(features))


def ball(count: int, seed: int = 0) -> Spots:
    """Points on a sphere."""
    directions = np.random.default_rng(seed).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Spots(directions, directions.copy(), ("sphere 1",) * count)


def shaft(count: int, seed: int = 0) -> Spots:
    """Points on a cylinder along z and on its two ends."""
    rng = np.random.default_rng(seed)
    angle, height = rng.uniform(0, 2 * np.pi, count), rng.uniform(-1, 1, count)
    round_ones = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    points = round_ones * 0.3 + np.column_stack([np.zeros((count, 2)), height])
    ends = np.column_stack([rng.uniform(-0.2, 0.2, (count, 2)), np.where(np.arange(count) % 2, 1.0, -1.0)])
    normals = np.where([[False, False, True]], np.sign(ends), 0.0)
    features = ("cylinder 1",) * count + ("end",) * count
    return Spots(np.vstack([points, ends]), np.vstack([round_ones, normals]), features)


def task(spots: Spots, **keys: object) -> Task:
    space = "planar" if spots.points.shape[1] == 2 else "spatial"
    part = Part("fake", "polygon", None, None, 1.0, Pose.identity(spots.points.shape[1]))
    return Task("fake", part, space, **keys)  # type: ignore[arg-type]


def candidates(spots: Spots, friction: float = 0.0) -> Candidates:
    return Candidates.of(spots, Fake(spots).scale(), friction)
