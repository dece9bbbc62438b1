"""What carries a tip: a stem and a body behind it, along the surface's outward normal at the contact.

One set of sizes for whoever needs them: the search, which leaves out elements that would cut the part or each other,
and the URDF export, which writes them.
"""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.layout.layout import LineTip, PadTip, PinTip, SoftTip, SphereTip, Tip

#: Radius of a point's ball, length of a stem, radius and length of a body, as parts of half the diagonal of the part's
#: box [-].
_BALL, _LENGTH, _BODY_RADIUS, _BODY_LENGTH = 0.02, 0.2, 0.06, 0.12
#: A stem's radius next to its ball's [-].
_SLIM = 0.8
#: How far a pin reaches beyond where it locates, and where its stem begins behind that, by its diameter [-].
PIN_REACH, _PIN_END = 0.25, 0.02


@dataclass(frozen=True)
class StemSizes:
    """Sizes that someone chose [m]; None for what fits a part of this size."""

    radius: float | None = None
    length: float | None = None
    body_radius: float | None = None
    body_length: float | None = None


@dataclass(frozen=True)
class Column:
    """A piece of a stem: a cylinder around the normal, from one height above the contact to another [m]."""

    low: float
    high: float
    radius: float


@dataclass(frozen=True)
class Stem:
    """A tip's height and what stands on it.

    Attributes:
        tip: radius of the ball at the contact [m]: the stem begins in its middle.
        flat: the tip is a plate of thickness ``tip`` in place of a ball: the stem begins on it.
        radius, length: of the stem.  body_radius, body_length: of the body behind it [m].
    """

    tip: float
    radius: float
    length: float
    body_radius: float
    body_length: float
    flat: bool = False

    @property
    def columns(self) -> tuple[Column, Column]:
        """Stem and body, nearest to the part first."""
        shoulder = self.tip + self.length
        return Column(self.tip, shoulder, self.radius), Column(shoulder, shoulder + self.body_length, self.body_radius)


def pin_stem(tip: PinTip, size: float) -> Stem:
    """Of a pin: itself, behind where it locates, and a body; along the axis, away from the pin's end.

    Args:
        size: half the diagonal of the part's box [m].
    """
    return Stem(
        tip=_PIN_END * tip.diameter,
        radius=tip.diameter / 2,
        length=max(_LENGTH * size, 2 * tip.diameter),
        body_radius=max(_BODY_RADIUS * size, tip.diameter),
        body_length=_BODY_LENGTH * size,
        flat=True,
    )


def stem_of(tip: Tip, size: float, sizes: StemSizes | None = None) -> Stem:
    """The stem of an element with this tip.

    Args:
        size: half the diagonal of the part's box [m].  sizes: those that are given.
    """
    sizes = sizes or StemSizes()
    ball = tip.radius if isinstance(tip, SphereTip | SoftTip) else None
    radius = sizes.radius or _SLIM * (ball or _BALL * size)
    return Stem(
        tip=ball or radius / _SLIM,
        radius=radius,
        length=sizes.length or _LENGTH * size,
        body_radius=sizes.body_radius or max(_BODY_RADIUS * size, radius),
        body_length=sizes.body_length or _BODY_LENGTH * size,
        flat=isinstance(tip, PadTip | LineTip),
    )
