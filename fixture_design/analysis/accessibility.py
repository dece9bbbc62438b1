"""Accessibility and detachability (thesis 2.3 (b), 2.6 (b)): can the part get out, and can it leave everything at once?

Accessible: A holds a displacement other than o (2-20), which is the negation of form closure. Strongly accessible: the
interior of A is not empty (2-21), so that the part leaves all contacts together instead of sliding along some, which
may jam. The interior of a union is non-empty if and only if that of one of its cones is (2-51).
"""

from __future__ import annotations

from fixture_design.analysis.restraint import Restraint
from fixture_design.layout import Answer, Finding


def accessible(restraint: Restraint) -> Finding:
    """Whether some motion is admissible: A != {o}  (2-20).

    Returns:
        yes with a motion, no with the weights of form closure, or undecided; margin -s.
    """
    settled = restraint.closed
    return restraint.finding(Answer.of(settled.truth).negated(), settled, _negative(restraint.margin), full_rank=True)


def strongly_accessible(restraint: Restraint) -> Finding:
    """Whether some motion leaves all contacts at once: the interior of A is not empty (2-21; Table 2).

    Returns:
        yes with a motion that leaves every contact; no with weights that balance for every branch, so that leaving one
        of the contacts means entering another; or undecided. The margin is -s.
    """
    settled = restraint.interior
    return restraint.finding(Answer.of(settled.truth), settled, _negative(restraint.margin), full_rank=False)


def _negative(margin: float | None) -> float | None:
    return None if margin is None else 0.0 - margin
