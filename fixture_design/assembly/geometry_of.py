"""Which contact geometry an assembly has."""

from __future__ import annotations

from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.planar import PlanarGeometry
from fixture_design.errors import UnsupportedError


def geometry_of(assembly: Assembly) -> ContactGeometry:
    """The contact geometry of an assembly.

    Raises:
        AssemblyError: bodies or names that cannot be used.
        UnsupportedError: an assembly in space.
    """
    if assembly.space == "planar":
        return PlanarGeometry.of(assembly)
    raise UnsupportedError(
        "contact states in space are not evaluated yet", source=assembly.source, expected="`space: planar`"
    )
