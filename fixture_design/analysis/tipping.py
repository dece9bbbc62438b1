"""Whether a part sits on a knife edge: it tips where its centre of mass is off by no more than a tie."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.analysis.balancing import branches_of, settle
from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, cross, scale_of
from fixture_design.tolerances import Tolerances

#: Why an answer about a weight is left open then.
ON_AN_EDGE = "a tie: the weight is on the very edge of what the contacts support"


def on_an_edge(
    contacts: Sequence[Contact], preloads: Mapping[str, float], weight: Vector, load: Vector, tolerances: Tolerances
) -> bool:
    """Whether the contacts no longer balance the weight and the load if the centre of mass is off by a tie, any way.

    Args:
        preloads: of elements that push with a given force [N].
        weight, load: wrenches about W's origin that are balanced; without weight the answer is no.
    """
    scale, plane = scale_of(contacts), len(contacts[0].point)
    force = weight[:plane]
    if not force.any():
        return False
    branches, complete = branches_of(contacts, preloads, tolerances)
    for shift in np.vstack([np.eye(plane), -np.eye(plane)]) * tolerances.near * scale.length:
        turning = np.append(np.zeros(plane), cross(shift[None], force[None])[0])
        if np.any(turning) and not settle(branches, complete, weight + load + turning, tolerances).balances:
            return True
    return False
