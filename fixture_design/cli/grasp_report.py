"""What a search for grasps found, in words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.cli.messages import printable
from fixture_design.io.pose_angles import roll_pitch_yaw
from fixture_design.layout import Answer

if TYPE_CHECKING:
    from fixture_design.grasp import Grasp, GraspResult, Posture
    from fixture_design.grasp.weakest import Weakest

#: Regions told before it says "and so many more".
_REGIONS = 8

#: Digits with which positions can be typed again: well below what fingers touch within.
_DIGITS = 10


def grasps_in_words(result: GraspResult) -> Iterator[str]:
    """Line by line: the answer, the regions, each grasp, and what there is to note."""
    closed = sum(grasp.closed is Answer.YES for grasp in result.grasps)
    yield printable({
        Answer.YES: f"closed: {closed} grasp{'s' if closed != 1 else ''}, the best first",
        Answer.NO: f"not closed: {result.reason or 'these contacts do not close'}",
        Answer.UNDECIDED: f"undecided: {result.reason or 'see the verdict'}",
    }[result.satisfied])  # fmt: skip
    if result.regions:
        yield "faces that see each other:"
        for region in result.regions[:_REGIONS]:
            low, high = (f"{width * 1000:.4g}" for width in region.width)
            wide = f"{low} mm" if low == high else f"{low} to {high} mm"
            yield printable(f"  {region.features[0]} and {region.features[1]}, {wide} apart: {region.outcome}")
        if len(result.regions) > _REGIONS:
            yield f"  and {len(result.regions) - _REGIONS} more"
    for number, grasp in enumerate(result.grasps, start=1):
        yield from map(printable, _grasp(number, grasp))
    yield from (printable(f"note: {note}") for note in result.notes)


def _grasp(number: int, grasp: Grasp) -> Iterator[str]:
    on = f" on {', '.join(grasp.features)}" if grasp.features else ""
    also = f", counting {', '.join(grasp.others)} besides the fingertips" if grasp.others else ""
    yield f"{number}. {grasp.posture.model.name}{on}: force closed {grasp.closed}{also}"
    if grasp.doubt is not None:
        yield f"   undecided: {grasp.doubt}"
    xyz = ", ".join(f"{value * 1000:.2f}" for value in grasp.posture.X_WH.translation)
    yield f"   hand at ({xyz}) mm; " + ", ".join(f"{n} {v:.4g}" for n, v in grasp.posture.positions().items())
    yield f"   as options: {as_options(grasp.posture)}"
    epsilon = "not computed" if grasp.quality.epsilon is None else f"{grasp.quality.epsilon:.3g}"
    robust = "" if grasp.robust is None else f", closed at {grasp.robust:.0%} of pose errors"
    yield f"   least weight {grasp.quality.least_weight:.3g}, epsilon {epsilon}{robust}"
    if grasp.weakest is not None:
        yield f"   {_strength(grasp.weakest, grasp.closed)}"
    if grasp.held is not None:
        torques = ", ".join(f"{name} {value:.3g}" for name, value in grasp.held.torques.items())
        yield f"   holds the load with {torques} (N m, or N of joints that slide)"
    yield from (f"   note: {note}" for note in grasp.notes)


def _strength(weakest: Weakest, closed: Answer) -> str:
    """What is held in the worst direction; where it is not closed, that this goes for forces alone."""
    alone = "; these are forces alone: not all moments are held" if closed is Answer.NO else ""
    if not np.isfinite(weakest.force):
        return f"holds any force, as its drives have no limit{alone}"
    way = ", ".join(f"{value + 0.0:.2f}" for value in weakest.direction)
    force = f"at least {weakest.force:.3g} N" if weakest.force > 0 else "no force"
    return f"holds {force} in the worst direction ({way}){alone}"


def as_options(posture: Posture) -> str:
    """The hand's place as the command takes it: joints that follow others go without saying."""
    model = posture.model
    joints = (f"--joint {model.joints[k].name}={posture.q[k] + 0.0:.{_DIGITS}g}" for k in model.free.tolist())
    pose = [*posture.X_WH.translation, *roll_pitch_yaw(posture.X_WH)]
    # with "=", as the first number may begin with a minus
    return " ".join([*joints, "--pose=" + ",".join(f"{value + 0.0:.{_DIGITS}g}" for value in pose)])
