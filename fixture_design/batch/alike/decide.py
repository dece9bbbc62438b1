"""The questions about groups of contacts, for n layouts at a time, by the kernel's batches.

The same rows and the same tolerances as in `analysis`, where each question has its reasons; the bounds come from
`closure_tests`. What does not clear them is not decided here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Rows, Vector
from fixture_design.batch.alike.plan import QUESTIONS, GroupPlan, Plan
from fixture_design.cones.kernel import Closures, closure_tests
from fixture_design.contacts import Scale
from fixture_design.tolerances import COINCIDENT, DEFAULT, FARTHEST, MOST_FRICTION, SUM_ROUNDING

#: Answers as numbers.
YES, NO, OPEN, NONE = 1, 0, -1, -2
#: Points further from the origin than this, in their own spread, have fewer digits: not for here [-].
_FAR = DEFAULT.tie / SUM_ROUNDING / 2
#: Edges of the friction cones in space that are tried here.
_EDGES = 8


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
        unit = normals / largest
        unit /= np.linalg.norm(unit, axis=2, keepdims=True)
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
        reference, length, sound = _scale(numbers.points[:, group.contacts])
        levers = (numbers.points - reference[:, None]) / length[:, None, None]
        rows = rows_of(levers[:, group.owners], numbers.normals[:, group.normals])
        lengths = np.linalg.norm(rows, axis=3)
        rows /= lengths[..., None]
        sound &= np.isfinite(rows).all(axis=(1, 2, 3)) & numbers.fit
    rows = np.where(sound[:, None, None, None], rows, 0.0)
    closures = _closures(rows, witnesses)
    closed, interior = _closed(closures, rows.shape[1]), _interior(closures, rows.shape[1])
    located = _located(rows)
    held = _held(group, numbers, levers, closed, sound)
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


def rows_of(levers: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """[n; x X n] of levers and forces of shape (..., p)."""
    if levers.shape[-1] == 2:
        moments = levers[..., :1] * forces[..., 1:] - levers[..., 1:] * forces[..., :1]
    else:
        moments = np.cross(levers, forces)
    return np.concatenate([forces, moments], axis=-1)


def _closures(rows: np.ndarray, witnesses: bool = False) -> Closures:
    """Closure tests of rows of shape (n, b, r, d), branch after branch."""
    flat: Rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]))
    offsets: Indices = np.arange(0, len(flat) + 1, rows.shape[2], dtype=np.int64)
    return closure_tests(flat, offsets, witnesses=witnesses, threads=1)


def _closed(closures: Closures, branches: int) -> np.ndarray:
    """Every branch closes: yes; a motion of one: no."""
    found = closures.closes.reshape(-1, branches)
    return np.where((found == 1).all(axis=1), YES, np.where((found == 0).any(axis=1), NO, OPEN))


def _interior(closures: Closures, branches: int) -> np.ndarray:
    """Some branch can be left: yes; none can: no."""
    found = closures.leaves.reshape(-1, branches)
    return np.where((found == 1).any(axis=1), YES, np.where((found == 0).all(axis=1), NO, OPEN))


def _located(rows: np.ndarray) -> np.ndarray:
    """Every branch has full rank: yes; one certainly has not: no."""
    if rows.shape[2] < rows.shape[3]:
        return np.full(len(rows), NO)
    smallest = np.linalg.svd(rows, compute_uv=False)[..., -1]
    full, short = (smallest > DEFAULT.near).all(axis=1), (smallest <= DEFAULT.zero).any(axis=1)
    return np.where(full, YES, np.where(short, NO, OPEN))


def _not(answers: np.ndarray) -> np.ndarray:
    return np.where(answers == YES, NO, np.where(answers == NO, YES, OPEN))


def _held(group: GroupPlan, numbers: Numbers, levers: np.ndarray, closed: np.ndarray, sound: np.ndarray) -> np.ndarray:
    """Force closure: where there is friction, of the cones' edges; no only with a motion that the cone allows."""
    held = closed.copy()
    rubs = (numbers.frictions[:, group.contacts] > 0).any(axis=1) & sound & (closed != YES)
    held[(closed == YES) & sound] = YES  # friction takes nothing away
    if not rubs.any():
        return held
    x, n = levers[rubs][:, group.owners], numbers.normals[rubs][:, group.normals]
    mu = numbers.frictions[rubs][:, group.owners][..., None]
    edges = np.stack([n + mu * t for t in _tangents(n)], axis=-2)
    rows = rows_of(np.broadcast_to(x[..., None, :], edges.shape), edges)
    rows /= np.linalg.norm(rows, axis=-1, keepdims=True)
    count, branches = rows.shape[:2]
    found = _closures(rows.reshape(count, branches, -1, rows.shape[-1]), witnesses=True)
    motions = found.motions.reshape(count, branches, -1)  # type: ignore[union-attr]
    free = _opposition(x, n, mu[..., 0], motions) <= DEFAULT.zero
    free &= (np.linalg.norm(motions, axis=2) > 0) & (found.upper.reshape(count, branches) <= DEFAULT.zero)
    every = (found.closes.reshape(count, branches) == 1).all(axis=1)
    held[rubs] = np.where(every, YES, np.where(free.any(axis=1), NO, OPEN))
    return held


def _tangents(normals: np.ndarray) -> list[np.ndarray]:
    """Unit vectors across unit normals of shape (..., p): both in the plane, evenly around in space."""
    if normals.shape[-1] == 2:
        across = np.stack([-normals[..., 1], normals[..., 0]], axis=-1)
        return [across, -across]
    axis = np.eye(3)[np.argmin(np.abs(normals), axis=-1)]
    first = np.cross(normals, axis)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    second = np.cross(normals, first)
    angles = 2 * np.pi * np.arange(_EDGES) / _EDGES
    return [np.cos(angle) * first + np.sin(angle) * second for angle in angles]


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
