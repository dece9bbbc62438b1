"""Which contact geometry an assembly has."""

from __future__ import annotations

from functools import lru_cache

from fixture_design.assembly.assembly import Assembly
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.planar import PlanarGeometry
from fixture_design.assembly.round_bodies import round_bodies
from fixture_design.assembly.round_space import RoundGeometry
from fixture_design.assembly.spatial import SpatialGeometry


@lru_cache(maxsize=4)  # the same assembly is asked for again for every state
def geometry_of(assembly: Assembly) -> ContactGeometry:
    """The contact geometry of an assembly.

    Raises:
        AssemblyError: bodies or names that cannot be used.
        UnsupportedError: in space: round surfaces that form no pairs, or too many features.
    """
    if assembly.space == "planar":
        return PlanarGeometry.of(assembly)
    found = round_bodies(assembly)
    return SpatialGeometry.of(assembly) if found is None else RoundGeometry.of(assembly, *found)
