"""The collision geometry of a URDF file: meshes and boxes of links joined by fixed joints, in the root link's frame."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fixture_design.errors import UnsupportedError
from fixture_design.geometry.mesh_file import read_mesh
from fixture_design.geometry.package import resolve
from fixture_design.geometry.piece import Piece, rounding_of
from fixture_design.geometry.scaling import check_scale
from fixture_design.geometry.urdf_tree import UrdfFile, composed, links_in_root, robot_of
from fixture_design.layout import Pose
from fixture_design.tolerances import ROUND_OFF

#: Corners of the unit box, and its triangles, wound outward.
_BOX_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_BOX_TRIANGLES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)


def read_urdf(file: Path) -> tuple[list[Piece], tuple[str, ...]]:
    """All pieces of a rigid URDF model, in the frame of its root link, and notes.

    Collision geometry counts; links that have none give their visual geometry, with a note.

    Raises:
        FileFormatError: no file, not XML, not URDF, links that do not form one tree, a mesh that is missing.
        UnsupportedError: movable joints; geometry other than meshes and boxes; xacro.
    """
    urdf = UrdfFile(file, robot_of(file))
    pieces, notes = [], []
    for link, X_RL in links_in_root(urdf).items():
        element = next(e for e in urdf.robot.findall("link") if e.get("name") == link)
        kind = "collision" if element.find("collision") is not None else "visual"
        if kind == "visual" and element.find("visual") is not None:
            notes.append(f"{file.name}, link {link!r}: no collision geometry; its visual geometry is used")
        shapes = element.findall(kind)
        for number, shape in enumerate(shapes, start=1):
            place = f"link {link!r}, {kind}" + (f" {number}" if len(shapes) > 1 else "")
            pieces.append(_posed(_shape(urdf, shape, place), X_RL, urdf.origin(shape, place)))
    if not pieces:
        raise urdf.error("the model has no geometry", None, expected="a link with a <collision> element")
    return pieces, tuple(notes)


def _shape(urdf: UrdfFile, shape: ElementTree.Element, place: str) -> Piece:
    """One collision or visual element, in its own frame."""
    found = shape.find("geometry")
    geometry = None if found is None else next(iter(found), None)
    if geometry is None:
        raise urdf.error("there is no geometry", place, expected="<geometry><mesh filename=.../></geometry>")
    if geometry.tag == "box":
        return _box(urdf, geometry, place)
    if geometry.tag == "mesh":
        return _mesh(urdf, geometry, place)
    raise UnsupportedError(
        f"this version takes meshes and boxes, not <{geometry.tag}>",
        source=urdf.file,
        place=place,
        expected="the shape as a mesh file",
    )


def _box(urdf: UrdfFile, geometry: ElementTree.Element, place: str) -> Piece:
    size = urdf.numbers(geometry, "size", "", place)
    if (size <= 0).any():
        raise urdf.error("a box needs positive sides", place, found=geometry.get("size"))
    corners = _BOX_CORNERS * size
    return Piece(corners, _BOX_TRIANGLES.copy(), np.abs(corners).max(axis=1) * ROUND_OFF, urdf.file, place)


def _mesh(urdf: UrdfFile, geometry: ElementTree.Element, place: str) -> Piece:
    name = geometry.get("filename", "")
    place = f"{place}, mesh {name!r}"
    scale = urdf.numbers(geometry, "scale", "1 1 1", place, counts=(1, 3)) * np.ones(3)
    if (scale == 0).any():
        raise urdf.error("a scale of 0", place, found=geometry.get("scale"), expected="factors to metres")
    vertices, triangles = read_mesh(resolve(name, urdf.file, place), place, urdf.file)
    check_scale(vertices, float(np.abs(scale).max()), urdf.file, place)
    rounding = rounding_of(vertices) * np.abs(scale).max()
    # a mirror image turns the winding inside out
    triangles = triangles[:, ::-1] if np.prod(scale) < 0 else triangles
    return Piece(vertices * scale, triangles, rounding, urdf.file, place)


def _posed(piece: Piece, X_RL: Pose, X_LS: Pose) -> Piece:
    X_RS = composed(X_RL, X_LS)
    if np.array_equal(X_RS.rotation, np.eye(3)) and not X_RS.translation.any():
        return piece
    vertices = X_RS.points(piece.vertices)
    rounding = piece.rounding + ROUND_OFF * np.abs(vertices).max(axis=1, initial=0.0)
    return Piece(vertices, piece.triangles, rounding, piece.source, piece.place)
