"""Form closure (thesis 2.3 (a), 2.6 (a)): no displacement but o is admissible, whatever friction does.

A = A_1 u ... u A_N = {o} if and only if every A_n is (2-48; Table 1). One branch closes if and only if its face vectors
have full rank and balance with weights that are all positive: the rank test is half of the answer.
"""

from __future__ import annotations

from fixture_design.analysis.restraint import Restraint
from fixture_design.layout import Answer, Finding


def form_closure(restraint: Restraint) -> Finding:
    """Whether the contacts' normals alone hold the part: A = {o}  (2-19).

    Returns:
        yes with weights for every branch that needs its own; no with a motion of A; undecided with a reason. The margin
        is s: positive if closed, negative if something leaves all contacts, zero for a tie.

    Example:
        >>> from fixture_design.contacts import Contact
        >>> form_closure(Restraint.of([Contact.on_facet("P1", "locator", [1, 1], [0, 1])])).answer.value
        'no'
    """
    settled = restraint.closed
    return restraint.finding(Answer.of(settled.truth), settled, restraint.margin, full_rank=True)
