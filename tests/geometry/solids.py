"""Solids as unions of convex pieces, and whether two overlap after a motion: by separating axes, not by cones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.geometry import PartGeometry
from tests.geometry.parts import voxels


@dataclass(frozen=True, eq=False)
class Convex:
    """A convex polyhedron: vertices (n, 3), unit normals of its faces (f, 3), unit directions of its edges (e, 3)."""

    vertices: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray
    edges: np.ndarray

    @classmethod
    def hull(cls, points: object) -> Convex:
        from scipy.spatial import ConvexHull

        hull = ConvexHull(np.asarray(points, dtype=float))
        used, triangles = np.unique(hull.simplices, return_inverse=True)
        vertices, triangles = hull.points[used], triangles.reshape(-1, 3)
        areas = np.cross(*(vertices[triangles[:, k]] - vertices[triangles[:, 0]] for k in (1, 2)))
        inward = np.einsum("ij,ij->i", areas, hull.equations[:, :3]) < 0
        triangles[inward] = triangles[inward][:, ::-1]
        sides = np.vstack([vertices[triangles[:, k]] - vertices[triangles[:, k - 1]] for k in range(3)])
        return cls(vertices, triangles, _directions(hull.equations[:, :3]), _directions(sides))

    def placed(self, rotation: np.ndarray, translation: np.ndarray) -> Convex:
        return Convex(
            self.vertices @ rotation.T + translation, self.triangles, self.normals @ rotation.T, self.edges @ rotation.T
        )


def _directions(vectors: np.ndarray) -> np.ndarray:
    """Distinct directions, both signs as one."""
    units = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    kept: list[np.ndarray] = []
    for unit in units:
        if all(np.linalg.norm(np.cross(unit, other)) > 1e-9 for other in kept):
            kept.append(unit)
    return np.array(kept)


@dataclass(frozen=True, eq=False)
class Solid:
    """A union of convex pieces; ``mesh`` for one shell around them, else each piece is a shell of its own."""

    pieces: tuple[Convex, ...]
    mesh: tuple[np.ndarray, np.ndarray] | None = None

    def placed(self, rotation: np.ndarray, translation: object = (0, 0, 0)) -> Solid:
        shift = np.asarray(translation, dtype=float)
        mesh = None if self.mesh is None else (self.mesh[0] @ rotation.T + shift, self.mesh[1])
        return Solid(tuple(piece.placed(rotation, shift) for piece in self.pieces), mesh)

    def geometry(self, name: str) -> PartGeometry:
        if self.mesh is not None:
            vertices, triangles = self.mesh
        else:
            starts = np.cumsum([0, *(len(piece.vertices) for piece in self.pieces)])
            vertices = np.vstack([piece.vertices for piece in self.pieces])
            triangles = np.vstack([p.triangles + start for p, start in zip(self.pieces, starts, strict=False)])
        return PartGeometry(name, vertices, triangles, np.full(len(vertices), 1e-16))


def cuboid(low: object, high: object) -> Convex:
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return Convex.hull(low + corners * (high - low))


def heap(cells: set[tuple[int, int, int]], size: float, shift: object = (0, 0, 0)) -> Solid:
    """Unit cells as one shell, moved by ``shift`` cells."""
    offset = np.asarray(shift, dtype=float)
    vertices, triangles = voxels(cells, size)
    pieces = tuple(cuboid((np.array(cell) + offset) * size, (np.array(cell) + offset + 1) * size) for cell in cells)
    return Solid(pieces, (vertices + offset * size, triangles))


def bar(outline: list[list[float]], half: float) -> Convex:
    """A prism along y over an outline (x, z)."""
    return Convex.hull([[x, y, z] for x, z in outline for y in (-half, half)])


def turn(axis: object, angle: float) -> np.ndarray:
    """The rotation matrix about an axis (Rodrigues)."""
    unit = np.asarray(axis, dtype=float)
    unit = unit / np.linalg.norm(unit)
    across = np.array([[0, -unit[2], unit[1]], [unit[2], 0, -unit[0]], [-unit[1], unit[0], 0]])
    return np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across


def overlap(part: Solid, body: Solid, motion: np.ndarray) -> float:
    """How deep the part is in the body after a motion [dx; dtheta]: the least shift along any axis that parts a pair of
    pieces, the largest over the pairs; negative if they are apart."""
    angle = float(np.linalg.norm(motion[3:]))
    moved = part.placed(turn(motion[3:], angle) if angle else np.eye(3), motion[:3])
    return max(_depth(mine, theirs) for mine in moved.pieces for theirs in body.pieces)


def _depth(first: Convex, second: Convex) -> float:
    across = np.cross(first.edges[:, None], second.edges[None]).reshape(-1, 3)
    lengths = np.linalg.norm(across, axis=1)
    across = across[lengths > 1e-5] / lengths[lengths > 1e-5, None]
    axes = np.vstack([first.normals, second.normals, across])
    ours, theirs = first.vertices @ axes.T, second.vertices @ axes.T
    return float(min((ours.max(axis=0) - theirs.min(axis=0)).min(), (theirs.max(axis=0) - ours.min(axis=0)).min()))
