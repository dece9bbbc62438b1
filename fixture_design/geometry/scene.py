"""What trimesh makes of a file, as one list of triangles: every instance of every mesh, where the file puts it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.geometry.piece import rounding_of
from fixture_design.geometry.shapes import PerVertex, Triangles, Vertices
from fixture_design.tolerances import ROUND_OFF

if TYPE_CHECKING:
    from trimesh import Scene


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Triangles as a file has them, nothing merged, nothing repaired.

    Attributes:
        vertices: shape (v, 3), in the file's own unit.  triangles: shape (t, 3); both may be empty.
        rounding: shape (v,), how far each vertex may be from what was meant, in the same unit.
    """

    vertices: Vertices
    triangles: Triangles
    rounding: PerVertex


def flattened(scene: Scene) -> RawMesh:
    """All meshes of a scene in the scene's frame; points and lines are no surface and are left out.

    Rounding is judged by the coordinates that the file has, before they are moved. A mirror image turns the winding.
    """
    meshes = []
    for node in scene.graph.nodes_geometry:
        X_SM, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not hasattr(mesh, "faces"):
            continue
        vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        triangles = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
        meshes.append(_moved(RawMesh(vertices, triangles, rounding_of(vertices)), np.array(X_SM, dtype=np.float64)))
    if not meshes:
        return RawMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64), np.empty(0))
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return RawMesh(
        np.vstack([mesh.vertices for mesh in meshes]),
        np.vstack([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]),
        np.concatenate([mesh.rounding for mesh in meshes]),
    )


def _moved(mesh: RawMesh, X_SM: np.ndarray) -> RawMesh:
    if np.array_equal(X_SM, np.eye(4)):
        return mesh
    linear = X_SM[:3, :3]
    vertices = mesh.vertices @ linear.T + X_SM[:3, 3]
    triangles = mesh.triangles[:, ::-1] if np.linalg.det(linear) < 0 else mesh.triangles
    rounding = mesh.rounding * float(np.linalg.norm(linear, 2)) + ROUND_OFF * np.abs(vertices).max(axis=1, initial=0.0)
    return RawMesh(vertices, triangles, rounding)
