"""Accessibility and detachability (thesis 2.3 (b), 2.6 (b)): can the part get out, and can it leave everything at once?

Accessible: A holds a displacement other than o (2-20), which is the negation of form closure where nothing has
clearance. Strongly accessible: the interior of A is not empty (2-21), so that the part leaves all contacts together
instead of sliding along some, which may jam. The interior of a union is non-empty if and only if that of one of its
cones is (2-51).

Both are asked with clearances open: a pin fills its hole at nominal, and no motion along it would leave it; a real one
has clearance. Such contacts do not count here, so that a part on pins may be form closed and accessible.
"""

from __future__ import annotations

import numpy as np

from fixture_design.analysis.restraint import Restraint
from fixture_design.layout import Answer, Finding, Motion


def accessible(restraint: Restraint) -> Finding:
    """Whether some motion is admissible: A != {o}  (2-20), clearances open.

    Returns:
        yes with a motion, no with the weights of form closure, or undecided; margin -s.
    """
    opened = restraint.opened
    if opened is None:
        return _free(restraint)
    settled = opened.closed
    return opened.finding(Answer.of(settled.truth).negated(), settled, _negative(opened.margin), full_rank=True)


def strongly_accessible(restraint: Restraint) -> Finding:
    """Whether some motion leaves all contacts at once: the interior of A is not empty (2-21; Table 2).

    Returns:
        yes with a motion that leaves every contact; no with weights that balance for every branch, so that leaving one
        of the contacts means entering another; or undecided. The margin is -s.
    """
    opened = restraint.opened
    if opened is None:
        return _free(restraint)
    settled = opened.interior
    return opened.finding(Answer.of(settled.truth), settled, _negative(opened.margin), full_rank=False)


def _free(restraint: Restraint) -> Finding:
    """No contact counts: any motion leaves all, and s = -1 as for no rows (`bounds_of`)."""
    motion = np.eye(restraint.contacts[0].dimension)[0]
    return Finding(Answer.YES, 1.0, Motion(motion, -1.0), -1.0)


def _negative(margin: float | None) -> float | None:
    return None if margin is None else 0.0 - margin
