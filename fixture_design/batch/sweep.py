"""Variants of a layout: how far part, elements and friction may be from what the layout says.

`sweep` names largest deviations. With ``samples`` each variant draws every coordinate evenly between minus and plus
that; without, the variants are a grid of minus, none and plus in every coordinate. Variant k depends on the seed and on
k alone, so that any of them may be made first, or again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.contacts import Contact
from fixture_design.errors import InputError
from fixture_design.layout import Layout, Part, Pose

#: Places of a coordinate on a grid: minus, none, plus.
_LEVELS = 3
#: A grid of more variants than this is a mistake.
MOST_VARIANTS = 1_000_000


@dataclass(frozen=True)
class _Ranges:
    """What a sweep varies: numbers of coordinates, and how far each may be off.

    Attributes:
        pose: shape (k,), of the part's translation [m] and rotation [rad], one zero where it stays.
        at: [m], of each coordinate of each place.
        places: how many places there are.
        friction: smallest and largest coefficient.
    """

    pose: Vector
    at: float
    places: int
    friction: tuple[float, float] | None

    @property
    def plane(self) -> int:
        return 2 if len(self.pose) == 3 else 3

    @property
    def varied(self) -> np.ndarray:
        """Which of the numbers of a variant vary: pose, then the places, then friction."""
        moved = np.full(self.places * self.plane, self.at > 0)
        rubs = self.friction is not None and self.friction[0] < self.friction[1]
        return np.concatenate([self.pose > 0, moved, [rubs]])


def variant_count(layout: Layout) -> int:
    """How many variants a layout's sweep has.

    Raises:
        InputError: a grid of too many, or a deviation of something that the layout has not.
    """
    ranges, samples = _ranges(layout), _setting(layout, "samples")
    if samples is not None:
        return int(samples)
    coordinates = int(ranges.varied.sum())
    if _LEVELS**coordinates > MOST_VARIANTS:
        raise InputError(
            f"the sweep is a grid of {_LEVELS}^{coordinates} variants, three for each coordinate that varies",
            source=layout.source, place="sweep", expected="samples: ..., a number of random variants",
        )  # fmt: skip
    return _LEVELS**coordinates


def is_sampled(layout: Layout) -> bool:
    """Whether the variants are random samples, so that their share that holds has a confidence interval."""
    return _setting(layout, "samples") is not None


def variant_of(layout: Layout, number: int) -> Layout:
    """The ``number``-th variant of a layout's sweep, counted from 0.

    An element that was moved off the surface still counts as touching, in the surface's point nearest to it: the
    variant's `surface_gap` is the layout's and as much as the variant moves an element against the part, at most.
    """
    off = deviations_of(layout, number)
    at = list(off.at.values())
    moved = replace(
        layout,
        part=_moved_part(layout.part, off.pose) if layout.part is not None and off.pose.any() else layout.part,
        elements=tuple(replace(e, at=e.at + a) for e, a in zip(layout.elements, at, strict=False)),
        contacts=tuple(
            replace(c, point=c.point + a) for c, a in zip(layout.contacts, at[len(layout.elements) :], strict=False)
        ),
    )
    moved = replace(moved, surface_gap=layout.surface_gap + _moved_by(layout, moved))
    return moved if off.friction is None else _with_friction(moved, off.friction)


@dataclass(frozen=True, eq=False)
class Deviations:
    """How far one variant is off.

    Attributes:
        pose: shape (k,), of the part's translation [m] and rotation [rad].
        at: by element and contact, shape (p,) [m].
        friction: the layout's coefficient in this variant; None where it is not swept.
    """

    pose: Vector
    at: dict[str, Point]
    friction: float | None

    def as_dict(self) -> dict[str, Any]:
        """Plain values; what does not vary is left out."""
        plane = 2 if len(self.pose) == 3 else 3
        data: dict[str, Any] = {}
        if self.pose.any():
            turn = float(self.pose[2]) if plane == 2 else self.pose[3:].tolist()
            keys = ("xy", "theta") if plane == 2 else ("xyz", "rpy")
            data["part_pose"] = dict(zip(keys, (self.pose[:plane].tolist(), turn), strict=True))
        if any(off.any() for off in self.at.values()):
            data["at"] = {name: off.tolist() for name, off in self.at.items()}
        return data if self.friction is None else data | {"friction": self.friction}


def deviations_of(layout: Layout, number: int) -> Deviations:
    """What the ``number``-th variant of a layout's sweep changes."""
    ranges = _ranges(layout)
    off = _deviations(ranges, layout, number)
    count = len(ranges.pose)
    at = off[count:-1].reshape(ranges.places, ranges.plane) * ranges.at
    names = [placed.name for placed in (*layout.elements, *layout.contacts)]
    friction = None
    if ranges.friction is not None:
        low, high = ranges.friction
        friction = low + (high - low) * (float(off[-1]) + 1) / 2
    return Deviations(off[:count] * ranges.pose, dict(zip(names, at, strict=True)), friction)


