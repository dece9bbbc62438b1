"""Errors of all features in one branch of the locators: what they locate, on which seats, and how well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.locating_rows import LocatingRows
from fixture_design.analysis.over_location import rockings
from fixture_design.analysis.resting import Resting, resting
from fixture_design.analysis.seat_errors import Displaced, SeatErrors, displaced, seat_errors, slack
from fixture_design.analysis.seats import Seats, seats_of
from fixture_design.arrays import Point, Rows, Vector, Weights
from fixture_design.contacts import motion_about_origin, unit_normal
from fixture_design.layout import FeatureError, KeyFeature, Rocking
from fixture_design.tolerances import SEATED, Tolerances


@dataclass(frozen=True, eq=False)
class Blurred:
    """Nothing can be said: the rank, or what depends on what, is not certain."""

    reason: str


@dataclass(frozen=True, eq=False)
class BranchAccuracy:
    """One branch.

    Attributes:
        features: in file order; ``worst`` is inf for those in ``free``.
        slack: what the normals' errors may add to each [m].
        pose: about the reference; None where the part is not located.
        assumed: whether the part was taken to rest on as many elements as it can.
        free: a motion that no contact notices and that moves the feature, by its index.
        shared: names of the elements that some feature depends on, by its index.
    """

    rows: LocatingRows
    features: tuple[FeatureError, ...]
    slack: tuple[float, ...]
    pose: Vector | None
    rockings: tuple[Rocking, ...]
    complete: bool
    assumed: bool
    free: dict[int, Vector]
    shared: tuple[frozenset[str], ...]


def branch_accuracy(
    rows: LocatingRows,
    features: tuple[KeyFeature, ...],
    pressing: Vector | None,
    reference: Point,
    tolerances: Tolerances,
) -> BranchAccuracy | Blurred:
    """Errors of the features in one branch; ``pressing``: [f; m] about W's origin or None."""
    tolerances = tolerances.at_offset(rows.scale.offset)
    seats = seats_of(rows.rows, tolerances)
    if seats is None:
        return Blurred("the contacts' smallest singular value is neither zero nor clear of it")
    whole = len(seats.basis) == rows.rows.shape[1]
    if float(np.linalg.norm(rows.doubt)) > (SEATED if whole else 0.0) and (seats.groups or not whole):
        return Blurred("the contacts depend on each other, up to what their normals may be off")
    units = [unit_normal(feature.direction) for feature in features]
    targets = np.array([rows.target(f.point, unit) for f, unit in zip(features, units, strict=True)])
    free = _free(targets, seats, rows, tolerances)
    if free is None:
        return Blurred("a feature's motion along what is not located is neither zero nor clear of it")
    rest = resting(rows.rows, rows.owner, rows.both, seats, _scaled(pressing, rows), tolerances)
    kept = rest.kept
    wanted = np.vstack([targets, _pose_targets(rows, reference)]) if whole else targets
    errors = seat_errors(rows, seats, wanted, tolerances)
    spare = np.where(kept[:, None], slack(rows, seats, errors), 0.0).max(axis=0)
    if not np.isfinite(spare).all():
        return Blurred("the contacts' smallest singular value is not clear of what the normals may be off")
    case = _Case(rows, seats, rest, errors, spare, tolerances)
    found = tuple(
        case.free(feature, unit) if k in free else case.feature(k, feature, unit)
        for k, (feature, unit) in enumerate(zip(features, units, strict=True))
    )
    return BranchAccuracy(
        rows=rows,
        features=found,
        slack=tuple(spare[: len(features)].tolist()),
        pose=np.where(kept[:, None], errors.bound, 0.0).max(axis=0)[len(features) :] if whole else None,
        rockings=rockings(rows, seats, tolerances) if seats.groups else (),
        complete=seats.complete,
        assumed=rest.assumed,
        free=free,
        shared=tuple(case.shared(k) for k in range(len(features))),
    )


def _free(targets: Rows, seats: Seats, rows: LocatingRows, tolerances: Tolerances) -> dict[int, Vector] | None:
    """Features with a part outside the span of the rows, as the motion [dx; dtheta] about W's origin that shows it."""
    if len(seats.basis) == targets.shape[1]:
        return {}
    outside = targets - (targets @ seats.basis.T) @ seats.basis
    sizes = np.linalg.norm(outside, axis=1) / np.linalg.norm(targets, axis=1)
    if np.any((sizes > tolerances.zero) & (sizes <= tolerances.near)):
        return None
    scale = rows.scale
    return {
        k: motion_about_origin(outside[k] / np.linalg.norm(outside[k]), scale.reference, scale.length)
        for k in np.flatnonzero(sizes > tolerances.near).tolist()
    }


