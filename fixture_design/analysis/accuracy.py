"""Accurate (locating errors): with every locator anywhere within its tolerance, no key feature is off by more than its
own.

The part rests where d_i . q = s_i, s_i the error of contact i (`locating_rows`). Located exactly once, q = D^-1 s, and
a feature with the row g = [direction; point X direction] is off by at most the sum of the elements' shares. Located
more than once, it rests on some of the contacts, a seat (`seats`), and which depends on the errors and on what presses
it: bounds are taken over all seats that can carry gravity and the clamps' preloads (`resting`). Elements that these do
not load are taken to touch as far as they can: a part with three pads under it is not left hanging on one edge of one
and a corner of the next. To first order: turns by small angles, and normals that stay.

yes: no seat lets any feature be off by more than its tolerance. no: a displacement that occurs has a feature off by
more, and either the seat that it rests on carries what presses the part, or that is not known and the bound is beyond
the tolerance on whatever elements the part rests; or a feature moves with a motion that no locator notices. A tie, or
seats that disagree, are undecided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from fixture_design.analysis.branch_accuracy import Blurred, BranchAccuracy, branch_accuracy
from fixture_design.analysis.locating_rows import MAX_BRANCHES, locating_branches
from fixture_design.analysis.normal_errors import blur
from fixture_design.analysis.pressing import pressing_wrench, weight_as_given
from fixture_design.arrays import Point, Vector
from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Answer, FeatureError, Finding, Group, Layout, LocatingErrors, Rocking, element_name
from fixture_design.tolerances import DEFAULT, SEATED, Tolerances

#: Elements named in one reason before it says "and so many more".
_NAMES_SHOWN = 5


def accurate(
    layout: Layout,
    group: Group,
    reference: Point,
    tolerances: Tolerances = DEFAULT,
    weight: Callable[[Layout], Vector | None] = weight_as_given,
) -> Finding:
    """Whether the group's locators place all key features within their tolerances.

    Args:
        reference: about which the errors of the pose are given, in W [m].
        weight: the wrench [f; m] of gravity about W's origin [N, N m], None where it is not known; asked only where the
            part is located more than once and gravity acts.

    Returns:
        a finding with `LocatingErrors` as its evidence; where nothing could be computed, undecided without.
    """
    locators = [contact for contact in group.contacts if contact.role == "locator"]
    if not layout.key_features:
        return _undecided("the layout has no key_features whose errors could be compared with their tolerances")
    form = None if layout.part is None else layout.part.form_error
    errors, unknown = element_errors(layout, locators)
    if not locators:
        return _nothing_locates(layout, group, reference)
    branches = locating_branches(locators, errors, form or 0.0, tolerances)
    if branches is None:
        return _undecided(f"the contacts have more than {MAX_BRANCHES} choices of alternatives")
    pressing = None
    if any(len(rows.rows) > np.linalg.matrix_rank(rows.rows, tol=SEATED) for rows in branches):
        known = weight(layout) if group.gravity and layout.gravity is not None else None
        pressing = pressing_wrench(layout, group, known)
    found: list[BranchAccuracy] = []
    for rows in branches:
        branch = branch_accuracy(rows, layout.key_features, pressing, reference, tolerances)
        if isinstance(branch, Blurred):
            return _undecided("; ".join(text for text in (branch.reason, blur(locators, tolerances)) if text))
        found.append(branch)
    evidence = _evidence(found, errors, form or 0.0, pressing, reference)
    unmeasured = () if form is not None else unknown
    answer, reasons = _answer(found, evidence, unmeasured, tolerances)
    if unmeasured and answer is not Answer.NO:
        reasons.append(f"no tolerance is given for {_list(unmeasured)}: taken as 0")
    if answer is not Answer.NO and any(branch.assumed for branch in found):
        reasons.append("elements that nothing known presses: the part is taken to rest on as many as it can")
    return Finding(answer, use=evidence, reason="; ".join(reasons) or None)


def element_errors(layout: Layout, contacts: Sequence[Contact]) -> tuple[dict[str, float], tuple[str, ...]]:
    """How far each element's position may be off [m]: tolerance and half the clearance; and those that give neither."""
    given = {element.name: element.tolerance for element in layout.elements}
    errors: dict[str, float] = {}
    for contact in contacts:
        name = element_name(contact.name)
        error = (given.get(name) or 0.0) + contact.clearance / 2
        errors[name] = max(errors.get(name, 0.0), error)
    return errors, tuple(name for name, error in errors.items() if not error and given.get(name) is None)


def _undecided(reason: str) -> Finding:
    return Finding(Answer.UNDECIDED, reason=reason)


def _nothing_locates(layout: Layout, group: Group, reference: Point) -> Finding:
    """No: without any locator every feature moves along its own direction."""
    features, plane = [], len(reference)
    for feature in layout.key_features:
        unit = unit_normal(feature.direction)
        features.append(
            FeatureError(feature.name, feature.tolerance, np.inf, np.inf, np.inf, {}, (), feature.point, unit)
        )
    motion = np.concatenate([features[0].direction, np.zeros(1 if plane == 2 else 3)])
    form = 0.0 if layout.part is None else layout.part.form_error or 0.0
    evidence = LocatingErrors(tuple(features), None, reference, {}, form, None, motion=motion)
    return Finding(Answer.NO, use=evidence, reason=f"group {group.name!r} has no locators")