def _ranges(layout: Layout) -> _Ranges:
    planar = layout.space == "planar"
    given: Mapping[str, Any] = layout.sweep or {}
    pose = given.get("part_pose", {})
    if pose and layout.part is None:
        raise InputError("the sweep moves the part, and there is none", source=layout.source, place="sweep.part_pose")
    keys = (("xy", 2), ("theta", 1)) if planar else (("xyz", 3), ("rpy", 3))
    size = [np.abs(np.broadcast_to(np.asarray(pose.get(key, 0.0), dtype=np.float64), count)) for key, count in keys]
    friction = given.get("friction")
    limits = None if friction is None else (float(friction[0]), float(friction[1]))
    places = len(layout.elements) + len(layout.contacts)
    return _Ranges(np.concatenate(size), float(given.get("at", 0.0)), places, limits)


def _setting(layout: Layout, key: str) -> Any:
    return None if layout.sweep is None else layout.sweep.get(key)


def _deviations(ranges: _Ranges, layout: Layout, number: int) -> Vector:
    """For every number of a variant, how far it is off, between -1 and 1; 0 where it does not vary."""
    varied = ranges.varied
    off = np.zeros(len(varied))
    if is_sampled(layout):
        seed = int(_setting(layout, "seed") or 0)
        off[varied] = np.random.default_rng([seed, number]).uniform(-1.0, 1.0, size=int(varied.sum()))
        return off
    powers = _LEVELS ** np.arange(int(varied.sum()))
    off[varied] = number // powers % _LEVELS - 1.0
    return off


def _moved_part(part: Part, off: Vector) -> Part:
    """The part turned about its own origin and moved: small angles about W's axes, in URDF's order."""
    plane = len(part.pose.translation)
    turn = (
        Pose.from_xy_theta(np.zeros(2), float(off[2])) if plane == 2 else Pose.from_xyz_rpy(np.zeros(3), off[3:])
    ).rotation
    return replace(part, pose=Pose(turn @ part.pose.rotation, part.pose.translation + off[:plane]))


def _moved_by(layout: Layout, moved: Layout) -> float:
    """The longest way that an element has made against the part: |X'_WP X_PW at - at'| [m]."""
    if layout.part is None or moved.part is None or not layout.elements:
        return 0.0
    at = np.array([element.at for element in layout.elements])
    went_along = moved.part.pose.points(layout.part.pose.inverse().points(at))
    return float(np.linalg.norm(went_along - [element.at for element in moved.elements], axis=1).max())


def _with_friction(layout: Layout, friction: float) -> Layout:
    """All that takes the layout's coefficient takes this one; what has one of its own keeps it."""

    def rubbed(contact: Contact) -> Contact:
        own = contact.name in layout.own_friction or contact.friction != layout.friction
        return contact if own else replace(contact, friction=friction)

    return replace(layout, friction=friction, contacts=tuple(map(rubbed, layout.contacts)))