def _scaled(wrench: Vector | None, rows: LocatingRows) -> Vector | None:
    """A wrench about W's origin in the rows' coordinates: moments about their reference, over their length."""
    if wrench is None:
        return None
    force, plane = wrench[: rows.normals.shape[1]], rows.normals.shape[1]
    moved = rows.target(np.zeros(plane), force)
    moved[plane:] += wrench[plane:] / rows.scale.length
    return moved


def _pose_targets(rows: LocatingRows, reference: Point) -> Rows:
    """Rows of the displacement's coordinates about the reference: velocities there, then rotations."""
    plane = len(reference)
    moves = [rows.target(reference, axis) for axis in np.eye(plane)]
    turns = np.eye(rows.rows.shape[1])[plane:] / rows.scale.length
    return np.vstack([moves, turns])


@dataclass(frozen=True, eq=False)
class _Case:
    """What the records of single features are made from."""

    rows: LocatingRows
    seats: Seats
    rest: Resting
    errors: SeatErrors
    slack: Weights
    tolerances: Tolerances

    def free(self, feature: KeyFeature, unit: Point) -> FeatureError:
        return FeatureError(feature.name, feature.tolerance, np.inf, np.inf, np.inf, {}, (), feature.point, unit)

    def feature(self, k: int, feature: KeyFeature, unit: Point) -> FeatureError:
        bounds = self.errors.bound[:, k]
        worst = int(np.argmax(np.where(self.rest.kept, bounds, -np.inf)))
        source = int(self.errors.source[worst, k])
        weights = self.errors.weights[source, k]
        shares = self.rows.shares(weights)
        members = sorted({*self.seats.members[source].tolist(), *np.flatnonzero(weights).tolist()})
        least = self._least(bounds)
        found = self._displaced(k, feature.tolerance, least)
        seat = self.seats.members[worst if found is None else found.seat]
        return FeatureError(
            feature=feature.name,
            tolerance=feature.tolerance,
            worst=float(bounds[worst]),
            least=least,
            rss=float(np.linalg.norm(shares)),
            shares=dict(zip(self.rows.elements, shares.tolist(), strict=True)),
            seat=self.rows.names(seat),
            point=feature.point,
            direction=unit,
            rows=tuple(self.rows.places[row] for row in members),
            weights=tuple(weights[members].tolist()),
            displacement=None if found is None else self._in_world(found.motion),
            moves=None if found is None else found.moves,
        )

    def _least(self, bounds: Weights) -> float:
        """The least over the sets of elements that the part may rest on of the largest bound on each."""
        if len(bounds) == 1:
            return float(bounds[0])
        _, sets = np.unique(self.rest.elements[self.rest.kept], axis=0, return_inverse=True)
        largest = np.zeros(int(sets.max()) + 1)
        np.maximum.at(largest, sets.ravel(), bounds[self.rest.kept])
        # one error and not two that differ by rounding
        least, worst = float(largest.min()), float(largest.max())
        return worst if least >= worst * (1 - self.tolerances.tie) else least

    def _displaced(self, k: int, tolerance: float, least: float) -> Displaced | None:
        """Only for what may be refused: where what presses the part is known, or every seat's bound is too large."""
        beyond = tolerance * (1 + self.tolerances.tie) + float(self.slack[k])
        if least <= beyond and not self.rest.pressed:
            return None
        near = self.tolerances.near
        return displaced(self.rows, self.seats, self.rest.kept, self.errors, k, beyond, near)

    def _in_world(self, motion: Weights) -> Vector:
        return motion_about_origin(motion, self.rows.scale.reference, self.rows.scale.length)

    def shared(self, k: int) -> frozenset[str]:
        """Elements whose contacts have weight in the feature on some seat, whatever their errors are."""
        weights = self.errors.weights[self.rest.kept, k]
        some = np.any(np.abs(weights) > self.tolerances.zero * np.abs(weights).max(initial=0.0), axis=0)
        return frozenset(self.rows.elements[e] for e in self.rows.owner[some].tolist())
