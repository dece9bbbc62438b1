"""Motions that move every touched surface along itself: a shaft's spin, a prism's slide, whatever touches there.

A surface that a motion maps to itself goes on touching, at all of its points, whichever of them are touched: to first
order no contact with it notices. If one motion does that to all surfaces, the contacts cannot close and cannot locate.
Surfaces known to within an error share it only up to that: two diameters of one shaft have one axis, though it was
fitted twice. Where all surfaces can share a motion within their stated errors, and the normals alone leave the answer
open, they are taken to share it, since surfaces agree so well on purpose or not at all; and only while the errors are
small. What the normals tell in spite of their errors is never overruled.

A motion that slips along some surfaces and leaves the contacts on all others, by more than errors could take back, is
taken alike: a plate lifts off its rests along the bores of its pins. Such contacts do not close.

Source: N. Gelfand, L. J. Guibas, Shape segmentation using local slippage analysis, Symposium on Geometry Processing,
2004.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Rows, Vector
from fixture_design.cones.kernel import minimum_norm_point
from fixture_design.contacts import Contact, Scale, constraints_of, motion_scaled, scale_of
from fixture_design.tolerances import COPLANAR_ANGLE, DEFAULT, Tolerances

#: Weights up to so many normal errors may only make up for these [-].
_MAKES_UP = 4.0
#: Rounds in which the surfaces that a motion fits worst are given more say [-].
_ROUNDS = 20


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
    accidental = _MAKES_UP * min(float(errors.max()), COPLANAR_ANGLE)
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
    allowed = np.array([slip_error(contact, scale) + zero for contact in contacts for _ in contact.slips])
    surfaces = [slips for contact in contacts for slips in contact.slips]
    if not all(map(len, surfaces)):
        return none
    projectors = np.array([off_slips(slips, scale) for slips in surfaces]) / allowed[:, None, None]
    say, motions, within = np.ones(len(projectors)), none, np.zeros(0, dtype=bool)
    for _ in range(_ROUNDS):
        # Lawson's rounds: from the motion that fits best on average to the one whose worst fit is best
        _, values, motions = np.linalg.svd((say[:, None, None] * projectors).reshape(-1, 6))
        off = np.linalg.norm(motions @ projectors, axis=2)
        within = (off <= 1.0).all(axis=0)
        if within[-1] or values[-1] > np.linalg.norm(say):
            break
        say = np.sqrt(say**2 * off[:, -1])
        say /= np.linalg.norm(say)
    return motions[within]


def off_slips(slips: Rows, scale: Scale) -> Rows:
    """The projector onto what is square to a surface's own motions, in scaled coordinates, shape (6, 6)."""
    scaled = np.array([motion_scaled(slip, scale.reference, scale.length) for slip in slips])
    _, values, right = np.linalg.svd(scaled, full_matrices=False)
    basis = right[values > DEFAULT.tie * values[0]]
    return np.eye(6) - basis.T @ basis


def slip_error(contact: Contact, scale: Scale) -> float:
    """How far the error of a contact's surface may move its surface's own motions, at most [-]."""
    lever = float(np.linalg.norm(contact.point - scale.reference)) / scale.length
    return contact.provenance.off_slip * float(np.hypot(1.0, lever))
