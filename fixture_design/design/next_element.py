"""One element more: what a layout needs next, and where it is best.

As long as the locators notice fewer motions than they can, another locator: the candidate that is furthest from what
they notice already, among those that still let the part out in a straight line. Then a clamp: the candidate that stops
most of the motions that are free (`adding`); where none are, the one with which the margin of closure is largest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Point, Rows, Vector, read_only
from fixture_design.cones.kernel import closure_tests
from fixture_design.contacts import Role
from fixture_design.design.adding import added
from fixture_design.design.candidates import Candidates, Several, flat
from fixture_design.design.clamping import margins
from fixture_design.design.drawing_up import fresh_names
from fixture_design.design.plans import by_certainty
from fixture_design.design.start import elements_of
from fixture_design.design.steps import in_world
from fixture_design.design.task import CandidateRules
from fixture_design.design.ways import Ways
from fixture_design.errors import GeometryError
from fixture_design.layout import Layout
from fixture_design.tolerances import DEFAULT


@dataclass(frozen=True, eq=False)
class NextElement:
    """Where one element more is best.

    Attributes:
        name: that nobody has.  at: p_W [m].  feature: what it touches.
        why: it notices a motion that no locator noticed, stops one that was free, or makes the margin larger.
        motion: that motion [dx; dtheta], about W's origin; None for the margin.
    """

    name: str
    role: Role
    at: Point
    feature: str
    why: Literal["unnoticed", "free", "margin"]
    motion: Vector | None = None


def next_element(layout: Layout, ways: Ways, role: Role | None = None, seed: int = 0) -> NextElement:
    """The element that a layout needs next, at its best place.

    Args:
        role: by default a locator as long as the locators do not locate, then a clamp.

    Raises:
        GeometryError: there is no candidate left.
    """
    some = next(by_certainty(Candidates.of(ways.spots(CandidateRules(), seed), ways.scale(), layout.friction)))
    here = elements_of(layout, ways)
    everything = some.with_elements(here)
    touched = [point for _, contacts in here for point in (contact.point for contact in contacts)]
    pool = _free(everything, len(some), np.array(touched))
    if not len(pool):
        raise GeometryError("every candidate is taken", expected="fewer elements")
    numbers = np.arange(len(some), len(everything))
    locators = np.array([number for number, (e, _) in zip(numbers, here, strict=True) if e.role == "locator"], np.int64)
    if role in (None, "locator"):
        found = _locator(everything, locators, pool)
        if found is not None or role == "locator":
            index, motion = (_widest(everything.rows, numbers, pool), None) if found is None else found
            return _named(layout, everything, index, "locator", motion, "margin" if found is None else "unnoticed")
    index, motion = _clamp(everything, numbers, pool)
    return _named(layout, everything, index, role or "clamp", motion, "margin" if motion is None else "free")


def _free(candidates: Candidates, count: int, touched: np.ndarray) -> Indices:
    """Candidates where no element stands already."""
    pool = np.arange(count)
    if not len(touched):
        return pool
    away = np.linalg.norm(candidates.places[:count, None] - touched[None], axis=2).min(axis=1)
    return pool[away > DEFAULT.near * candidates.scale.length]


def _locator(candidates: Candidates, locators: Indices, pool: Indices) -> tuple[int, Vector] | None:
    """The candidate that notices most of what no locator notices yet, with that motion; None where nothing is left."""
    rows = candidates.rows
    noticed = np.linalg.svd(flat(rows, locators), full_matrices=True)
    rank = int((noticed[1] > candidates.tolerances.near).sum()) if len(locators) else 0
    if rank >= candidates.freedoms:
        return None
    unnoticed = noticed[2][rank:] if len(locators) else np.eye(candidates.dimension)
    inside = rows[pool, 0] @ unnoticed.T
    gains = np.linalg.norm(inside, axis=1)
    for allowed in _letting_out(candidates, locators, pool):
        gained = np.where(allowed, gains, 0.0)
        best = int(np.argmax(gained))
        if gained[best] > candidates.tolerances.near:
            return int(pool[best]), inside[best] / gains[best] @ unnoticed
    return None


def _letting_out(candidates: Candidates, locators: Indices, pool: Indices) -> Iterator[np.ndarray]:
    """Which of a pool let the part out with the locators: in a straight line; in any way; and all of them."""
    p = candidates.points.shape[2]
    straight = candidates.rows.copy()
    straight[..., p:] = 0.0
    lengths = np.linalg.norm(straight, axis=2, keepdims=True)
    straight = np.divide(straight, lengths, out=np.zeros_like(straight), where=lengths > 0)
    for rows in (straight, candidates.rows):
        yield _leaves(rows, locators, pool)
    yield np.ones(len(pool), dtype=bool)


def _leaves(rows: Several, locators: Indices, pool: Indices) -> np.ndarray:
    each = rows.shape[1]
    sets = np.column_stack([np.broadcast_to(locators, (len(pool), len(locators))), pool])
    places = (sets[:, :, None] * each + np.arange(each)).reshape(len(sets), -1)
    offsets = np.arange(len(sets) + 1) * places.shape[1]
    flat_rows: Rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[2]))
    return closure_tests(flat_rows, offsets, np.ascontiguousarray(places.ravel())).leaves == 1


def _clamp(candidates: Candidates, here: Indices, pool: Indices) -> tuple[int, Vector | None]:
    """The candidate that stops most, without friction and, where nothing more can be stopped so, with it."""
    for rows in (candidates.rows, candidates.rows_with_friction):
        record = added(rows, here, pool)
        if record:
            return record[0]
        if len(here) and margins(rows, here[None])[0] > DEFAULT.near:
            break
    return _widest(rows, here, pool), None


def _widest(rows: Several, here: Indices, pool: Indices) -> int:
    """The candidate with which the margin of closure is largest."""
    sets = np.column_stack([np.broadcast_to(here, (len(pool), len(here))), pool])
    return int(pool[int(np.argmax(margins(rows, sets)))])


def _named(
    layout: Layout,
    candidates: Candidates,
    index: int,
    role: Role,
    motion: Vector | None,
    why: Literal["unnoticed", "free", "margin"],
) -> NextElement:
    taken = {each.name for each in (*layout.elements, *layout.bodies, *layout.contacts)}
    name = next(fresh_names({"locator": "L", "clamp": "K", "support": "S", "finger": "F"}[role], taken))
    at = read_only(candidates.places[index])
    world = None if motion is None else in_world(motion, candidates.scale)
    return NextElement(name, role, at, candidates.features[index], why, world)
