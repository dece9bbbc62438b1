"""The contacts of a configuration of round bodies, with the normals that a controller works with."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.assembly.contact_geometry import require_no_overlap
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.placement import Placement
from fixture_design.assembly.round_space import RIM_POINTS, RoundGeometry
from fixture_design.assembly.turned_body import TurnedBody
from fixture_design.contacts import Contact
from fixture_design.contacts.polyhedral import polyhedral_clauses
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


def round_contacts(geometry: RoundGeometry, configuration: Vector) -> tuple[Contact, ...]:
    """The contacts of a configuration, points from the moving body's origin, fixed axes.

    Where pairs touch in one point, on a rim, they are one contact with the clauses of both bodies' tangent cones there.
    A disk on a plane is `RIM_POINTS` contacts on its rim, as far as they are on the facet: an approximation.

    Raises:
        AssemblyError: the parts overlap there.
    """
    q = configuration[None]
    near = TOUCHING * geometry.size
    require_no_overlap(geometry, q, near)
    place = geometry.place(q)
    touching = np.flatnonzero(geometry.distances(q)[0] <= near)
    if not touching.size:
        return ()
    normals = geometry.equations(q, touching[None]).face_vectors[0, :, :3]
    arms, at_ends = geometry.arms(q, touching[None])[0], geometry.at_apices(q, near)[0, touching]
    names = [geometry.names[k] for k in touching]
    contacts, below = _disks(geometry, place, touching, near)
    single = [k for k in range(len(names)) if not at_ends[k] and not below(names[k])]
    contacts += [Contact.on_facet(names[k], "locator", arms[k], normals[k]) for k in single]
    for k in np.flatnonzero(at_ends).tolist():
        if all(np.linalg.norm(contact.point - arms[k]) > near for contact in contacts) and not below(names[k]):
            clauses = polyhedral_clauses(
                [_of_turned(geometry.moving, place, arms[k], near)], _of_blocks(geometry.fixed, place, arms[k], near)
            )
            if clauses is None:
                raise AssemblyError("the parts overlap at this configuration", found=f"{q[0].tolist()}")
            if clauses:
                contacts.append(Contact(names[k], "locator", arms[k], clauses))
    return tuple(contacts)


def _disks(geometry: RoundGeometry, place: Placement, touching: np.ndarray, near: float) -> tuple:
    """Contacts of the disks that lie on planes, and whether a pair is one that a disk stands for."""
    contacts, implied = [], set()
    for k in touching.tolist():
        flat = geometry.flat(k)
        if flat is not None:
            implied |= {geometry.names[k], flat.below}
            for number, point in enumerate(flat.rim_points(place, RIM_POINTS)):
                name = f"{geometry.names[k]}, rim point {number + 1}"
                contacts.append(Contact.on_facet(name, "locator", point - place.position[0], -flat.plane.normal))
    return contacts, implied.__contains__


def _of_turned(body: TurnedBody, place: Placement, arm: np.ndarray, near: float) -> list[np.ndarray]:
    """Outward normals of the surfaces of the moving body at one of its points."""
    point, axis = (place.position[0] + arm)[None, None], place.axis
    heights = body.offsets(point, axis, place.origin)[0, 0]
    away = point[0, 0] - place.origin[0]
    out = away - (away @ axis[0]) * axis[0]
    out /= np.linalg.norm(out)
    sides = body.slopes[:, 1:] * out - body.slopes[:, :1] * axis[0]
    return list(np.vstack([sides, -axis[0], axis[0]])[np.abs(heights) <= near])


def _of_blocks(blocks: tuple[DrilledBlock, ...], place: Placement, arm: np.ndarray, near: float) -> list:
    """The tangent cones of the blocks at a point, each by its outward normals."""
    point = place.position[0] + arm
    found = []
    for block in blocks:
        heights = block.normals @ point - block.offsets
        if heights.max() > near:
            continue
        on = [normal for normal, height in zip(block.normals, heights, strict=True) if abs(height) <= near]
        walls = [wall for hole in block.holes if (wall := _wall(hole, point, near)) is not None]
        if on or walls:
            found.append([*on, *walls])
    return found


def _wall(hole: Hole, point: np.ndarray, near: float) -> np.ndarray | None:
    """The outward normal of a hole's wall at a point on it."""
    radial, rho = hole.seen(point[None])
    along = (point - hole.point) @ hole.axis
    on = abs(rho[0] - hole.radius) <= near and hole.low - near <= along <= hole.high + near
    return -radial[0] if on else None