def _evidence(
    branches: Sequence[BranchAccuracy],
    errors: Mapping[str, float],
    form: float,
    pressing: Vector | None,
    reference: Point,
) -> LocatingErrors:
    """All branches together: the part may rest in any of them."""
    features = tuple(_over_branches(column) for column in zip(*(branch.features for branch in branches), strict=True))
    poses = [branch.pose for branch in branches if branch.pose is not None]
    return LocatingErrors(
        features=features,
        pose=np.max(poses, axis=0) if len(poses) == len(branches) else None,
        reference=reference,
        errors=errors,
        form=form,
        costliest=_costliest(features),
        pressing=pressing,
        rockings=_different([rocking for branch in branches for rocking in branch.rockings]),
        motion=next((motion for branch in branches for motion in branch.free.values()), None),
        complete=all(branch.complete for branch in branches),
    )


def _over_branches(column: Sequence[FeatureError]) -> FeatureError:
    """The worst branch of one feature, with the least error of all and a displacement if any has one."""
    worst = max(column, key=lambda feature: feature.worst)
    least = min(feature.least for feature in column)
    shown = next((feature for feature in (worst, *column) if feature.displacement is not None), None)
    if shown is None:
        return replace(worst, least=least)
    return replace(worst, least=least, displacement=shown.displacement, moves=shown.moves, seat=shown.seat)


def _different(rockings: Sequence[Rocking]) -> tuple[Rocking, ...]:
    """The largest of those with the same contacts."""
    largest: dict[tuple[str, ...], Rocking] = {}
    for rocking in rockings:
        if rocking.contacts not in largest or rocking.size > largest[rocking.contacts].size:
            largest[rocking.contacts] = rocking
    return tuple(largest.values())


def _costliest(features: Sequence[FeatureError]) -> str | None:
    """The element with the largest share of the feature that uses most of its tolerance."""
    used = [f for f in features if f.shares and max(f.shares.values()) > 0]
    if not used:
        return None
    tightest = max(used, key=lambda feature: feature.worst / feature.tolerance if feature.tolerance else np.inf)
    return max(tightest.shares, key=lambda name: tightest.shares[name])


def _answer(
    branches: Sequence[BranchAccuracy], evidence: LocatingErrors, unknown: Sequence[str], tolerances: Tolerances
) -> tuple[Answer, list[str]]:
    """The answer over all features, and why it is undecided."""
    if evidence.motion is not None:
        loose = [feature.feature for feature in evidence.features if np.isinf(feature.worst)]
        return Answer.NO, [f"no locator notices a motion that moves {_list(loose)}"]
    answers, reasons = [], []
    for k, feature in enumerate(evidence.features):
        slack = max(branch.slack[k] for branch in branches)
        shared = frozenset[str]().union(*(branch.shared[k] for branch in branches))
        answer, reason = _feature_answer(feature, slack, evidence.complete, shared <= set(unknown), tolerances)
        answers.append(answer)
        if reason is not None:
            reasons.append(reason)
    if Answer.NO in answers:
        return Answer.NO, []
    return (Answer.UNDECIDED if Answer.UNDECIDED in answers else Answer.YES), reasons


def _feature_answer(
    feature: FeatureError, slack: float, complete: bool, unmeasured: bool, tolerances: Tolerances
) -> tuple[Answer, str | None]:
    """The answer about one feature; ``unmeasured``: of the elements that it depends on none gives an error."""
    allowed, name = feature.tolerance, feature.feature
    if unmeasured:
        return Answer.UNDECIDED, f"no tolerance, clearance or form error is given for what locates {name}"
    if not complete:
        return Answer.UNDECIDED, f"there are more seats than were looked at for {name}"
    if feature.worst + slack <= allowed * (1 - tolerances.tie):
        return Answer.YES, None
    if feature.displacement is not None:
        return Answer.NO, None
    if feature.worst <= allowed * (1 - tolerances.tie):
        return Answer.UNDECIDED, f"{name} is within its tolerance but for what the normals may be off"
    if feature.worst - slack <= allowed * (1 + tolerances.tie):
        return Answer.UNDECIDED, f"the error of {name} is just its tolerance"
    if feature.least <= allowed * (1 + tolerances.tie):
        seat = _list(feature.seat)
        return Answer.UNDECIDED, f"{name} is within its tolerance on some seats and not on {seat}; what presses decides"
    return Answer.UNDECIDED, f"the bound of {name} is beyond its tolerance, but no displacement was found that is"


def _list(names: Sequence[str]) -> str:
    shown = list(names[:_NAMES_SHOWN])
    if len(names) > _NAMES_SHOWN:
        shown.append(f"{len(names) - _NAMES_SHOWN} more")
    return ", ".join(shown)
