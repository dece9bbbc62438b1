"""What the fixture does to the part, in words: errors at features, what unseats it, what a load does, the way out."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, isinf

import numpy as np

from fixture_design.arrays import Point
from fixture_design.errors import format_length
from fixture_design.layout import (
    Answer,
    FeatureError,
    LoadsHeld,
    LoadVerdict,
    LocatingErrors,
    Rocking,
    Seating,
    StraightWays,
    Unbalanced,
    UseEvidence,
)
from fixture_design.viewing.motion_words import direction_in_words, motion_in_words, place_in_words

#: Factors of a load below this are none [-].
_NOTHING = 1e-6

#: Names in one sentence before it says "and so many more".
_NAMES_SHOWN = 6


def use_in_words(evidence: UseEvidence, reference: Point, length: float) -> str:
    """One line for the evidence; ``reference`` and ``length`` as of the verdict [m]."""
    match evidence:
        case LocatingErrors():
            return _locating(evidence, reference, length)
        case LoadsHeld():
            return _loads(evidence, reference, length)
        case Seating():
            return _seating(evidence)
        case StraightWays():
            return _ways(evidence, length)


def names_in_words(names: Sequence[str]) -> str:
    """ "A, B and C", shortened where there are many."""
    shown = list(names)
    if len(shown) > _NAMES_SHOWN + 1:
        shown = [*shown[:_NAMES_SHOWN], f"{len(names) - _NAMES_SHOWN} more"]
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}" if shown else "nothing"


def _locating(evidence: LocatingErrors, reference: Point, length: float) -> str:
    if evidence.motion is not None:
        return f"not located: {motion_in_words(evidence.motion, reference, length)}"
    said = [feature_in_words(feature) for feature in evidence.features]
    if evidence.costliest is not None:
        said.append(f"{evidence.costliest} costs most")
    said += [rocking_in_words(rocking) for rocking in evidence.rockings]
    return "; ".join(said)


def feature_in_words(feature: FeatureError) -> str:
    """ "bore: up to 34 um of 50 um (root sum square 21 um)"; in the worst seat where there are several."""
    if isinf(feature.worst):
        return f"{feature.feature}: not located"
    among = "" if feature.least == feature.worst else f", {format_length(feature.least)} in the best seat"
    worst, allowed, rss = (format_length(value) for value in (feature.worst, feature.tolerance, feature.rss))
    return f"{feature.feature}: up to {worst} of {allowed}{among} (root sum square {rss})"


def rocking_in_words(rocking: Rocking) -> str:
    """Who locates more than once, and how far it rocks."""
    return f"over-located by {names_in_words(rocking.contacts)}, rocks by up to {format_length(rocking.size)}"


def _loads(evidence: LoadsHeld, reference: Point, length: float) -> str:
    return load_in_words(evidence.loads[evidence.worst], reference, length) + (
        "" if evidence.determinate else "; friction leaves the reactions undetermined"
    )


def load_in_words(load: LoadVerdict, reference: Point, length: float) -> str:
    """Whether it can be held, how many times, and what gives first."""
    name = load.load if load.row is None else f"{load.load}, row {load.row}"
    if load.answer is Answer.UNDECIDED:
        return f"{name}: {load.reason or 'undecided'}"
    if load.answer is Answer.NO:
        found = f"{name} cannot be held"
        if load.reserve is not None and 0 < load.reserve[1] < 1:
            found += f" (up to {load.reserve[0]:.3g} times it)"
        elif load.needed > 1 and isfinite(load.needed):
            found += f" (from {load.needed:.3g} times it)"
        if isinstance(load.proof, Unbalanced):
            found += f": it moves the part: {motion_in_words(load.proof.motion, reference, length)}"
        return found + _first(load)
    if not np.any(load.wrench):
        return f"{name}: gravity and preloads are balanced"
    return f"{name}: can hold {reserve_in_words(load)}{_first(load)}"


def reserve_in_words(load: LoadVerdict) -> str:
    """ "up to 1.52 times it", "any multiple of it", "0.4 to 1.5 times it"."""
    if load.reserve is None:
        return "it at no factor"
    low, high = load.reserve
    if isinf(low):
        most = "any multiple of it"
    elif isinf(high):
        most = f"at least {low:.3g} times it"
    else:
        most = f"up to {low:.4g} times it"
    return most if load.needed <= _NOTHING else f"{most}, and needs {load.needed:.3g} times it"


def _first(load: LoadVerdict) -> str:
    if not load.first:
        return ""
    by_kind = {kind: [name for name, what in load.first if what == kind] for kind in ("slips", "lifts")}
    said = [
        f"{names_in_words(names)} {kind if len(names) == 1 else kind[:-1]}" for kind, names in by_kind.items() if names
    ]
    return f"; then {', '.join(said)} first"


def _seating(evidence: Seating) -> str:
    causes = [step.cause for step in evidence.steps if step.cause and step.answer is Answer.NO]
    if causes:
        return "; ".join(causes)
    last = evidence.steps[-1]
    if last.idle:
        return f"nothing presses the part against {names_in_words(last.idle)}"
    return "pressed: " + ", ".join(f"{name} {_force(bounds)}" for name, bounds in last.reactions.items())


def _force(bounds: tuple[float, float]) -> str:
    """ "12 N", or a bracket; what has no upper bound says so."""
    low, high = bounds
    if isinf(high):
        return f"{low:.3g} N or more"
    return f"{low:.3g} N" if np.isclose(low, high, rtol=1e-3, atol=0) else f"{low:.3g} to {high:.3g} N"


def _ways(evidence: StraightWays, length: float) -> str:
    aside = f" ({names_in_words(evidence.open)} open)" if evidence.open else ""
    if evidence.direction is None:
        return "no straight way out" + aside
    along = direction_in_words(evidence.direction)
    if evidence.obstacle is not None:
        after, point = format_length(evidence.obstacle.after), place_in_words(evidence.obstacle.point, length)
        return f"along {along} it meets {evidence.obstacle.name} after {after}, at {point}{aside}"
    sliding = f", sliding along {names_in_words(evidence.slides)}" if evidence.slides else ""
    clear = "" if evidence.length is None else f", clear for {format_length(evidence.length)}"
    must = f"; {names_in_words(evidence.aside)} must be out of the way" if evidence.aside else ""
    return f"straight out along {along}{sliding}{clear}{aside}{must}"
