"""The layouts that `fixture-design grasp` writes: with what the part's own layout says, and refused ones marked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.layout import Answer, Layout, Load

if TYPE_CHECKING:
    from fixture_design.grasp import Grasp, GraspResult

#: The name that the load of `--load` gets in a layout.
ASKED = "asked for"


def carried(result: GraspResult, given: Layout, load: np.ndarray | None) -> GraspResult:
    """The result with gravity and loads of the part's layout, and the load that was asked for, in its layouts."""
    grasps = tuple(replace(grasp, layout=_carried(grasp, given, load)) for grasp in result.grasps)
    return replace(result, grasps=grasps, notes=(*result.notes, *_left_out(given, grasps)))


def _carried(grasp: Grasp, given: Layout, load: np.ndarray | None) -> Layout:
    loads = given.loads
    if load is not None:
        names, name = {one.name for one in loads}, ASKED
        while name in names:
            name += "'"
        loads = (*loads, Load(name, grasp.center, load[:3], load[3:]))
    return replace(grasp.layout, gravity=given.gravity, loads=loads)


def _left_out(given: Layout, grasps: tuple[Grasp, ...]) -> Iterator[str]:
    """What of the part's layout has no say."""
    if given.source is None:
        return
    if given.loads or given.gravity is not None:
        both = {"gravity": given.gravity is not None, "loads": bool(given.loads)}
        what = " and ".join(name for name, there in both.items() if there)
        yield f"the grasp's layout takes over {what}, with no say in whether it holds: --load asks for that"
    frictions = {grasp.layout.friction for grasp in grasps}
    if given.friction and frictions and frictions != {given.friction}:
        theirs = ", ".join(f"{friction:g}" for friction in sorted(frictions))
        yield f"the layout's friction {given.friction:g} is left out: the hand's is {theirs}"
    if given.elements or given.bodies or given.contacts:
        yield "elements, bodies and contacts of the layout are left out: neither do they hold, nor are they in the way"


def written(result: GraspResult) -> Layout:
    """The layout of the best grasp; of one that is refused with the reason in its name, and nothing required: that its
    contacts close is true, and is not what was asked.
    """
    layout = result.grasps[0].layout
    if result.satisfied is Answer.YES:
        return layout
    told = "no grasp" if result.satisfied is Answer.NO else "undecided"
    reason = result.reason or "its contacts do not close"
    return replace(layout, name=f"{layout.name} - {told}: {reason}", require={})
