"""A flat pad on a flat part of the surface."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point
from fixture_design.errors import GeometryError
from fixture_design.geometry.footprint import Footprint, check_clear, footprint
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.tip_touch import TipTouch
from fixture_design.layout import PadTip


def pad_touches(
    geometry: PartGeometry, local: LocalSurface, p_PC: Point, tip: PadTip, along: Point, gap: float
) -> tuple[TipTouch, ...]:
    """The corners of the convex hull of where a pad and the part touch, with one normal.

    The pad lies in the plane of the facet under its centre, its width along the projection of ``along``. It touches
    wherever the part has facets in that plane: holes and pockets are cut out, facets across a slot count. A motion is
    admissible if n . v(x) <= 0 all over the overlap; v(x) is affine in x, so it is enough to ask that at the corners of
    the convex hull, and forces anywhere in the overlap are sums of forces at these corners.

    Args:
        local: of the surface at ``p_PC``, the pad's centre.  along: in P.  gap: [m].

    Raises:
        GeometryError: a curved surface; a centre on an edge; ``along`` is the normal; no room beside the facet.
    """
    normal = flat_normal(geometry, local, "a pad")
    place = footprint(geometry, p_PC, normal, along, (tip.width / 2, tip.height / 2), gap, "a pad")
    check_clear(geometry, place, gap, "a pad")
    corners = place.points(_overlap_hull(place, geometry.on_edge))
    return tuple(TipTouch(corner, ((normal,),), local.provenance, local.feature) for corner in corners)


def flat_normal(geometry: PartGeometry, local: LocalSurface, what: str) -> Point:
    """The normal of the facet at a tip's centre.

    Raises:
        GeometryError: a curved surface, an edge or an apex.
    """
    if local.shape != "flat":
        raise GeometryError(f"{what} centred on {local.feature} has no plane", expected="its centre inside a facet")
    if local.provenance.kind != "exact" or geometry.surface_of_facet(local.facets[0]) is not None:
        raise GeometryError(
            f"{what} cannot lie flat on {local.feature}, which is part of a curved surface",
            expected="a flat facet (or `faceted: true` for a part that has no curved surfaces), or another tip",
        )
    return local.clauses[0][0]


def _overlap_hull(place: Footprint, precision: float) -> Float[np.ndarray, "_ 2"]:
    """Corners of the convex hull of rectangle and triangles, in order, none within ``precision`` of its neighbours."""
    import shapely

    width, height = place.half
    triangles = np.array(shapely.polygons(place.flat))
    pieces = np.array(shapely.clip_by_rect(triangles, -width, -height, width, height))
    touching = pieces[shapely.area(pieces) > precision**2]
    if not len(touching):
        raise GeometryError("a pad does not overlap the facet at all", expected="a larger pad")
    hull = shapely.convex_hull(shapely.multipoints(shapely.get_coordinates(touching)))
    return _without_blunt(shapely.get_coordinates(hull)[:-1], precision)


def _without_blunt(corners: Float[np.ndarray, "_ 2"], precision: float) -> Float[np.ndarray, "_ 2"]:
    """A convex polygon without corners that are within ``precision`` of the line between their neighbours."""
    while len(corners) > 3:
        before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
        base = after - before
        lever = corners - before
        heights = np.abs(base[:, 0] * lever[:, 1] - base[:, 1] * lever[:, 0]) / np.linalg.norm(base, axis=1)
        bluntest = int(np.argmin(heights))
        if heights[bluntest] > precision:
            break
        corners = np.delete(corners, bluntest, axis=0)
    return corners
