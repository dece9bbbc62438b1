"""A motion over time: there and back, slow at both ends."""

from __future__ import annotations

import numpy as np

from fixture_design.layout import Pose
from fixture_design.viewing.scene import Animation

#: Rest between two rounds of a motion [s].
_REST = 0.5


def rounds(animation: Animation) -> list[tuple[float, Pose]]:
    """Times [s] and motions of one round: there and back, and as far the other way where that is free too.

    Slow at both ends: the amount is (1 - cos(pi t / T)) / 2.
    """
    count = len(animation.poses) - 1
    amounts = np.arange(count + 1) / count
    times = animation.seconds * np.arccos(1 - 2 * amounts) / np.pi
    ways = [animation.poses, tuple(pose.inverse() for pose in animation.poses)][: 2 if animation.both_ways else 1]
    found: list[tuple[float, Pose]] = []
    start = 0.0
    for poses in ways:
        found += [(start + float(time), pose) for time, pose in zip(times, poses, strict=True)]
        back = start + 2 * animation.seconds
        found += [(back - float(time), pose) for time, pose in zip(times[-2::-1], poses[-2::-1], strict=True)]
        start = back + _REST
        found.append((start, poses[0]))
    return list({round(time, 6): (time, pose) for time, pose in found}.values())
