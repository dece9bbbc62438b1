"""Evidence in words a machinist can read: which way it moves, which contacts hold it."""

from __future__ import annotations

from math import ceil, log10

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.contacts.wrench import velocity
from fixture_design.errors import format_length
from fixture_design.layout import Answer, Finding, Motion, Rule, Singular, Weights

#: Rotations below this, per unit of size, are translations in words [-].
_STRAIGHT = 1e-9

#: Places are given to this part of the size, or finer [-].
_RESOLUTION = 1e-4
#: Units of places and the sizes from which they are used, in metres.
_UNITS = ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"))


def evidence_in_words(claim: str, finding: Finding, reference: Point, length: float) -> str:
    """One line for a finding's evidence; motions are seen from ``reference``, a point of the part, ``length`` its size.

    Args:
        reference, length: as of the verdict [m].
    """
    if finding.answer is None:
        return "no contacts"
    if finding.answer is Answer.UNDECIDED:
        return finding.reason or "undecided"
    evidence = finding.evidence
    if isinstance(evidence, Motion):
        lead = "leaves all contacts: " if claim == "strongly_accessible" else "can move: "
        return lead + motion_in_words(evidence.motion, reference, length) + rule_in_words(evidence.rule)
    if isinstance(evidence, Singular):
        if evidence.motion is None:
            return f"rank {evidence.rank}"
        motion = motion_in_words(evidence.motion, reference, length)
        return f"rank {evidence.rank}; not noticed: {motion}{rule_in_words(evidence.rule)}"
    if isinstance(evidence, tuple):
        return weights_in_words(claim, evidence)
    return ""


def weights_in_words(claim: str, branches: tuple[Weights, ...]) -> str:
    """Who balances whom: the contacts that carry weight."""
    names = [name for name, values in branches[0].weights.items() if any(values)]
    in_branches = f" (in each of {len(branches)} branches)" if len(branches) > 1 else ""
    if claim == "strongly_accessible":
        return f"{', '.join(names)} constrain both ways{in_branches}"
    lead = "can hold any load: " if claim == "force_closure" else ""
    return f"{lead}{', '.join(names)} balance with full rank{in_branches}"


def rule_in_words(rule: Rule | None) -> str:
    """Why errors of normals do not matter, as an addition to the motion; nothing without a rule."""
    if rule is None:
        return ""
    if rule.name == "slip or leave":
        return " (along some of the surfaces touched, off all others)"
    if rule.name == "common slip":
        return " (along every surface touched)"
    total = sum(block.count for block in rule.counted)
    return f" (whatever the normals: {rule.name.removeprefix('few ')} count {total} at most)"


def motion_in_words(motion: Vector, reference: Point, length: float) -> str:
    """A displacement [dx; dtheta] about W's origin as a direction, a turn about a point, or a screw.

    An axis goes through its point nearest to ``reference``, p = r + dtheta X v / |dtheta|^2 with v the velocity of r:
    the point nearest to W's origin says little where the part is far from it.
    """
    v, turn = velocity(motion, reference), motion[len(reference) :]
    size = float(np.linalg.norm(turn))
    if size * length <= _STRAIGHT * max(float(np.linalg.norm(v)), size * length):
        return f"along {_direction(v)}"
    return _turn(v, float(turn[0]), reference, length) if len(turn) == 1 else _screw(v, turn, reference, length)


def _turn(v: Vector, turn: float, reference: Point, length: float) -> str:
    centre = reference + np.array([-v[1], v[0]]) / turn
    return f"turns {'counter-clockwise' if turn > 0 else 'clockwise'} about {place_in_words(centre, length)}"


def _screw(v: Vector, turn: Vector, reference: Point, length: float) -> str:
    axis_point = reference + np.cross(turn, v) / (turn @ turn)
    pitch = float(turn @ v) / float(turn @ turn)
    text = f"turns about {_direction(turn)} through {place_in_words(axis_point, length)}"
    if abs(pitch) > _STRAIGHT * length:
        text += f", advancing {format_length(2 * np.pi * pitch)} a turn"
    return text


def place_in_words(point: Point, length: float) -> str:
    """A point in the unit that suits a part of this size, to 1e-4 of it or finer: "(12.5, 0, -3.125) mm"."""
    unit, name = next((pair for pair in _UNITS if length >= pair[0]), _UNITS[-1])
    decimals = ceil(-log10(_RESOLUTION * length / unit))
    return f"({', '.join(f'{value + 0.0:.15g}' for value in np.round(point / unit, decimals))}) {name}"


def _direction(vector: Vector) -> str:
    scaled = vector / np.abs(vector).max()
    return "[" + ", ".join(f"{value + 0.0:.3g}" for value in np.round(scaled, 6)) + "]"
