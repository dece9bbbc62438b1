"""What makes `LocatingErrors` a proof: weights that make each feature's row, shares that follow from them, all seats.

Taken from the evidence are what contacts do not tell: how far each element and the surface may be off, the features
with their tolerances, and what presses the part. Everything else is worked out again.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

import numpy as np

from fixture_design.analysis.locating_rows import MAX_BRANCHES
from fixture_design.arrays import Vector
from fixture_design.contacts import Contact, motion_scaled, unit_normal
from fixture_design.layout import Answer, FeatureError, Finding, LocatingErrors, element_name
from fixture_design.tolerances import DEFAULT, SEATED
from fixture_design.verification.proofs import Case
from fixture_design.verification.seats_again import (
    BranchAgain,
    SeatsAgain,
    bounds_again,
    branches_again,
    kept_again,
    seats_again,
    target_again,
)

#: Errors that differ by less than this, relative to the larger one, are the same [-]: seats are up to 1e-8 near to
#: dependent, and lose as many digits.
SAME_ERROR = 1e-6


def accuracy_fault(finding: Finding, contacts: Sequence[Contact]) -> str | None:
    """What is wrong with an answer to `accurate`; None if nothing is."""
    evidence = finding.use
    if not isinstance(evidence, LocatingErrors):
        return "it needs locating errors as evidence"
    locators = [contact for contact in contacts if contact.role == "locator"]
    fault = _numbers_fault(evidence, locators)
    if fault is not None:
        return fault
    if evidence.motion is not None:
        return _motion_fault(evidence, locators) if finding.answer is Answer.NO else "a free motion proves nothing else"
    if not locators:
        return "without locators nothing is located"
    case = Case(locators, locators[0].dimension)
    if prod(case.alternatives.values()) > MAX_BRANCHES:
        return "there are too many choices of alternatives to look at all of them"
    found = _all_branches(evidence, case)
    if isinstance(found, str):
        return found
    for k, feature in enumerate(evidence.features):
        fault = _feature_fault(feature, evidence, case) or _extent_fault(feature, found[k], _tiny(evidence, case))
        if fault is not None:
            return f"{feature.feature}: {fault}"
    return (
        _answer_fault(finding.answer, evidence, found, case)
        or _costliest_fault(evidence)
        or _rockings_fault(evidence, case)
    )


def _numbers_fault(evidence: LocatingErrors, locators: Sequence[Contact]) -> str | None:
    """Sizes that must be there, finite and not negative."""
    if not evidence.features:
        return "there are no features"
    if not evidence.complete:
        return "not all seats were looked at"
    missing = {element_name(contact.name) for contact in locators} - set(evidence.errors)
    if missing:
        return f"the errors of {', '.join(sorted(missing))} are missing"
    sizes = [evidence.form, *evidence.errors.values(), *(feature.tolerance for feature in evidence.features)]
    if not all(np.isfinite(size) and size >= 0 for size in sizes):
        return "an error or a tolerance is no length"
    units = [float(np.linalg.norm(feature.direction)) for feature in evidence.features]
    return None if np.allclose(units, 1.0, rtol=0, atol=SAME_ERROR) else "a direction is not of length one"


def _tiny(evidence: LocatingErrors, case: Case) -> float:
    """Errors up to this are what rounding leaves of zero [m]."""
    return case.limit * (max(evidence.errors.values()) + evidence.form)


def _motion_fault(evidence: LocatingErrors, locators: Sequence[Contact]) -> str | None:
    """A motion that no contact notices, in some branch, and that moves a feature along its direction."""
    motion, plane = evidence.motion, len(evidence.features[0].point)
    if motion is None or motion.shape != (3 if plane == 2 else 6,) or not np.isfinite(motion).all() or not motion.any():
        return "the motion is no motion"
    if not locators:
        return None if _moves(evidence, motion, np.zeros(plane), 1.0) else "the motion moves no feature"
    case = Case(locators, locators[0].dimension)
    scaled = motion_scaled(motion, case.scale.reference, case.scale.length)
    scaled = scaled / np.linalg.norm(scaled)
    for contact in locators:
        if contact.provenance.normal_error:
            return f"the normal of {contact.name} may be off: it could notice the motion"
        for clause in contact.clauses:
            rows = np.vstack([case.rows(contact, unit_normal(normal)[None]) for normal in clause])
            if np.abs(rows @ scaled).min() > case.limit:
                return f"{contact.name} notices the motion"
    moved = _moves(evidence, motion, case.scale.reference, case.scale.length)
    return None if moved else "the motion moves no feature"


def _moves(evidence: LocatingErrors, motion: Vector, reference: np.ndarray, length: float) -> bool:
    """Whether it moves some feature along its direction, clear of zero."""
    scaled = motion_scaled(motion, reference, length)
    for feature in evidence.features:
        lever = np.linalg.norm(feature.point - reference) / length
        along = feature.direction @ _velocity(motion, feature.point)
        if abs(along) > DEFAULT.near * np.linalg.norm(scaled) * np.hypot(1.0, lever):
            return True
    return False


def _velocity(motion: Vector, point: np.ndarray) -> np.ndarray:
    """What a motion moves a point by: the velocity of a point taken as the reference."""
    return motion_scaled(motion, point, 1.0)[: len(point)]


class _Extent:
    """Over all branches: the largest and the smallest bound of a target, and what normals may add."""

    def __init__(self) -> None:
        self.worst, self.least, self.slack = 0.0, np.inf, 0.0

    def add(self, bounds: np.ndarray, slack: np.ndarray, elements: Sequence[frozenset[str]]) -> None:
        """Of the seats of one branch, each with the elements that it rests on."""
        self.worst = max(self.worst, float(bounds.max()))
        largest: dict[frozenset[str], float] = {}
        for bound, rests_on in zip(bounds.tolist(), elements, strict=True):
            largest[rests_on] = max(largest.get(rests_on, 0.0), bound)
        self.least = min(self.least, *largest.values())
        self.slack = max(self.slack, float(slack.max()))


def _all_branches(evidence: LocatingErrors, case: Case) -> list[_Extent] | str:
    """The extents of all features, then of the coordinates of the pose, or why the seats are not known."""
    targets = [target_again(case, feature.point, feature.direction) for feature in evidence.features]
    if evidence.pose is not None:
        plane = len(evidence.reference)
        targets += [target_again(case, evidence.reference, axis) for axis in np.eye(plane)]
        targets += list(np.eye(case.dimension)[plane:] / case.scale.length)
        if evidence.pose.shape != (case.dimension,):
            return "the pose has another number of coordinates"
    wanted, extents = np.array(targets), [_Extent() for _ in targets]
    for branch in branches_again(case):
        seats = seats_again(branch)
        if isinstance(seats, str):
            return seats
        outside = np.linalg.norm(wanted - wanted @ seats.basis.T @ seats.basis, axis=1)
        if np.any(outside > branch.near * np.linalg.norm(wanted, axis=1)):
            return "a feature moves along what is not located"
        whole, over = len(seats.basis) == case.dimension, len(branch.rows) > len(seats.basis)
        if np.linalg.norm(branch.doubt) > (SEATED if whole else 0.0) and (over or not whole):
            return "the contacts depend on each other, up to what their normals may be off"
        kept, _ = kept_again(branch, seats, _scaled(evidence.pressing, case))
        weights = branch.lightest(seats.weights(wanted, len(branch.rows)), evidence.errors, evidence.form)
        left = np.abs(weights @ branch.rows - wanted).max()
        if left > SAME_ERROR * max(float(np.abs(weights).max()), float(np.abs(wanted).max())):
            return "the weights of the seats do not make the features' rows"
        own = branch.shares(weights, evidence.errors, evidence.form).sum(axis=-1)
        bounds, slack = bounds_again(branch, seats, weights, own), _slack(branch, seats, weights, evidence)
        elements = [on for on, keep in zip(branch.touched(seats), kept.tolist(), strict=True) if keep]
        for k, extent in enumerate(extents):
            extent.add(bounds[kept, k], slack[kept, k], elements)
    return extents


def _scaled(wrench: Vector | None, case: Case) -> Vector | None:
    if wrench is None:
        return None
    plane = len(case.scale.reference)
    lever = target_again(case, np.zeros(plane), np.array(wrench[:plane])) if np.any(wrench[:plane]) else 0.0
    return lever + np.concatenate([np.zeros(plane), wrench[plane:] / case.scale.length])


def _slack(branch: BranchAgain, seats: SeatsAgain, weights: np.ndarray, evidence: LocatingErrors) -> np.ndarray:
    """What the normals' errors may add to the bounds, shape (n, k): see `analysis.seat_errors.slack`."""
    if not branch.doubt.any():
        return np.zeros(weights.shape[:2])
    moved = np.array([evidence.errors[owner] for owner in branch.owners]) + evidence.form
    found = np.zeros(weights.shape[:2])
    for seat, members in enumerate(seats.members):
        ratio = float(np.linalg.norm(branch.doubt[members])) / seats.smallest[seat]
        for k, c in enumerate(weights[seat][:, members]):
            change = ratio / (1 - ratio) * np.linalg.norm(c) if ratio < 1 else np.inf
            found[seat, k] = ((change + (np.abs(c) + change) * branch.tilt[members]) * moved[members]).sum()
    return found


