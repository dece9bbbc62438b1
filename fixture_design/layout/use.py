"""What the fixture does to the part, as evidence: errors of place, forces that balance, motions that nothing resists,
straight ways out. Each can be confirmed without the solver that found it.

A contact with normal n pushes the part with f = -N n + t, N >= 0, t across n; with friction |t| <= friction N (soft
tips: and a moment about n). All wrenches are [f; m] on the part, about W's origin, in newtons and metres.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from fixture_design.arrays import Point, Points, Rows, Vector
from fixture_design.layout.answer import Answer


@dataclass(frozen=True, eq=False)
class FeatureError:
    """How far a key feature may be off along its direction [m].

    Attributes:
        feature: its name.  tolerance: allowed.
        worst: the largest error, all elements at the ends of their tolerances, over all seats the part may take.
        least: the largest error in the best of these seats; ``worst`` where there is only one.
        rss: root sum square of the elements' shares, in the worst seat.
        shares: for each element its part of ``worst``, >= 0; they add up to it.
        seat: names of the contacts that the part sits on in the worst case.
    """

    feature: str
    tolerance: float
    worst: float
    least: float
    rss: float
    shares: Mapping[str, float]
    seat: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Rocking:
    """Contacts that locate more often than once: the part rests on some of them and rocks.

    Attributes:
        contacts: that depend on each other.
        motion: [dx; dtheta] about W's origin, from one seat to the other under the errors below.
        size: by how much the contacts' points are off at most when it rocks [m], under the tolerances and form error.
    """

    contacts: tuple[str, ...]
    motion: Vector
    size: float


@dataclass(frozen=True, eq=False)
class LocatingErrors:
    """Evidence for `accurate`.

    Attributes:
        features: one a key feature, in file order.
        pose: largest error of each coordinate of the displacement, about ``reference`` [m, rad], shape (d,).
        reference: in W [m].
        errors: what each element's contacts may be off along their normals [m]: tolerance, half the clearance, form.
        costliest: the element whose error costs most of the feature that uses most of its tolerance; None without.
        rockings: where the part is located more than once.
        motion: where it is not located at all, a motion that no locator notices; else None.
        complete: whether all seats were looked at; if not, ``worst`` is only the largest that was seen.
    """

    features: tuple[FeatureError, ...]
    pose: Vector | None
    reference: Point
    errors: Mapping[str, float]
    costliest: str | None
    rockings: tuple[Rocking, ...] = ()
    motion: Vector | None = None
    complete: bool = True


@dataclass(frozen=True, eq=False)
class ContactForce:
    """What a contact does to the part: one force a normal, clause after clause.

    Attributes:
        forces: shape (k, p) [N], in W, on the part.
        moments: shape (k,), about each unit normal, of soft tips [N m]; zeros otherwise.
    """

    forces: Points
    moments: Vector


@dataclass(frozen=True, eq=False)
class Balance:
    """Contact forces that balance ``wrench``; ``residual`` [-] is what is left, relative to the largest term."""

    wrench: Vector
    forces: Mapping[str, ContactForce]
    residual: float


@dataclass(frozen=True, eq=False)
class Unbalanced:
    """A motion q that proves that no contact forces balance ``wrench``.

    For all forces that the contacts may have, wrench . q exceeds what they take back: wrench . q - R(q) = ``surplus``
    > 0, R(q) the sum of N (n . v + friction |[v_t; c w_n]|) over clamps with N their preload. For all other contacts
    that bracket is <= 0, so that they resist nothing.
    """

    wrench: Vector
    motion: Vector
    surplus: float


@dataclass(frozen=True, eq=False)
class LoadVerdict:
    """Whether one load is held, with gravity and the clamps' preloads.

    Attributes:
        load: its name; "no load" for gravity and preloads alone.  row: of a load path, counted from 1; else None.
        answer: whether a balance exists at factor 1.
        reserve: (lower, upper) bound of the largest factor on the load that can be held; inf where nothing limits it;
            None where it is not held at any factor.
        needed: the smallest factor that can be held; 0 where the load is not needed to hold the part.
        proof: at factor 1.
        first: contacts that slip or lift first beyond the reserve, with what they do.
        reason: why it is undecided.
    """

    load: str
    row: int | None
    answer: Answer
    reserve: tuple[float, float] | None
    needed: float
    proof: Balance | Unbalanced | None
    first: tuple[tuple[str, Literal["slips", "lifts"]], ...] = ()
    reason: str | None = None


def severity(load: LoadVerdict) -> tuple[int, float]:
    """For sorting, the worst first: those that fail, those undecided, then by their reserve."""
    order = (Answer.NO, Answer.UNDECIDED, Answer.YES).index(load.answer)
    return order, load.reserve[0] if load.reserve else 0.0


@dataclass(frozen=True, eq=False)
class LoadsHeld:
    """Evidence for `holds_loads`.

    Attributes:
        loads: one a load, and one a point of a load path, in file order.
        worst: index into ``loads`` of the one with the least reserve, or that fails.
        preloads: for each contact that pushes with a given force, that force [N].
        least_preloads: for each clamp the preload of the smallest set (by sum) that holds everything [N], within its
            limits; None where no preloads do, or there is no clamp whose preload may be chosen.
        determinate: whether friction leaves the reactions determined (or a stiffness makes them so).
        stiff: at the worst load, the reactions for the contact stiffness given; None without.
    """

    loads: tuple[LoadVerdict, ...]
    worst: int
    preloads: Mapping[str, float]
    least_preloads: Mapping[str, float] | None = None
    determinate: bool = True
    stiff: Mapping[str, ContactForce] | None = None


@dataclass(frozen=True, eq=False)
class SeatingStep:
    """One step of closing the fixture.

    Attributes:
        clamp: the one just closed; None for gravity alone.
        answer: whether every locator is pressed.
        reactions: for each locator (least, largest) normal force over all balances [N], summed over its normals.
        idle: locators that nothing presses.  lifted: locators that the part leaves: no balance has them pressed.
        proof: that a balance exists, or that none does.
        cause: the clamp that unseats, and why, in words; None where nothing does.
    """

    clamp: str | None
    answer: Answer
    reactions: Mapping[str, tuple[float, float]]
    idle: tuple[str, ...]
    lifted: tuple[str, ...]
    proof: Balance | Unbalanced | None
    cause: str | None = None


@dataclass(frozen=True, eq=False)
class Seating:
    """Evidence for `seated`: the steps in order, and the force each clamp in a step pushes with [N]."""

    steps: tuple[SeatingStep, ...]
    preloads: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Obstacle:
    """What is in the way: an element or body, after how much of the way [m], at which point in W."""

    name: str
    after: float
    point: Point


@dataclass(frozen=True, eq=False)
class StraightWays:
    """Evidence for `loadable`: the straight directions in which the part leaves the contacts.

    Attributes:
        contacts: that were asked to let it out; ``open``: contacts that were not, since they are open then (clamps,
            supports, pins with clearance).
        spans, lines: generators of the cone of directions in W, shapes (k, p); together empty where there is none.
        direction: the best of them, of length one; None where there is none.
        leaving: the least -n . direction over the contacts' unit normals; 0 where it slides along some [-].
        slides: contacts that it slides along.
        length: of the way that was looked at [m]; None where there is no geometry to look at.
        against: elements and bodies it was checked against.
        obstacle: the first thing in the best of the ways, where every way tried is blocked.
        weights: where there is no direction at all, weights >= 0 on unit normals, one a normal, that say so.
    """

    contacts: tuple[str, ...]
    open: tuple[str, ...]
    spans: Rows
    lines: Rows
    direction: Point | None
    leaving: float
    slides: tuple[str, ...] = ()
    length: float | None = None
    against: tuple[str, ...] = ()
    obstacle: Obstacle | None = None
    weights: Mapping[str, tuple[float, ...]] | None = None
