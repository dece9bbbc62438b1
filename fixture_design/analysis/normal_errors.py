"""What normals that may be off leave open: who blurs an answer, and the motions that no normal can see.

A normal that is off by e moves n . v by up to e |v|, v the contact point's velocity. Contacts that a motion leaves
where they are do not notice it, whatever their normals and friction are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, scale_of
from fixture_design.tolerances import DEFAULT, Tolerances

#: Features named in one reason before it says "and so many more".
_FEATURES_SHOWN = 4
#: What a kind of normal stands on.
_SURFACES = {"exact": "", "fitted": "fitted surface, ", "approximate": "curved surface, "}


def still_motion(contacts: Sequence[Contact], tolerances: Tolerances = DEFAULT) -> Vector | None:
    """A turn that moves no contact point: about the line that they are all on, in the plane about their one point.

    Returns:
        unit, in the coordinates of `scale_of` the contacts, shape (d,); None if there is no such turn.
    """
    scale = scale_of(contacts)
    levers = np.array([contact.point - scale.reference for contact in contacts]) / scale.length
    _, sizes, axes = np.linalg.svd(levers)
    zero = tolerances.at_offset(scale.offset).zero
    plane = levers.shape[1]
    aside = float(sizes[plane - 2]) if len(sizes) > plane - 2 else 0.0
    if aside > zero:
        return None
    return np.concatenate([np.zeros(plane), axes[0] if plane == 3 else [1.0]])


def blur(contacts: Sequence[Contact], tolerances: Tolerances = DEFAULT) -> str | None:
    """Whose normals are off by how much, the worst first: "normals on facet 12 (L1, L2: off by up to 0.17 rad)".

    Returns:
        None where all normals are exact to rounding.
    """
    places: dict[tuple[str, str], list[Contact]] = {}
    for contact in contacts:
        if contact.provenance.normal_error > tolerances.zero:
            where = f"on {contact.feature} " if contact.feature else "given "
            places.setdefault((where, contact.provenance.kind), []).append(contact)
    if not places:
        return None
    worst = sorted(places.items(), key=lambda item: -max(c.provenance.normal_error for c in item[1]))
    texts = []
    for (where, kind), members in worst[:_FEATURES_SHOWN]:
        largest = max(contact.provenance.normal_error for contact in members)
        names = ", ".join(contact.name for contact in members)
        texts.append(f"{where}({names}: {_SURFACES[kind]}off by up to {largest:.2g} rad)")
    if len(worst) > _FEATURES_SHOWN:
        texts.append(f"{len(worst) - _FEATURES_SHOWN} more places")
    return f"normals {', '.join(texts)} could tip it"
