"""What the fixture does to the part (`layout.use`) as JSON: witnesses of the findings, and the verdict's `loads`.

A number without limit is null; what was not computed is null or absent.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isinf

from fixture_design.io.witness_record import plain_numbers
from fixture_design.layout import (
    Balance,
    ContactForce,
    Finding,
    GroupVerdict,
    LoadsHeld,
    LoadVerdict,
    LocatingErrors,
    Rocking,
    Seating,
    SeatingStep,
    StraightWays,
    Unbalanced,
    UseEvidence,
    severity,
)

Data = dict[str, object]


def use_to_dict(evidence: UseEvidence) -> Data:
    """The witness of one finding; the loads of `LoadsHeld` are in the verdict's `loads`."""
    match evidence:
        case LocatingErrors():
            return _locating(evidence)
        case LoadsHeld():
            return _loads_held(evidence)
        case Seating():
            return {"steps": [_step(step) for step in evidence.steps], "preloads": _by_name(evidence.preloads)}
        case StraightWays():
            return _ways(evidence)


def loads_to_list(groups: Mapping[str, GroupVerdict], brief: bool) -> list[Data]:
    """One object a group and load, in order: the verdict over all points of its path, and its worst point's proof."""
    found = []
    for group in groups.values():
        use = group.findings.get("holds_loads", Finding(None)).use
        if isinstance(use, LoadsHeld):
            for name in dict.fromkeys(load.load for load in use.loads):
                points = [load for load in use.loads if load.load == name]
                found.append({"group": group.name} | _load(points, brief))
    return found


def _load(points: Sequence[LoadVerdict], brief: bool) -> Data:
    worst = min(points, key=severity)
    data: Data = {"load": worst.load, "verdict": str(worst.answer), "reserve": _reserve(worst)}
    if worst.row is not None:
        held = sum(point.answer == "yes" for point in points)
        data |= {"row": int(worst.row), "points": len(points), "held": held}
    if brief:
        return data
    data |= {"needed": plain_numbers(worst.needed), "first": [list(contact) for contact in worst.first]}
    data |= {"proof": _proof(worst.proof)} | ({} if worst.reason is None else {"reason": worst.reason})
    if worst.row is not None:
        data["rows"] = [
            {"row": int(point.row or 0), "verdict": str(point.answer), "reserve": _reserve(point)} for point in points
        ]
    return data


def _reserve(load: LoadVerdict) -> list[object] | None:
    return None if load.reserve is None else [_limit(bound) for bound in load.reserve]


def _limit(number: float) -> object:
    return None if isinf(number) else plain_numbers(number)


def _proof(proof: Balance | Unbalanced | None) -> Data | None:
    if proof is None:
        return None
    if isinstance(proof, Unbalanced):
        return {
            "wrench": plain_numbers(proof.wrench),
            "motion": plain_numbers(proof.motion),
            "surplus": plain_numbers(proof.surplus),
        }
    return {
        "wrench": plain_numbers(proof.wrench),
        "forces": _forces(proof.forces),
        "residual": plain_numbers(proof.residual),
    }


def _forces(forces: Mapping[str, ContactForce]) -> Data:
    return {
        name: {"forces": plain_numbers(force.forces)}
        | ({"moments": plain_numbers(force.moments)} if force.moments.any() else {})
        for name, force in forces.items()
    }


def _loads_held(evidence: LoadsHeld) -> Data:
    worst = evidence.loads[evidence.worst]
    return {
        "worst": {"load": worst.load} | ({} if worst.row is None else {"row": int(worst.row)}),
        "preloads": _by_name(evidence.preloads),
        "least_preloads": None if evidence.least_preloads is None else _by_name(evidence.least_preloads),
        "determinate": evidence.determinate,
        "stiff": None if evidence.stiff is None else _forces(evidence.stiff),
    }


def _step(step: SeatingStep) -> Data:
    return {
        "clamp": step.clamp,
        "verdict": str(step.answer),
        "reactions": {name: [_limit(value) for value in bounds] for name, bounds in step.reactions.items()},
        "idle": list(step.idle),
        "lifted": list(step.lifted),
        "proof": _proof(step.proof),
        "cause": step.cause,
    }


def _locating(evidence: LocatingErrors) -> Data:
    return {
        "features": [
            {
                "name": feature.feature,
                "tolerance": plain_numbers(feature.tolerance),
                "worst": _limit(feature.worst),
                "least": _limit(feature.least),
                "rss": _limit(feature.rss),
                "shares": _by_name(feature.shares),
                "seat": list(feature.seat),
            }
            for feature in evidence.features
        ],
        "pose": plain_numbers(evidence.pose),
        "errors": _by_name(evidence.errors),
        "costliest": evidence.costliest,
        "rocking": [_rocking(rocking) for rocking in evidence.rockings],
        "motion": plain_numbers(evidence.motion),
        "complete": evidence.complete,
    }


def _rocking(rocking: Rocking) -> Data:
    return {
        "contacts": list(rocking.contacts),
        "motion": plain_numbers(rocking.motion),
        "size": plain_numbers(rocking.size),
    }


def _ways(evidence: StraightWays) -> Data:
    obstacle = evidence.obstacle
    found: Data | None = None
    if obstacle is not None:
        after, point = plain_numbers(obstacle.after), plain_numbers(obstacle.point)
        found = {"name": obstacle.name, "after": after, "point": point}
    return {
        "contacts": list(evidence.contacts),
        "open": list(evidence.open),
        "spans": plain_numbers(evidence.spans),
        "lines": plain_numbers(evidence.lines),
        "direction": plain_numbers(evidence.direction),
        "leaving": plain_numbers(evidence.leaving),
        "slides": list(evidence.slides),
        "length": plain_numbers(evidence.length),
        "against": list(evidence.against),
        "obstacle": found,
        "weights": None
        if evidence.weights is None
        else {name: plain_numbers(values) for name, values in evidence.weights.items()},
    }


def _by_name(values: Mapping[str, float]) -> Data:
    return {name: plain_numbers(value) for name, value in values.items()}
