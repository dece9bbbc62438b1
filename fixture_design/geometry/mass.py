"""How heavy a part is and where its centre of mass is: as the layout says, its URDF says, or its shape has it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.polygon import Polygon
from fixture_design.geometry.urdf_tree import UrdfFile, composed, links_in_root, robot_of
from fixture_design.layout import Part


@dataclass(frozen=True, eq=False)
class Mass:
    """``mass`` [kg] at ``center``, in P [m]; ``note``: what was assumed, for people."""

    mass: float
    center: Point
    note: str | None = None


def mass_of(part: Part, geometry: PartGeometry | Polygon) -> Mass | None:
    """The part's mass and its centre; None where nothing says how heavy it is.

    What the layout says counts first, then the <inertial> elements of a URDF file, links added up. Without a centre it
    is that of the shape, filled with one material.

    Raises:
        FileFormatError: an <inertial> that cannot be used.
    """
    urdf = _of_urdf(part.file) if part.kind == "urdf" and part.file is not None else None
    mass = part.mass if part.mass is not None else None if urdf is None else urdf.mass
    if mass is None:
        return None
    if part.center is not None:
        return Mass(mass, part.center)
    if urdf is not None:
        return Mass(mass, urdf.center)
    center = _area_center(geometry.vertices) if isinstance(geometry, Polygon) else _volume_center(geometry)
    return Mass(mass, center, f"{part.name}: no `center` is given; that of its shape is used, as of one material")


def _of_urdf(file: Path) -> Mass | None:
    urdf = UrdfFile(file, robot_of(file))
    masses, centers = [], []
    for link, X_RL in links_in_root(urdf).items():
        element = next(e for e in urdf.robot.findall("link") if e.get("name") == link)
        inertial = element.find("inertial")
        if inertial is None:
            continue
        place = f"link {link!r}, inertial"
        masses.append(_link_mass(urdf, inertial, place))
        centers.append(composed(X_RL, urdf.origin(inertial, place)).translation)
    total = float(np.sum(masses))
    return Mass(total, read_only(np.array(masses) @ np.array(centers) / total)) if total > 0 else None


def _link_mass(urdf: UrdfFile, inertial: ElementTree.Element, place: str) -> float:
    found = inertial.find("mass")
    if found is None:
        raise urdf.error("there is no mass", place, expected='<mass value="..."/>')
    value = float(urdf.numbers(found, "value", "", place, counts=(1,))[0])
    if value < 0:
        raise urdf.error("a mass below zero", place, found=str(value))
    return value


def _volume_center(geometry: PartGeometry) -> Point:
    """Of the solid: signed tetrahedra from the box's centre, weighted by their volumes."""
    corners = geometry.vertices[geometry.triangles] - geometry.box_center
    volumes = np.einsum("ti,ti->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return read_only(geometry.box_center + volumes @ corners.sum(axis=1) / (4 * volumes.sum()))


def _area_center(vertices: np.ndarray) -> Point:
    """Of the polygon: signed triangles from its first vertex, weighted by their areas."""
    a, b = vertices[1:-1] - vertices[0], vertices[2:] - vertices[0]
    areas = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return read_only(vertices[0] + areas @ (a + b) / (3 * areas.sum()))
