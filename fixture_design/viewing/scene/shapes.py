"""What a scene is made of: shapes in W, each with what an adapter needs to draw it. Nothing here knows a renderer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

#: A point or direction in space; planar layouts lie in z = 0.
Vector3 = Float[np.ndarray, "3"]
Points3 = Float[np.ndarray, "_ 3"]
Corners = Int[np.ndarray, "_ 3"]
Segments3 = Float[np.ndarray, "_ 2 3"]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: ``vertices`` in W, shape (v, 3) [m], ``triangles``, shape (t, 3), counter-clockwise from outside.

    ``smooth``: drawn as a round surface, with normals averaged at shared vertices; else facet by facet.
    """

    vertices: Points3
    triangles: Corners
    smooth: bool = False


@dataclass(frozen=True, eq=False)
class Sphere:
    """A ball: centre in W and radius [m]."""

    center: Vector3
    radius: float


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A rod from ``start`` to ``end`` in W, with ``radius`` at the start and ``end_radius`` at the end [m].

    ``end_radius`` None: the same; zero: a cone.
    """

    start: Vector3
    end: Vector3
    radius: float
    end_radius: float | None = None


@dataclass(frozen=True, eq=False)
class Box:
    """A block: ``sides`` [m] along the columns of ``axes``, an orthonormal matrix, about ``center`` in W."""

    center: Vector3
    axes: Points3
    sides: Vector3


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow from ``start`` to its tip ``end`` in W, its shaft of ``radius`` [m]."""

    start: Vector3
    end: Vector3
    radius: float

    @property
    def length(self) -> float:
        """[m]"""
        return float(np.linalg.norm(self.end - self.start))


@dataclass(frozen=True, eq=False)
class Lines:
    """Thin lines: the two ends of each in W, shape (n, 2, 3) [m]."""

    segments: Segments3


Shape = Mesh | Sphere | Cylinder | Box | Arrow | Lines
