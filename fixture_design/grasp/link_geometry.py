"""The solids of a hand's links, as triangles in each link's own frame: what may touch the part or run into it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Point, Points, Rows, Weights, read_only
from fixture_design.errors import GeometryError
from fixture_design.geometry import PartGeometry
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.primitives import Primitive, box, capsule, cylinder, sphere
from fixture_design.geometry.scene import RawMesh
from fixture_design.geometry.separation import Solid
from fixture_design.geometry.soundness import sound
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from pydrake.geometry import GeometryId, SceneGraphInspector


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball among a link's shapes: its centre in the link's frame and its radius [m]."""

    center: Point
    radius: float


@dataclass(frozen=True, eq=False)
class LinkGeometry:
    """What a link is made of.

    Attributes:
        name: of the link.  pieces: its shapes in the link's frame, each closed.
        balls: those of the shapes that are balls; a capsule, one piece, has two.
        only_balls: whether it is made of nothing else; balls are measured exactly.
        notes: what had to be replaced or left out, for people.
    """

    name: str
    pieces: tuple[Piece, ...]
    balls: tuple[Ball, ...] = ()
    only_balls: bool = False
    notes: tuple[str, ...] = ()

    @cached_property
    def geometry(self) -> PartGeometry:
        """All shapes as one; they may overlap."""
        return PartGeometry.of_pieces(self.name, self.pieces)

    @cached_property
    def solid(self) -> Solid:
        return Solid.of(self.geometry)

    @cached_property
    def around(self) -> Ball:
        """A ball that holds the link."""
        center = self.geometry.box_center
        return Ball(center, float(np.linalg.norm(self.geometry.vertices - center, axis=1).max()))

    def above_hull(self, points: Points) -> Weights:
        """How far points are in front of the foremost face of its convex hull, shape (n,) [m].

        Outside that is at most how far they are off.
        """
        return (points @ self._hull[:, :3].T + self._hull[:, 3]).max(axis=1)

    @cached_property
    def _hull(self) -> Rows:
        """Its faces [outward unit normal, offset]."""
        from scipy.spatial import ConvexHull

        return ConvexHull(self.geometry.vertices).equations


def link_geometry(
    name: str, shapes: list[GeometryId], inspector: SceneGraphInspector, meshes: Mapping[str, RawMesh], file: Path
) -> LinkGeometry | None:
    """The solids of a link; None where it has none."""
    from pydrake.geometry import Sphere

    pieces: list[Piece] = []
    balls: list[Ball] = []
    notes: list[str] = []
    for shape_id in shapes:
        X_LG = _pose(inspector.GetPoseInFrame(shape_id))
        shape = inspector.GetShape(shape_id)
        piece, note = _piece(shape, meshes, file, f"link {name!r}")
        notes += [note] if note else []
        if piece is not None:
            pieces.append(_moved(piece, X_LG))
            balls += _balls(shape, X_LG)
    balls_only = all(isinstance(inspector.GetShape(shape_id), Sphere) for shape_id in shapes)
    return LinkGeometry(name, tuple(pieces), tuple(balls), balls_only, tuple(notes)) if pieces else None


def _pose(X_LG: object) -> Pose:
    rotation, translation = X_LG.rotation().matrix(), X_LG.translation()  # type: ignore[attr-defined]
    return Pose(read_only(rotation), read_only(translation))


def _piece(shape: object, meshes: Mapping[str, RawMesh], file: Path, place: str) -> tuple[Piece | None, str | None]:
    """The triangles of a shape of Drake's in its own frame, and what there is to say about them."""
    from pydrake.geometry import Box, Capsule, Convex, Cylinder, Mesh, Sphere

    if isinstance(shape, Mesh | Convex):
        raw = meshes[Path(str(shape.source().path())).name]
        given = Piece(raw.vertices, raw.triangles, raw.rounding, file, place)
        try:
            return sound(given), None
        except GeometryError as error:
            return _hull(given), f"{place}: its mesh is no closed solid ({error.problem}); its convex hull is used"
    made: Primitive
    if isinstance(shape, Box):
        made = box(np.array(shape.size(), dtype=np.float64))
    elif isinstance(shape, Cylinder):
        made = cylinder(shape.radius(), shape.length())
    elif isinstance(shape, Capsule):
        made = capsule(shape.radius(), shape.length())
    elif isinstance(shape, Sphere):
        made = sphere(shape.radius())
    else:
        return None, f"{place}: a {type(shape).__name__.lower()} among its shapes is left out"
    return sound(Piece(made.vertices, made.triangles, made.rounding, file, place, smooth=made.smooth)), None


def _hull(piece: Piece) -> Piece:
    from trimesh import Trimesh
    from trimesh.convex import convex_hull

    hull = convex_hull(Trimesh(piece.vertices, piece.triangles, process=False))
    vertices = np.array(hull.vertices, dtype=np.float64)
    rounding = np.full(len(vertices), float(piece.rounding.max(initial=0.0)))
    return sound(Piece(vertices, np.array(hull.faces, dtype=np.int64), rounding, piece.source, piece.place))


def _moved(piece: Piece, X_LG: Pose) -> Piece:
    smooth = tuple(
        replace(patch, point=X_LG.points(patch.point[None])[0], axis=X_LG.rotation @ patch.axis)
        for patch in piece.smooth
    )
    return replace(piece, vertices=X_LG.points(piece.vertices), smooth=smooth)


def _balls(shape: object, X_LG: Pose) -> list[Ball]:
    from pydrake.geometry import Capsule, Sphere

    if isinstance(shape, Sphere):
        return [Ball(X_LG.translation, shape.radius())]
    if isinstance(shape, Capsule):
        ends = np.array([[0.0, 0.0, half] for half in (-shape.length() / 2, shape.length() / 2)])
        return [Ball(center, shape.radius()) for center in X_LG.points(ends)]
    return []
