"""Evidence in words a machinist can read: which way it moves, which contacts hold it."""

from __future__ import annotations

from fixture_design.arrays import Point
from fixture_design.layout import Answer, Finding, Motion, Rule, Singular, Weights
from fixture_design.viewing.motion_words import motion_in_words
from fixture_design.viewing.use_words import use_in_words


def evidence_in_words(claim: str, finding: Finding, reference: Point, length: float) -> str:
    """One line for a finding's evidence; motions are seen from ``reference``, a point of the part, ``length`` its size.

    Args:
        reference, length: as of the verdict [m].
    """
    if finding.answer is None:
        return "no contacts"
    if finding.use is not None and (finding.answer is not Answer.UNDECIDED or finding.reason is None):
        return use_in_words(finding.use, reference, length)
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
