"""The tips that an element may be given where it stands, in a ring, in round sizes that fit the part."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.arrays import Point
from fixture_design.layout import LineTip, PadTip, PointTip, SoftTip, SphereTip, Tip

#: Size of a new tip in half diagonals of the part [-].
_TIP = 0.04

#: Leading digits of sizes that people choose.
_DIGITS = (1, 2, 5)


def tips_after(tip: Tip, length: float, along: Point) -> Iterator[Tip]:
    """The other kinds of tip: point, ball, pad, line, soft, and round again; in the plane point, ball, line.

    Args:
        length: half the part's diagonal [m].  along: a direction along the surface, in W, shape (2,) or (3,).
    """
    size = round_size(_TIP * length)
    kinds: list[Tip] = [PointTip(), SphereTip(size), PadTip(size, size, along), LineTip(size, along), SoftTip(size)]
    if len(along) == 2:
        kinds = [kinds[0], kinds[1], kinds[3]]
    here = next((number for number, kind in enumerate(kinds) if type(kind) is type(tip)), 0)
    yield from (*kinds[here + 1 :], *kinds[:here])


def round_size(length: float) -> float:
    """1, 2 or 5 times a power of ten, the largest below a length [m]."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(digit * power for digit in _DIGITS if digit == 1 or digit * power < length))
