"""Hybrid position/force sets of a part that is grasped, placed, or both, for a controller (thesis 2.3 (d))."""

from __future__ import annotations

from fixture_design.analysis import HybridControl, hybrid_control
from fixture_design.cones import ConeUnion
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.layout import Layout
from fixture_design.verification import verify


def hybrid_sets(layout: Layout, group: str = "all") -> HybridControl:
    """What a controller may command of a part: motions that a group of contacts admits, and forces that it can take.

    Of a part in the hand that touches its surroundings the surroundings are the group: the hand moves the part as they
    admit, and presses it against them as they can push back. Motions are [dx; dtheta] and forces [f; m] about W's
    origin, without friction; `commanded_pair` gives the nearest command to a wish.

    Args:
        layout: of contacts, elements or both.  group: "locators", "all", or the name of a stage.

    Raises:
        UnknownNameError: there is no such group.
        InputError: it has no contacts, or too many for its sets to be listed.

    Example:
        >>> import fixture_design as fd                                      # doctest: +SKIP
        >>> control = hybrid_sets(fd.read_layout("peg_on_table.yaml"), "locators")
        >>> dq, p = commanded_pair(control, [0.01, 0, -0.01, 0, 0, 0], [0, 0, -5, 0, 0, 0])
        >>> dq                                          # it slides, and does not move into the table
        array([0.01, 0.  , 0.  , 0.  , 0.  , 0.  ])
    """
    verdict = verify(layout)
    if group not in verdict.groups:
        raise UnknownNameError("group", group, verdict.groups, source=layout.source)
    displacements = verdict.groups[group].admissible_displacements
    if displacements is None:
        why = "it has no contacts" if not verdict.groups[group].contacts else "; ".join(verdict.notes)
        raise InputError(f"group {group!r} has no sets: {why}", source=layout.source)
    return hybrid_control(ConeUnion(displacements))