def _feature_fault(feature: FeatureError, evidence: LocatingErrors, case: Case) -> str | None:
    """Weights that do not make the feature's row, or shares that do not follow from them."""
    if len(feature.rows) != len(feature.weights) or not np.isfinite(feature.weights).all():
        return "it needs one weight a row"
    for branch in branches_again(case):
        if not set(feature.rows) <= set(branch.places):
            continue
        weights = np.zeros(len(branch.rows))
        weights[[branch.places.index(row) for row in feature.rows]] = feature.weights
        target = target_again(case, feature.point, feature.direction)
        left = np.linalg.norm(weights @ branch.rows - target)
        if left > case.limit * max(np.abs(weights).max(), np.linalg.norm(target)):
            return "the weights do not make the feature's row"
        shares = branch.shares(weights, evidence.errors, evidence.form)
        found = dict(zip(branch.elements, shares.tolist(), strict=True))
        return _shares_fault(feature, found, _tiny(evidence, case))
    return "the rows are not those of one choice of alternatives"


def _shares_fault(feature: FeatureError, found: dict[str, float], tiny: float) -> str | None:
    """Stated shares, their sum and their root sum square."""
    limit = SAME_ERROR * sum(found.values()) + tiny
    if set(feature.shares) != set(found):
        return "the shares are not those of its elements"
    wrong = [name for name, share in found.items() if not abs(feature.shares[name] - share) <= limit]
    if wrong:
        return f"the share of {wrong[0]} is {found[wrong[0]]:.3e}, not {feature.shares[wrong[0]]:.3e}"
    if not abs(sum(found.values()) - feature.worst) <= limit:
        return "the shares do not add up to the worst error"
    root = float(np.linalg.norm(list(found.values())))
    return None if abs(root - feature.rss) <= limit else f"the root sum square is {root:.3e}, not {feature.rss:.3e}"


