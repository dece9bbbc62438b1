"""Motions that move every touched surface along itself: a shaft's spin, a prism's slide, whatever touches there.

A surface that a motion maps to itself goes on touching, at all of its points, whichever of them are touched: to first
order no contact with it notices. If one motion does that to all surfaces, the contacts cannot close and cannot locate,
and no error of the surfaces' directions changes that, as long as it is such errors that keep their own motions from
agreeing to the last digit: two diameters of one shaft have one axis, though it was fitted twice. That is decided here,
within the normals' stated errors and only while these are small.

Source: N. Gelfand, L. J. Guibas, Shape segmentation using local slippage analysis, Symposium on Geometry Processing,
2004.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.contacts import Contact, Scale, motion_scaled, scale_of
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, SLIP_ERRORS, Tolerances


def common_slip(contacts: Sequence[Contact], tolerances: Tolerances = DEFAULT) -> Vector | None:
    """A motion that every surface touched has among those that move it along itself, within the normals' errors.

    Returns:
        unit, in the coordinates of `scale_of` the contacts, shape (6,); None if there is none, if some contact's
        surfaces are not known, or if normals are off by so much that surfaces of different directions would be one.
    """
    known = all(len(contact.slips) == len(contact.normals) for contact in contacts)
    if not known or max(contact.provenance.off_slip for contact in contacts) > COPLANAR_ANGLE:
        return None
    scale = scale_of(contacts)
    zero = tolerances.at_offset(scale.offset).zero
    projectors, allowed = [], []
    for contact in contacts:
        for slips in contact.slips:
            if not len(slips):
                return None
            projectors.append(off_slips(slips, scale))
            allowed.append(slip_error(contact, scale) + zero)
    motion = np.linalg.svd(np.vstack(projectors))[2][-1]
    off = [float(np.linalg.norm(projector @ motion)) for projector in projectors]
    return motion if all(o <= a for o, a in zip(off, allowed, strict=True)) else None


def off_slips(slips: Rows, scale: Scale) -> Rows:
    """The projector onto what is square to a surface's own motions, in scaled coordinates, shape (6, 6)."""
    scaled = np.array([motion_scaled(slip, scale.reference, scale.length) for slip in slips])
    _, values, right = np.linalg.svd(scaled, full_matrices=False)
    basis = right[values > DEFAULT.tie * values[0]]
    return np.eye(6) - basis.T @ basis


def slip_error(contact: Contact, scale: Scale) -> float:
    """How far the error of a contact's surface may move its surface's own motions, at most [-]."""
    lever = float(np.linalg.norm(contact.point - scale.reference)) / scale.length
    return SLIP_ERRORS * contact.provenance.off_slip * float(np.hypot(1.0, lever))
