"""Jaws that could move on their own, but that real grippers couple: SDF files often leave the coupling out."""

from __future__ import annotations

from collections.abc import Sequence

from fixture_design.grasp.hand import Fingertip, Joint


def uncoupled_jaws(joints: Sequence[Joint], tips: Sequence[Fingertip]) -> str | None:
    """What there is to say about a gripper of two fingertips whose two joints slide, neither after the other."""
    free = [joint for joint in joints if joint.follows is None]
    if len(tips) != 2 or len(free) != 2 or {joint.kind for joint in free} != {"prismatic"}:
        return None
    one, other = (joint.name for joint in free)
    rule = f"joints: [{{name: {other}, follows: {one}, multiplier: ...}}]"
    return f"{one} and {other} are taken to move each on its own; if they are coupled, a hand file says so: {rule}"
