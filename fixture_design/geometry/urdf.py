"""The collision geometry of a URDF file: meshes and simple shapes of fixed links, in the root link's frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fixture_design.errors import UnsupportedError
from fixture_design.geometry.mesh_file import read_mesh
from fixture_design.geometry.package import resolve
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.primitives import Primitive, box, capsule, cylinder, sphere
from fixture_design.geometry.scaling import check_scale
from fixture_design.geometry.urdf_tree import UrdfFile, composed, links_in_root, robot_of
from fixture_design.layout import Pose
from fixture_design.tolerances import ROUND_OFF

#: Shapes that are no meshes: the attributes that measure them, and what makes a mesh of those.
_SHAPES: dict[str, tuple[tuple[str, ...], Callable[..., Primitive]]] = {
    "box": (("size",), box),
    "cylinder": (("radius", "length"), cylinder),
    "sphere": (("radius",), sphere),
    "capsule": (("radius", "length"), capsule),
}


def read_urdf(file: Path) -> tuple[list[Piece], tuple[str, ...]]:
    """All pieces of a rigid URDF model, in the frame of its root link, and notes.

    Collision geometry counts; links that have none give their visual geometry, with a note.

    Raises:
        FileFormatError: no file, not XML, not URDF, links that do not form one tree, a mesh that is missing.
        UnsupportedError: movable joints; geometry other than meshes, boxes, cylinders, spheres and capsules; xacro.
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
    # Drake's own shapes have its prefix in front
    tag = str(geometry.tag).rpartition("}")[2]
    if tag == "mesh":
        return _mesh(urdf, geometry, place)
    if tag not in _SHAPES:
        raise UnsupportedError(
            f"this version takes meshes, boxes, cylinders, spheres and capsules, not <{tag}>",
            source=urdf.file,
            place=place,
            expected="the shape as a mesh file",
        )
    return _primitive(urdf, geometry, tag, place)


def _primitive(urdf: UrdfFile, geometry: ElementTree.Element, tag: str, place: str) -> Piece:
    keys, make = _SHAPES[tag]
    measures = [urdf.numbers(geometry, key, "", place, counts=(3,) if key == "size" else (1,)) for key in keys]
    if any((measure <= 0).any() for measure in measures):
        found = ", ".join(f"{key} {geometry.get(key)!r}" for key in keys)
        raise urdf.error(f"a {tag} needs positive {' and '.join(keys)}", place, found=found)
    shape = make(*(measure if len(measure) > 1 else float(measure[0]) for measure in measures))
    return Piece(shape.vertices, shape.triangles, shape.rounding, urdf.file, place, smooth=shape.smooth)


def _mesh(urdf: UrdfFile, geometry: ElementTree.Element, place: str) -> Piece:
    name = geometry.get("filename", "")
    place = f"{place}, mesh {name!r}"
    scale = urdf.numbers(geometry, "scale", "1 1 1", place, counts=(1, 3)) * np.ones(3)
    if (scale == 0).any():
        raise urdf.error("a scale of 0", place, found=geometry.get("scale"), expected="factors to metres")
    mesh = read_mesh(resolve(name, urdf.file, place), place, urdf.file)
    check_scale(mesh.vertices, float(np.abs(scale).max()), urdf.file, place)
    # a mirror image turns the winding inside out
    triangles = mesh.triangles[:, ::-1] if np.prod(scale) < 0 else mesh.triangles
    return Piece(mesh.vertices * scale, triangles, mesh.rounding * np.abs(scale).max(), urdf.file, place)


def _posed(piece: Piece, X_RL: Pose, X_LS: Pose) -> Piece:
    X_RS = composed(X_RL, X_LS)
    if np.array_equal(X_RS.rotation, np.eye(3)) and not X_RS.translation.any():
        return piece
    vertices = X_RS.points(piece.vertices)
    rounding = piece.rounding + ROUND_OFF * np.abs(vertices).max(axis=1, initial=0.0)
    smooth = tuple(
        replace(patch, point=X_RS.points(patch.point[None])[0], axis=X_RS.rotation @ patch.axis)
        for patch in piece.smooth
    )
    return replace(piece, vertices=vertices, rounding=rounding, smooth=smooth)
