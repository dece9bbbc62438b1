"""Forces of contacts on the part as arrows: weights that balance, and forces that carry loads. Lengths tell sizes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from fixture_design.contacts import Contact
from fixture_design.layout import ContactForce, Finding, Weights
from fixture_design.verification.proofs import Pyramids, unit_forces
from fixture_design.viewing.palette import PUSH
from fixture_design.viewing.scene.drawn_sizes import LONGEST, THICK
from fixture_design.viewing.scene.scene import Thing
from fixture_design.viewing.scene.shapes import Arrow, Vector3
from fixture_design.viewing.scene.space import lifted, lifted_rows

#: Forces below this part of the longest are not drawn [-].
_UNSEEN = 1e-6

#: What a contact does to the part: (its name, where in W, force [N], or weight without unit).
Push = tuple[str, Vector3, Vector3]


def weight_pushes(weights: Weights, contacts: Sequence[Contact], finding: Finding) -> list[Push]:
    """One push a normal: minus the sum of the weighted unit normals, or of the edges of its friction cone.

    Returns:
        those that are not zero; their wrenches balance as the weights do.
    """
    pushes: list[Push] = []
    for contact in contacts:
        given = np.array(weights.weights.get(contact.name, ()))
        for forces in _rows(contact, finding, len(given)):
            own, given = given[: len(forces)], given[len(forces) :]
            if own.any():
                pushes.append((contact.name, lifted(contact.point), -(own @ lifted_rows(forces))))
    return pushes


def _rows(contact: Contact, finding: Finding, count: int) -> list[np.ndarray]:
    """Forces of each normal's rows; the evidence is about edges of friction cones where it has more than normals."""
    pyramids = None if count == len(contact.normals) else Pyramids(finding.edges or 0, finding.tangents or {})
    found = unit_forces(contact, pyramids)
    return [] if isinstance(found, str) else [forces for forces, _ in found]


def force_pushes(forces: Mapping[str, ContactForce], contacts: Sequence[Contact]) -> list[Push]:
    """One push a normal [N], of those that are not zero."""
    points = {contact.name: lifted(contact.point) for contact in contacts}
    return [
        (name, points[name], lifted(force))
        for name, found in forces.items()
        for force in found.forces
        if np.any(force) and name in points
    ]  # fmt: skip


def longest_of(pushes: Sequence[Push]) -> float:
    return max((float(np.linalg.norm(force)) for _, _, force in pushes), default=0.0)


def push_things(path: str, pushes: Sequence[Push], scale: float, size: float) -> Iterator[Thing]:
    """Arrows from the contacts into the part, ``scale`` metres a newton."""
    longest = longest_of(pushes)
    for number, (_, point, force) in enumerate(pushes):
        if np.linalg.norm(force) > _UNSEEN * longest:
            yield Thing(f"{path}/push/{number}", Arrow(point, point + scale * force, THICK * size), PUSH)


def scale_for(longest: float, size: float) -> float:
    """Metres a newton such that the longest force is as long as pictures allow."""
    return LONGEST * size / longest if longest > 0 else 0.0
