"""From a part as a layout names it to its geometry: read, scaled to metres, checked, wound outward."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fixture_design.errors import FileFormatError, GeometryError
from fixture_design.geometry.mesh_file import read_mesh
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.piece import Piece
from fixture_design.geometry.scaling import check_scale
from fixture_design.geometry.soundness import size_notes, sound
from fixture_design.geometry.step_file import STEP_ENDINGS
from fixture_design.geometry.urdf import read_urdf
from fixture_design.layout import Part


def load_part(part: Part) -> PartGeometry:
    """The geometry of a spatial part, in its frame P [m].

    Mesh vertices are multiplied by ``part.scale``; the meshes of a URDF file carry their own scale.

    Raises:
        GeometryError: a mesh that is empty, not finite, flat, not closed or wound inconsistently; a scale that leaves
            nothing of it, or makes it too large; a planar part.
        FileFormatError: a file that is missing or not what its name says.
        UnsupportedError: STEP without its extra package; other kinds of files; movable joints.
    """
    if part.kind == "polygon" or part.file is None:
        raise GeometryError(f"part {part.name!r} has no solid geometry", expected="a mesh, URDF or STEP file")
    if part.kind == "urdf":
        pieces, notes = read_urdf(part.file)
    elif part.kind == "step" and part.file.suffix.lower() not in STEP_ENDINGS:
        expected = f"a name that ends in {' or '.join(STEP_ENDINGS)}; other kinds are a `mesh`"
        raise FileFormatError(f"{part.file.name} is not STEP", source=part.file, expected=expected)
    else:
        pieces, notes = [_mesh_piece(part.file, part.scale)], ()
    geometry = PartGeometry.of_pieces(part.name, [sound(piece) for piece in pieces], notes, part.faceted)
    return replace(geometry, read_notes=(*geometry.read_notes, *size_notes(geometry.vertices, part.file.name)))


def _mesh_piece(file: Path, scale: float) -> Piece:
    if not (np.isfinite(scale) and scale > 0):
        raise GeometryError("scale must be a number > 0", source=file, found=str(scale))
    mesh = read_mesh(file)
    check_scale(mesh.vertices, scale, file)
    return Piece(mesh.vertices * scale, mesh.triangles, mesh.rounding * scale, file)
