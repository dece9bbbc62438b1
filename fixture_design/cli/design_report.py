"""A design in words: what was found, how it came about, and what is proven about it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.analysis.straight_ways import slid_along
from fixture_design.arrays import Point, Vector
from fixture_design.cli.messages import printable
from fixture_design.design import Bound, ChangeBound, DesignResult, Step
from fixture_design.layout import Answer, element_name
from fixture_design.tolerances import COPLANAR_ANGLE
from fixture_design.viewing.motion_words import motion_in_words

_OUTCOME = {
    Answer.YES: "the requirements hold",
    Answer.NO: "no layout of these candidates does what is asked",
    Answer.UNDECIDED: "undecided",
}

#: Errors of locators by which accuracy is told [m].
_OFF = 1e-5


def design_in_words(result: DesignResult) -> Iterator[str]:
    """Lines for a person."""
    reference, length = _view(result)
    for step in result.steps:
        yield printable(_step_in_words(step, reference, length))
    if result.free is not None:
        yield f"free whatever candidate touches the part: {motion_in_words(result.free, reference, length)}"
    if result.changes is not None and (result.changes.found > 0 or result.satisfied is Answer.YES):
        yield _changes_in_words(result.changes)
    if result.bound is not None:
        yield _bound_in_words(result.bound)
    if result.out is not None:
        yield _out_in_words(result, result.out)
    if result.accuracy is not None:
        yield _accuracy_in_words(result, result.accuracy, result.best_accuracy)
    if result.margin is not None:
        yield f"margin of closure {result.margin:.3g}"
    if result.preload is not None:
        yield _preload_in_words(result)
    seen = () if result.verdict is None else result.verdict.notes
    for note in dict.fromkeys((*result.notes, *seen)):
        yield printable(f"note: {note}")
    outcome = _OUTCOME[result.satisfied]
    yield printable(f"{outcome}: {result.reason}" if result.reason else outcome)


def _out_in_words(result: DesignResult, out: Point) -> str:
    """The way out, and what the part slides along on it."""
    words = f"the part comes out along [{', '.join(f'{x:.3g}' for x in np.round(out, 6) + 0.0)}]"
    locators = [c for c in (() if result.verdict is None else result.verdict.contacts) if c.role == "locator"]
    names = dict.fromkeys(map(element_name, slid_along(locators, out, COPLANAR_ANGLE)))
    return f"{words}, sliding along {', '.join(names)}" if names else words


def _view(result: DesignResult) -> tuple[Point, float]:
    """Where motions are seen from, and the size of the part."""
    if result.verdict is not None:
        return result.verdict.reference, result.verdict.length
    planar = result.free is not None and len(result.free) == 3
    return np.zeros(2 if planar else 3), 1.0


def _step_in_words(step: Step, reference: Point, length: float) -> str:
    motion = _motion(step.motion, reference, length)
    others = ", ".join(step.circuit)
    why = {
        "unnoticed": f"notices {motion}",
        "free": f"stops {motion}",
        "bound": f"{others} constrain both ways" if others else "it binds, or is in the way",
        "twice": f"{others} locate the same thing twice",
        "in the way": "the part does not come out past it",
        "spare": "the others do without it",
        "loads": f"it pushes with {step.preload or 0.0:.4g} N",
    }[step.why]
    return f"{step.action} {step.element}: {why}"


def _motion(motion: Vector | None, reference: Point, length: float) -> str:
    return "what is left" if motion is None else motion_in_words(motion, reference, length)


def _changes_in_words(changes: ChangeBound) -> str:
    if changes.found == 0:
        return "nothing has to change"
    found = f"{changes.found} change{'' if changes.found == 1 else 's'}"
    among = "" if changes.candidates is None else f" among {changes.candidates} candidates"
    if changes.proven:
        return f"{found}; fewer do not do it{among} (proven)"
    where = "" if changes.complete else " in the directions that were tried"
    return f"{found}; at least {changes.bound} are needed{among}{where}"


def _bound_in_words(bound: Bound) -> str:
    if bound.elements == 0 and bound.found is not None:
        return f"{bound.found} elements; how few could do is not known"
    roles = f" ({bound.locators} locators, {bound.clamps} clamps)" if bound.locators else ""
    least = f"at least {bound.elements} elements{roles}"
    among = f"among {bound.candidates} candidates{'' if bound.complete else ' in the directions that were tried'}"
    among += " where the part comes straight off all locators at once" if bound.letting_go else ""
    if bound.gap == 0:
        fewer = "; sliding along some, fewer may do: limits of clamps ask for that" if bound.letting_go else ""
        return f"{bound.found} elements, the fewest {among}" + (" (proven)" if bound.proven else "") + fewer
    if bound.found is None:
        return f"{least} are needed {among}"
    return f"{bound.found} elements; {least} are needed {among}: {bound.gap} more than proven"


def _preload_in_words(result: DesignResult) -> str:
    """How far it may be from the least one."""
    words = f"preload {result.preload:.4g} N in all"
    if result.best_preload_here is not None:
        words += f"; with these locators no clamps do with less than {result.best_preload_here:.4g} N"
    if result.best_preload is not None:
        words += f", with others none with less than {result.best_preload:.4g} N"
    return words


def _accuracy_in_words(result: DesignResult, accuracy: float, best: float | None) -> str:
    """How exact the locators are, and where it is known how far that may be from the best ones."""
    featured = result.layout is not None and bool(result.layout.key_features)
    words = f"accuracy: 1 / volume of the locators' rows is {accuracy:.4g}"
    if featured:
        off = f"a key feature is off by {accuracy * _OFF:.3g} of its tolerance at most"
        words = f"accuracy: with locators {_OFF * 1e3:g} mm off, {off}"
    if best is None:
        return words
    ratio = max(accuracy / best, 1.0)
    where = "" if result.bound is None or result.bound.complete else " in the directions that were tried"
    gap = f"({ratio - 1:.1%})" if ratio < 2 else f"({ratio:.3g} times)"
    least = f"by less than {best * _OFF:.3g}" if featured else f"below {best:.4g}"
    return f"{words}, and with none of these candidates{where} {least} {gap}"