def _extent_fault(feature: FeatureError, extent: _Extent, tiny: float) -> str | None:
    limit = SAME_ERROR * extent.worst + tiny
    if not abs(feature.worst - extent.worst) <= limit:
        return f"the worst over all seats is {extent.worst:.3e}, not {feature.worst:.3e}"
    if not abs(feature.least - extent.least) <= limit:
        return f"the least over all seats is {extent.least:.3e}, not {feature.least:.3e}"
    return None


def _answer_fault(
    answer: Answer | None, evidence: LocatingErrors, extents: Sequence[_Extent], case: Case
) -> str | None:
    """Whether the extents say what the answer says."""
    count = len(evidence.features)
    pose = [] if evidence.pose is None else evidence.pose.tolist()
    # metres, then radians
    tiny = _tiny(evidence, case) * max(1.0, 1.0 / case.scale.length)
    for stated, extent in zip(pose, extents[count:], strict=True):
        if not abs(stated - extent.worst) <= SAME_ERROR * extent.worst + tiny:
            return f"an error of the pose is {extent.worst:.3e}, not {stated:.3e}"
    pairs = list(zip(evidence.features, extents, strict=False))
    if answer is Answer.YES:
        over = [f.feature for f, extent in pairs if extent.worst + extent.slack >= f.tolerance]
        return f"{over[0]} may be off by more than its tolerance" if over else None
    faults = [_displacement_fault(f, extent, evidence, case) for f, extent in pairs if f.displacement is not None]
    if None in faults:
        return None
    return faults[0] if faults else "no feature has a displacement that shows an error beyond its tolerance"


