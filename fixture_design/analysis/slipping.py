"""Motions that move every touched surface along itself: a shaft's spin, a prism's slide, whatever touches there.

A surface that a motion maps to itself goes on touching, at all of its points, whichever of them are touched: to first
order no contact with it notices. If one motion does that to all surfaces, the contacts cannot close and cannot locate,
and no error of the surfaces' directions changes that, as long as it is such errors that keep their own motions from
agreeing to the last digit: two diameters of one shaft have one axis, though it was fitted twice. That is decided here,
within the normals' stated errors and only while these are small.

A motion that slips along some surfaces and leaves the contacts on all others, by more than errors could take back, is
as certain: a plate lifts off its rests along the bores of its pins. Such contacts do not close.

Source: N. Gelfand, L. J. Guibas, Shape segmentation using local slippage analysis, Symposium on Geometry Processing,
2004.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones.kernel import minimum_norm_point
from fixture_design.contacts import Contact, Scale, constraints_of, motion_scaled, scale_of
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, SLIP_ERRORS, Tolerances


def common_slip(contacts: Sequence[Contact], tolerances: Tolerances = DEFAULT) -> Vector | None:
    """A motion that every surface touched has among those that move it along itself, within the normals' errors.

    Returns:
        unit, in the coordinates of `scale_of` the contacts, shape (6,); None if there is none, if some contact's
        surfaces are not known, or if normals are off by so much that surfaces of different directions would be one.
    """
    slips = _slips_of(contacts, scale_of(contacts), tolerances)
    return slips[-1] if len(slips) else None


def slip_or_leave(contacts: Sequence[Contact], tolerances: Tolerances = DEFAULT) -> Vector | None:
    """A motion that slips along some of the surfaces, as in `common_slip`, and leaves the contacts on all others.

    Contacts that keep others from being left at once, which the nearest point of their rows' hull tells, are those to
    slip along. A contact is left only if each of its normals is, by more than errors of normals and slips amount to.

    Returns:
        unit, in the coordinates of `scale_of` the contacts, shape (6,); None if there is none, or all would slip.
    """
    constraints = constraints_of(contacts)
    owner = constraints.contact[constraints.clause[constraints.alternative]]
    lengths = np.linalg.norm(constraints.rows, axis=1)
    rows, errors = constraints.rows / lengths[:, None], constraints.errors / lengths
    # where normals that are off nearly balance, others make up for the rest of it with weights of that size
    accidental = SLIP_ERRORS * min(float(errors.max()), COPLANAR_ANGLE)
    kept: set[int] = set()
    while len(kept) < len(contacts):
        slipped = [contacts[index] for index in sorted(kept)]
        motions = _slips_of(slipped, constraints.scale, tolerances) if kept else np.eye(rows.shape[1])
        if not len(motions):
            return None
        left = ~np.isin(owner, list(kept))
        nearest, weights = minimum_norm_point(rows[left] @ motions.T)
        off = max((slip_error(contact, constraints.scale) for contact in slipped), default=0.0)
        gain = float(np.linalg.norm(nearest))
        if gain - off - float(errors[left].max()) > tolerances.at_offset(constraints.scale.offset).near:
            return -(nearest / gain) @ motions
        kept |= set(owner[left][weights > accidental].tolist())
    return None


def _slips_of(contacts: Sequence[Contact], scale: Scale, tolerances: Tolerances) -> Rows:
    """The motions that every one of some surfaces has among its own, unit rows, shape (k, 6); k may be 0."""
    none = np.zeros((0, 6))
    known = all(len(contact.slips) == len(contact.normals) for contact in contacts)
    if not known or max(contact.provenance.off_slip for contact in contacts) > COPLANAR_ANGLE:
        return none
    zero = tolerances.at_offset(scale.offset).zero
    projectors, allowed = [], []
    for contact in contacts:
        for slips in contact.slips:
            if not len(slips):
                return none
            projectors.append(off_slips(slips, scale))
            allowed.append(slip_error(contact, scale) + zero)
    motions = np.linalg.svd(np.vstack(projectors))[2]
    off = np.array([np.linalg.norm(motions @ projector, axis=1) for projector in projectors])
    return motions[(off <= np.array(allowed)[:, None]).all(axis=0)]


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
