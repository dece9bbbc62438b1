"""The parts that bodies in space are: meshes and URDFs, read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fixture_design.assembly.assembly import AssemblyBody
from fixture_design.layout import Part, Pose

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry


def part_of(body: AssemblyBody) -> PartGeometry:
    """A mesh or URDF in its own frame.

    Raises:
        GeometryError: it cannot be read.
    """
    from fixture_design.geometry import PartGeometry, load_part  # noqa: PLC0415 - only where a file is read

    assert body.file is not None
    kind = "mesh" if body.kind == "mesh" else "urdf"
    geometry = load_part(Part(body.file.stem, kind, body.file, None, body.scale, Pose.identity(3)))
    assert isinstance(geometry, PartGeometry)
    return geometry