def _displacement_fault(feature: FeatureError, extent: _Extent, evidence: LocatingErrors, case: Case) -> str | None:
    """Whether the part may be displaced so: at rest on a seat, into no element, off beyond the tolerance."""
    if feature.displacement is None or feature.moves is None:
        return "there is no displacement that shows the error"
    motion = feature.displacement
    if motion.shape != (case.dimension,) or not np.isfinite(motion).all():
        return "the displacement is none"
    if not abs(feature.direction @ _velocity(motion, feature.point)) - extent.slack > feature.tolerance:
        return "the displacement's error is within the tolerance"
    everywhere = extent.least - extent.slack > feature.tolerance
    faults = [_rest_fault(branch, feature, motion, everywhere, evidence, case) for branch in branches_again(case)]
    return None if None in faults else faults[0]


def _rest_fault(
    branch: BranchAgain,
    feature: FeatureError,
    motion: Vector,
    everywhere: bool,
    evidence: LocatingErrors,
    case: Case,
) -> str | None:
    """Whether d_i . q <= n_i . u + form for all rows of a branch, nearly with equality on a seat that carries.

    ``everywhere``: the bounds of all seats are beyond the tolerance, so that it need not be known what presses.
    """
    scaled, moves = motion_scaled(motion, case.scale.reference, case.scale.length), feature.moves or {}
    tiny = SAME_ERROR * max(float(np.abs(scaled).max()), *evidence.errors.values(), evidence.form)
    touching = []
    for row, normal, owner, both in zip(branch.rows, branch.normals, branch.owners, branch.both, strict=True):
        move = moves.get(owner)
        walls = branch.walls(owner)
        if move is None or move.shape != normal.shape:
            return f"the move of {owner} is missing"
        if not np.linalg.norm(move) <= evidence.errors[owner] + evidence.form * walls + tiny:
            return f"the move of {owner} is beyond its error"
        form = 0.0 if walls else evidence.form
        gap = float(normal @ move - row @ scaled)
        if not -form - tiny <= gap or (both and not gap <= form + tiny):
            return f"the part would enter {owner}"
        touching.append(gap <= form + tiny)
    seats = seats_again(branch)
    assert not isinstance(seats, str), seats
    kept, pressed = kept_again(branch, seats, _scaled(evidence.pressing, case))
    if not (pressed or everywhere):
        return "what presses the part is not known, and on some seat it is within the tolerance"
    on = [all(touching[i] for i in members) for members in seats.members[kept].tolist()]
    return None if any(on) else "the displaced part rests on no seat"


def _costliest_fault(evidence: LocatingErrors) -> str | None:
    """The element named has the largest share of some feature that uses most of its tolerance, up to ties."""
    used = [feature for feature in evidence.features if max(feature.shares.values(), default=0.0) > 0]
    if not used or evidence.costliest is None:
        return None if not used and evidence.costliest is None else "the costliest element is not that of the shares"
    most = max(_used(feature) for feature in used)
    for feature in used:
        if not _used(feature) < most * (1 - SAME_ERROR):
            largest = max(feature.shares.values())
            if feature.shares.get(evidence.costliest, 0.0) >= largest * (1 - SAME_ERROR):
                return None
    return f"{evidence.costliest} is not the costliest element"


def _used(feature: FeatureError) -> float:
    return feature.worst / feature.tolerance if feature.tolerance else np.inf


def _rockings_fault(evidence: LocatingErrors, case: Case) -> str | None:
    """Rocking contacts must depend on each other, and the motion must leave all but two at least where they are."""
    for rocking in evidence.rockings:
        members = [contact for contact in case.contacts if contact.name in rocking.contacts]
        names = ", ".join(rocking.contacts)
        if len(members) != len(rocking.contacts):
            return f"some of {names} are no locators"
        rows = np.vstack([case.rows(c, unit_normal(n)[None]) for c in members for n in c.normals])
        if np.linalg.matrix_rank(rows, tol=SEATED) == len(rows):
            return f"{names} do not depend on each other"
        moved = np.abs(rows @ motion_scaled(rocking.motion, case.scale.reference, case.scale.length))
        if not np.any(np.abs(moved - rocking.size) <= SAME_ERROR * rocking.size):
            return f"the motion between the seats on {names} moves none of them by {rocking.size:.3e}"
    return None
