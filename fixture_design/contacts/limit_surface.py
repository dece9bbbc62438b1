"""What a soft contact carries: friction along the surface and a torsional moment about its normal, together limited.

Pressed with 1 N, a patch of radius r under uniform pressure resists turning about the normal by up to mu c with
c = 2 r / 3, the integral of mu p rho over the patch, and sliding by up to mu. Both at once it resists as far as the
limit surface, taken as an ellipsoid:  (|f_t| / mu)^2 + (m_n / (mu c))^2 <= 1.

Its unit ball is cut to a sphere's parallels and meridians: from inside by their crossings, from outside by these
crossings moved out until the faces between them touch the ball.

Source: R. D. Howe, M. R. Cutkosky, Practical force-motion models for sliding manipulation, International Journal of
Robotics Research 15, 1996.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point, Points, Rows
from fixture_design.contacts.contact import unit_normal
from fixture_design.contacts.friction import Side, friction_edges, tangents


def torsion_of_patch(radius: float) -> float:
    """c = 2 r / 3 [m]: torsional moment a newton and a unit of friction, under uniform pressure."""
    return 2.0 * radius / 3.0


def contact_edges(
    normal: Point, friction: float, torsion: float, edges: int = 8, side: Side = "inner", first: Point | None = None
) -> tuple[Points, Rows]:
    """Edges of the cone of wrenches at a contact point: forces with unit normal component, and moments about it.

    Without friction or torsion these are the `friction_edges`, with moments that are zero.

    Args:
        normal: outward normal, shape (p,), any length, not zero.
        friction: mu >= 0.  torsion: c >= 0 [m], 0 in the plane.
        edges: around the cone, >= 4 with torsion.  side: which bracket, in space.
        first: unit tangent that the edges are counted from, in space, as in `friction_edges`.

    Returns:
        forces, shape (k, p), and moments [m], shape (k, 3) in space, (k, 1) in the plane.
    """
    if friction == 0 or torsion == 0:
        forces = friction_edges(normal, friction, edges, side, first)
        return forces, np.zeros((len(forces), 1 if len(normal) == 2 else 3))
    unit = unit_normal(normal)
    directions = friction * limit_directions(edges, side)
    frame = np.array(tangents(unit) if first is None else (first, np.cross(unit, first)))
    return unit + directions[:, :2] @ frame, torsion * directions[:, 2:] * unit


def limit_directions(edges: int, side: Side) -> Points:
    """Corners of a polytope in the limit surface's unit ball, or around it: two tangents and the spin, shape (k, 3)."""
    return _crossings(edges) / (1.0 if side == "inner" else _inner_radius(edges))


def _crossings(edges: int) -> Points:
    """Points of the unit sphere: the poles, and where ``edges`` meridians cross the parallels, shape (k, 3)."""
    latitudes = _latitudes(edges)[1:-1]
    longitudes = 2 * np.pi * np.arange(edges) / edges
    latitude, longitude = (grid.ravel() for grid in np.meshgrid(latitudes, longitudes, indexing="ij"))
    ring = np.column_stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)])
    return np.vstack([[0.0, 0.0, 1.0], np.column_stack([ring, np.sin(latitude)]), [0.0, 0.0, -1.0]])


def _latitudes(edges: int) -> np.ndarray:
    """From pole to pole, as far apart as the meridians are at the equator, which is one of them."""
    return np.linspace(-np.pi / 2, np.pi / 2, 2 * max(1, edges // 4) + 1)


def _inner_radius(edges: int) -> float:
    """Distance from the centre to the nearest face of the crossings' hull.

    A face between two meridians and two parallels is an isosceles trapezoid; seen along it, it is the line through
    (cos(b) cos(pi / edges), sin(b)) for both latitudes b.
    """
    latitudes = _latitudes(edges)
    x, z = np.cos(latitudes) * np.cos(np.pi / edges), np.sin(latitudes)
    across = np.abs(x[:-1] * z[1:] - x[1:] * z[:-1])
    return float((across / np.hypot(np.diff(x), np.diff(z))).min())
