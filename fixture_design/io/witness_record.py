"""Witnesses as JSON: a motion, a rank, or weights, flat where a single branch decides and as branches otherwise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.layout import Evidence, Motion, Rule, Singular, Weights

Choice = Sequence[tuple[str, int, int]]


def witness_to_dict(evidence: Evidence | None) -> dict[str, object] | None:
    """The witness of a finding; None where there is none (an empty group, or undecided)."""
    if evidence is None:
        return None
    if isinstance(evidence, Motion):
        return {"motion": plain_numbers(evidence.motion)} | _rule(evidence.rule)
    if isinstance(evidence, Singular):
        return _singular(evidence)
    if len(evidence) == 1 and not evidence[0].choice:
        return _weights(evidence[0])
    return {"branches": [{"choice": _choice(branch.choice)} | _weights(branch) for branch in evidence]}


def _singular(evidence: Singular) -> dict[str, object]:
    data: dict[str, object] = {"rank": int(evidence.rank)}
    if evidence.motion is not None:
        data["motion"] = plain_numbers(evidence.motion)
    if any(evidence.choices):
        data["choices"] = [_choice(choice) for choice in evidence.choices]
    return data | _rule(evidence.rule)


def _rule(rule: Rule | None) -> dict[str, object]:
    if rule is None:
        return {}
    counted = [{"contacts": list(block.contacts), "count": int(block.count)} for block in rule.counted]
    return {"rule": {"name": rule.name, "counted": counted}}


def _weights(evidence: Weights) -> dict[str, object]:
    weights: Mapping[str, Sequence[float]] = evidence.weights
    return {
        "weights": {name: plain_numbers(values) for name, values in weights.items()},
        "basis": [[name, int(index)] for name, index in evidence.basis],
    }


def _choice(choice: Choice) -> list[list[object]]:
    return [[contact, int(clause), int(alternative)] for contact, clause, alternative in choice]


def plain_numbers(values: object) -> object:
    """A number or an array of any shape as float or nested lists of floats, without -0.0; None stays None.

    Raises:
        ValueError: NaN or infinite.
    """
    if values is None:
        return None
    array = np.asarray(values, dtype=np.float64)
    if not np.isfinite(array).all():
        raise ValueError(f"a verdict has numbers that are not finite: {array.tolist()}")
    return (array + 0.0).tolist()  # -0.0 + 0.0 is 0.0
