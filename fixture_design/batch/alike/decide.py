"""The questions about groups of contacts, for n layouts at a time, by the kernel's batches.

The same rows and the same tolerances as in `analysis`, where each question has its reasons; the bounds come from
`closure_tests`, which `analysis` asks first too. What does not clear them, or is near to where an answer changes, is
not decided here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.force_closure import EDGES
from fixture_design.arrays import Indices, Rows, Vector
from fixture_design.batch.alike.plan import QUESTIONS, GroupPlan, Plan
from fixture_design.cones.kernel import Closures, closure_tests
from fixture_design.contacts import Scale, edges_around, scaled_rows, tangents_towards, unit_normal
from fixture_design.tolerances import COINCIDENT, DEFAULT, FARTHEST, MOST_FRICTION, SUM_ROUNDING

#: Answers as numbers.
YES, NO, OPEN, NONE = 1, 0, -1, -2
#: Points further from the origin than this, in their own spread, have fewer digits: not for here [-].
_FAR = DEFAULT.tie / SUM_ROUNDING / 2
#: Edges of the friction cones in space that are tried here: those that `force_closure` begins with.
_EDGES = EDGES[0]
#: Numbers must clear the tolerances by this factor to be decided here: far more than the rounding by which sums of one
#: layout and of many may differ, so that what is nearer is answered by `verify`, whoever it is looked at with [-].
_CLEAR = 2.0
#: Normals that close by this much do so with friction too, up to the largest coefficient: it makes rows longer by at
#: most that, and s smaller by at most as much [-].
_CLOSE_WITH_FRICTION = 10 * MOST_FRICTION * DEFAULT.near


@dataclass(frozen=True, eq=False)
class Numbers:
    """The numbers of n layouts by their meaning.

    Attributes:
        points: shape (n, c, p) [m].  normals: unit, shape (n, k, p); given_normals: as they were given.
        frictions: shape (n, c).
        reference: shape (n, p), and length: shape (n,): the scale of the report [m].
        fit: shape (n,), whether they can be decided here at all.
    """

    points: np.ndarray
    normals: np.ndarray
    given_normals: np.ndarray
    frictions: np.ndarray
    reference: np.ndarray
    length: Vector
    fit: np.ndarray


@dataclass(frozen=True, eq=False)
class Decided:
    """The answers about one group of n layouts.

    Attributes:
        answers: shape (n, 5), one of YES, NO, OPEN for each of QUESTIONS; NONE throughout for an empty group.
        rows: unit, shape (n, b, r, d), in the contacts' own scale.  lengths: of the rows before, shape (n, b, r).
        reference, length: of that scale, shape (n, p) and (n,).
        closures: of the normals' rows, branch by branch; None for an empty group.
    """

    answers: np.ndarray
    rows: np.ndarray
    lengths: np.ndarray
    reference: np.ndarray
    length: Vector
    closures: Closures | None


def numbers_of(plan: Plan, given: np.ndarray, reports: Sequence[Scale] = ()) -> Numbers:
    """The numbers of n layouts, shape (n, h), as points, normals and coefficients.

    ``reports``: the scales of the reports, where they are not the contacts' own.
    """
    points = np.ascontiguousarray(given[:, plan.points])  # so that sums have the order that `scale_of` has
    units = plan.layout.units
    points = points / 1000 if units == "mm" else points * 0.0254 if units == "in" else points
    normals = given[:, plan.normals]
    frictions = np.where(plan.frictions < 0, 0.0, given[:, plan.frictions])
    with np.errstate(all="ignore"):
        largest = np.abs(normals).max(axis=2, keepdims=True)
        unit = unit_normal(normals)
        fit = np.isfinite(given).all(axis=1) & np.isfinite(unit).all(axis=(1, 2))
        fit &= (np.abs(points) <= FARTHEST).all(axis=(1, 2)) & (largest > 0).all(axis=(1, 2))
        coefficients = given[:, plan.coefficients]
        fit &= ((coefficients >= 0) & (coefficients <= MOST_FRICTION)).all(axis=1)
        reference, length, sound = _scale(points)
    if reports:
        reference = np.array([report.reference for report in reports])
        length = np.array([report.length for report in reports])
    fit &= sound & ~_coincide(points, length)
    return Numbers(points, unit, normals, frictions, reference, length, fit)


def decide(plan: Plan, group: GroupPlan, numbers: Numbers, *, witnesses: bool = False) -> Decided:
    """The five answers about one group of each layout."""
    count = len(numbers.points)
    if not len(group.contacts):
        none, answers = np.zeros((count, 0)), np.full((count, len(QUESTIONS)), NONE)
        return Decided(answers, none, none, none, np.zeros(count), None)
    with np.errstate(all="ignore"):
        reference, length, sound = _scale(np.ascontiguousarray(numbers.points[:, group.contacts]))
        levers = numbers.points - reference[:, None]
        rows = scaled_rows(levers[:, group.owners], numbers.normals[:, group.normals], length[:, None, None, None])
        lengths = np.linalg.norm(rows, axis=3)
        rows /= lengths[..., None]
        sound &= np.isfinite(rows).all(axis=(1, 2, 3)) & numbers.fit
    rows = np.where(sound[:, None, None, None], rows, 0.0)
    closures = _closures(rows, witnesses)
    closed, interior = _closed(closures, rows.shape[1]), _interior(closures, rows.shape[1])
    located = _located(rows)
    held = _held(group, numbers, levers, length, closed, closures, sound)
    answers = np.stack([located, _not(closed), np.where(closed == YES, NO, interior), closed, held], axis=1)
    answers[~sound] = OPEN
    return Decided(answers, rows, lengths, reference, length, closures)


def _scale(points: np.ndarray) -> tuple[np.ndarray, Vector, np.ndarray]:
    """`scale_of` of each layout, and whether it is a plain case: points that spread, not too far away."""
    reference = points.mean(axis=1)
    length = np.sqrt(np.mean(np.sum((points - reference[:, None]) ** 2, axis=2), axis=1))
    largest = np.abs(points).max(axis=(1, 2))
    return reference, length, (length > COINCIDENT * largest) & (np.linalg.norm(reference, axis=1) < _FAR * length)


def _coincide(points: np.ndarray, length: Vector) -> np.ndarray:
    """Whether two contacts of a layout may be in one place: `verify` has a note for those."""
    first, second = np.triu_indices(points.shape[1], 1)
    if not len(first):
        return np.zeros(len(points), dtype=bool)
    apart = np.abs(points[:, first] - points[:, second]).max(axis=2).min(axis=1)
    return ~(apart > DEFAULT.tie * length)


def _closures(rows: np.ndarray, witnesses: bool = False) -> Closures:
    """Closure tests of rows of shape (n, b, r, d), branch after branch."""
    flat: Rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]))
    offsets: Indices = np.arange(0, len(flat) + 1, rows.shape[2], dtype=np.int64)
    return closure_tests(flat, offsets, witnesses=witnesses, threads=1)


def _closed(closures: Closures, branches: int) -> np.ndarray:
    """Every branch closes: yes; a motion of one: no."""
    closes = (closures.lower > _CLEAR * DEFAULT.near).reshape(-1, branches)
    moves = (closures.upper <= DEFAULT.zero / _CLEAR).reshape(-1, branches)
    return np.where(closes.all(axis=1), YES, np.where(moves.any(axis=1), NO, OPEN))


def _interior(closures: Closures, branches: int) -> np.ndarray:
    """Some branch can be left: yes; none can: no."""
    leaves = (closures.upper < -_CLEAR * DEFAULT.near).reshape(-1, branches)
    stays = (closures.lower >= -DEFAULT.zero / _CLEAR).reshape(-1, branches)
    return np.where(leaves.any(axis=1), YES, np.where(stays.all(axis=1), NO, OPEN))


def _located(rows: np.ndarray) -> np.ndarray:
    """Every branch has full rank: yes; one certainly has not: no."""
    if rows.shape[2] < rows.shape[3]:
        return np.full(len(rows), NO)
    smallest = np.linalg.svd(rows, compute_uv=False)[..., -1]
    full, short = (smallest > _CLEAR * DEFAULT.near).all(axis=1), (smallest <= DEFAULT.zero / _CLEAR).any(axis=1)
    return np.where(full, YES, np.where(short, NO, OPEN))


def _not(answers: np.ndarray) -> np.ndarray:
    return np.where(answers == YES, NO, np.where(answers == NO, YES, OPEN))


def _held(
    group: GroupPlan,
    numbers: Numbers,
    levers: np.ndarray,
    length: Vector,
    closed: np.ndarray,
    closures: Closures,
    sound: np.ndarray,
) -> np.ndarray:
    """Force closure: where there is friction, of the cones' edges; no only with a motion that the cone allows."""
    rubs = (numbers.frictions[:, group.contacts] > 0) & sound[:, None]
    surely = closures.lower.reshape(len(closed), -1).min(axis=1) > _CLOSE_WITH_FRICTION
    asked = rubs.any(axis=1) & ~surely
    held = np.where(surely & sound, YES, closed)
    patterns, which = np.unique(rubs[asked], axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        some = np.flatnonzero(asked)[which.ravel() == number]
        held[some] = _held_by_edges(group, numbers, levers, length, pattern, some)
    return held


def _held_by_edges(
    group: GroupPlan, numbers: Numbers, levers: np.ndarray, length: Vector, rubs: np.ndarray, some: Indices
) -> np.ndarray:
    """Likewise of layouts in which the same contacts of a group rub; ``rubs``: shape (c,), of the group's contacts."""
    x, n = levers[some][:, group.owners], numbers.normals[some][:, group.normals]
    mu = numbers.frictions[some][:, group.owners]
    firsts = _firsts(group, numbers, some)
    rubbing = rubs[np.searchsorted(group.contacts, group.owners)]
    rows = []
    for branch in range(len(rubbing)):
        forces, at = [], []
        for row, edged in enumerate(rubbing[branch].tolist()):
            normal, reach = n[:, branch, row], mu[:, branch, row, None, None]
            first = None if firsts is None else firsts[:, group.normals[branch, row]]
            forces.append(_edges(normal, first, reach) if edged else normal[:, None])
            at.append(np.broadcast_to(x[:, branch, row, None], forces[-1].shape))
        rows.append(scaled_rows(np.concatenate(at, axis=1), np.concatenate(forces, axis=1), length[some, None, None]))
    edges = np.stack(rows, axis=1)
    edges /= np.linalg.norm(edges, axis=-1, keepdims=True)
    count, branches = edges.shape[:2]
    found = _closures(edges, witnesses=True)
    assert found.motions is not None
    motions = found.motions.reshape(count, branches, -1)
    every = (found.lower > _CLEAR * DEFAULT.near).reshape(count, branches).all(axis=1)
    free = _opposition(x / length[some, None, None, None], n, mu, motions) <= DEFAULT.zero / _CLEAR
    free &= (np.linalg.norm(motions, axis=2) > 0) & (found.upper.reshape(count, branches) <= DEFAULT.zero / _CLEAR)
    # with alternatives it may be another motion that `verify` asks the cones about
    return np.where(every, YES, np.where(free.all(axis=1) if branches == 1 else False, NO, OPEN))


def _firsts(group: GroupPlan, numbers: Numbers, some: Indices) -> np.ndarray | None:
    """Tangents of the first edges, as `first_tangents` has them, by the normals' places; None in the plane."""
    if numbers.points.shape[2] == 2:
        return None
    owners = dict(zip(group.normals.ravel().tolist(), group.owners.ravel().tolist(), strict=True))
    normals = np.array(sorted(owners), dtype=np.int64)
    places = np.searchsorted(group.contacts, [owners[normal] for normal in normals.tolist()])
    found = tangents_towards(
        numbers.points[some][:, group.contacts], numbers.reference[some], numbers.normals[some][:, normals], places
    )
    firsts = np.zeros_like(numbers.normals[some])
    firsts[:, normals] = found
    return firsts


def _edges(normal: np.ndarray, first: np.ndarray | None, reach: np.ndarray) -> np.ndarray:
    """`friction_edges` of n cones, shape (n, k, p)."""
    if first is not None:
        return edges_around(normal, first, reach, _EDGES)
    across = reach[:, 0] * np.stack([-normal[:, 1], normal[:, 0]], axis=-1)
    return np.stack([normal - across, normal + across], axis=1)


def _opposition(x: np.ndarray, n: np.ndarray, mu: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """max over contacts of n . v + mu |v_t|: the largest work that the branch's friction cones do against a motion."""
    plane = x.shape[-1]
    turning = motions[:, :, None, plane:]
    if plane == 2:
        spin = turning * np.stack([-x[..., 1], x[..., 0]], axis=-1)
    else:
        spin = np.cross(np.broadcast_to(turning, x.shape), x)
    velocities = motions[:, :, None, :plane] + spin
    along = np.sum(n * velocities, axis=-1)
    sliding = np.linalg.norm(velocities - along[..., None] * n, axis=-1)
    return (along + mu * sliding).max(axis=2)
