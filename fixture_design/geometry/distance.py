"""Drake's signed distance to the surface of a part, guarded: it is never asked what it would refuse or abort on.

Drake measures from a point to the true, non-convex surface of a mesh to rounding accuracy. Its gradient is noise on the
surface itself and is not used. Assertions of Drake end the process (`SystemExit` in Python); here they are errors.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np

from fixture_design.arrays import Point
from fixture_design.errors import GeometryError
from fixture_design.geometry.shapes import Directions, PerPoint, Triangles, Vector3, Vertices

if TYPE_CHECKING:
    from pydrake.geometry import QueryObject, SceneGraph
    from pydrake.systems.framework import Context

_Result = TypeVar("_Result")


class DistanceField:
    """The signed distance of one part, in the part's frame P: one anchored mesh in a Drake scene."""

    def __init__(self, vertices: Vertices, triangles: Triangles, name: str) -> None:
        """Build the scene; 0.3 s for 15,000 triangles, most of it Drake's convex hull.

        Raises:
            GeometryError: Drake refuses the mesh.
        """
        self._made_of = (vertices, triangles, name)
        self._name = name
        self._scene, self._context, self._query = guarded(lambda: _scene(vertices, triangles), name)

    def __reduce__(self) -> tuple[type[DistanceField], tuple[Vertices, Triangles, str]]:
        """Pickled as what it was made of, so that parts travel to worker processes: Drake's scenes do not."""
        return DistanceField, self._made_of

    def at(self, p_PQ: Point) -> tuple[float, Vector3]:
        """Signed distance of a point, negative inside [m], and the nearest point of the surface, both in P.

        Raises:
            GeometryError: the point is not finite, or Drake has no finite answer.
        """
        if p_PQ.shape != (3,) or not np.isfinite(p_PQ).all():
            # Drake answers -inf to NaN, and nothing to infinity
            raise GeometryError(f"no distance from {self._name!r} to a point that is not finite: {p_PQ.tolist()}")
        query = self._query.ComputeSignedDistanceToPoint
        results = guarded(lambda: query(p_PQ), self._name)  # pyright: ignore[reportArgumentType]
        if len(results) != 1:
            raise GeometryError(f"Drake gave {len(results)} distances to {self._name!r}", expected="one")
        distance, nearest = float(results[0].distance), np.array(results[0].p_GN, dtype=np.float64).reshape(3)
        if not (np.isfinite(distance) and np.isfinite(nearest).all()):
            raise GeometryError(f"Drake's distance to {self._name!r} is not finite", found=f"{distance} at {p_PQ}")
        return distance, nearest

    def distances(self, p_PQ: Directions) -> PerPoint:
        """Signed distances of many points, shape (n, 3), negative inside; shape (n,) [m]. Checks are made once for all.

        Raises:
            GeometryError: as `at`.
        """
        if not np.isfinite(p_PQ).all():
            bad = p_PQ[~np.isfinite(p_PQ).all(axis=1)][0]
            raise GeometryError(f"no distance from {self._name!r} to a point that is not finite: {bad.tolist()}")
        query = self._query.ComputeSignedDistanceToPoint
        found = guarded(lambda: [result.distance for point in p_PQ for result in query(point)], self._name)
        if len(found) != len(p_PQ):
            raise GeometryError(f"Drake gave {len(found)} distances to {self._name!r}", expected=str(len(p_PQ)))
        result = np.array(found, dtype=np.float64)
        if not np.isfinite(result).all():
            bad = p_PQ[~np.isfinite(result)][0]
            raise GeometryError(f"Drake's distance to {self._name!r} is not finite", found=f"at {bad.tolist()}")
        return result


def guarded(call: Callable[[], _Result], name: str) -> _Result:
    """The result of a call to Drake, its refusals and assertions translated.

    Raises:
        GeometryError: with Drake's own exception as the cause. A SystemExit that is no assertion passes through.
    """
    try:
        return call()
    except SystemExit as cause:
        if "Failure at" not in str(cause):
            raise
        raise _refused(name, cause) from cause
    except (RuntimeError, ValueError) as cause:
        raise _refused(name, cause) from cause


def _refused(name: str, cause: BaseException) -> GeometryError:
    text = (str(cause).splitlines() or [""])[0]
    hint = "a mesh without folds and knife edges; repair it where it was made" if "sharp edge" in text else None
    return GeometryError(f"the geometry engine refuses {name!r}", found=text[:300], expected=hint)


def obj_text(vertices: Vertices, triangles: Triangles) -> str:
    """The mesh as Wavefront OBJ with 17 significant digits, enough for every float64."""
    points = ("v %.17g %.17g %.17g\n" * len(vertices)) % tuple(vertices.ravel().tolist())
    return points + ("f %d %d %d\n" * len(triangles)) % tuple((triangles + 1).ravel().tolist())


def _scene(vertices: Vertices, triangles: Triangles) -> tuple[SceneGraph, Context, QueryObject]:
    """A scene with the mesh as its only geometry; the context must outlive the query object."""
    from pydrake.common import MemoryFile
    from pydrake.geometry import GeometryInstance, InMemoryMesh, Mesh, ProximityProperties, SceneGraph
    from pydrake.math import RigidTransform

    contents = obj_text(vertices, triangles).encode()
    file = MemoryFile(contents, ".obj", "part")  # pyright: ignore[reportArgumentType]
    instance = GeometryInstance(RigidTransform(), Mesh(InMemoryMesh(mesh_file=file)), "part")
    instance.set_proximity_properties(ProximityProperties())
    scene = SceneGraph()
    scene.RegisterAnchoredGeometry(scene.RegisterSource("fixture_design"), instance)
    context = scene.CreateDefaultContext()
    return scene, context, cast("QueryObject", scene.get_query_output_port().Eval(context))
