"""Evidence in words a machinist can read: which way it moves, which contacts hold it."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.errors import format_length
from fixture_design.layout import Answer, Finding, Motion, Rule, Singular, Weights

#: Rotations below this, per unit of size, are translations in words [-].
_STRAIGHT = 1e-9


def evidence_in_words(claim: str, finding: Finding, length: float) -> str:
    """One line for a finding's evidence; ``length`` is the size against which turning counts [m]."""
    if finding.answer is None:
        return "no contacts"
    if finding.answer is Answer.UNDECIDED:
        return finding.reason or "undecided"
    evidence = finding.evidence
    if isinstance(evidence, Motion):
        lead = "leaves all contacts: " if claim == "strongly_accessible" else "can move: "
        return lead + motion_in_words(evidence.motion, length) + rule_in_words(evidence.rule)
    if isinstance(evidence, Singular):
        if evidence.motion is None:
            return f"rank {evidence.rank}"
        motion = motion_in_words(evidence.motion, length)
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
    total = sum(block.count for block in rule.counted)
    return f" (whatever the normals: {rule.name.removeprefix('few ')} count {total} at most)"


def motion_in_words(motion: Vector, length: float) -> str:
    """A displacement [dx; dtheta] about W's origin as a direction, a turn about an axis, or a screw."""
    return _planar(motion, length) if len(motion) == 3 else _spatial(motion, length)


def _planar(motion: Vector, length: float) -> str:
    dx, turn = motion[:2], float(motion[2])
    if abs(turn) * length <= _STRAIGHT * max(float(np.linalg.norm(dx)), abs(turn) * length):
        return f"along {_direction(dx)}"
    centre = np.array([-dx[1], dx[0]]) / turn
    sense = "counter-clockwise" if turn > 0 else "clockwise"
    return f"turns {sense} about {_place(centre)}"


def _spatial(motion: Vector, length: float) -> str:
    dx, turn = motion[:3], motion[3:]
    size = float(np.linalg.norm(turn))
    if size * length <= _STRAIGHT * max(float(np.linalg.norm(dx)), size * length):
        return f"along {_direction(dx)}"
    axis_point = np.cross(turn, dx) / size**2
    pitch = float(turn @ dx) / size**2
    text = f"turns about {_direction(turn)} through {_place(axis_point)}"
    if abs(pitch) > _STRAIGHT * length:
        text += f", advancing {format_length(2 * np.pi * pitch)} a turn"
    return text


def _direction(vector: Vector) -> str:
    scaled = vector / np.abs(vector).max()
    return "[" + ", ".join(f"{value + 0.0:.3g}" for value in np.round(scaled, 6)) + "]"


def _place(point: Vector) -> str:
    return "(" + ", ".join(format_length(value + 0.0) if value else "0" for value in np.round(point, 9)) + ")"
