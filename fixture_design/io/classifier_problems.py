"""What may be wrong in a classifier file besides its keys: names, rows, who follows whom, faces that there are."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from fixture_design.io.classifier_records import ClassifierRecord, StateRecord, TransitionRecord
from fixture_design.io.places import KeyPath
from fixture_design.io.problems import Problem
from fixture_design.tolerances import UNIT_ROW


def classifier_problems(record: ClassifierRecord, size: int) -> list[Problem]:
    """The problems of a classifier's content; those that follow from a wrong name are none of their own.

    Args:
        size: numbers of a signal.
    """
    return list(_state_problems(record, size)) or list(_transition_problems(record)) or list(_gaps(record))


def _state_problems(record: ClassifierRecord, size: int) -> Iterator[Problem]:
    known: dict[str, StateRecord] = {}
    for i, state in enumerate(record.states):
        if state.id in known:
            yield Problem(("states", i, "id"), f"there are two states {state.id!r}", expected="another id")
        known[state.id] = state
        for k, cone in enumerate(state.cones):
            for key, rows in (("faces", cone.faces), ("equalities", cone.equalities)):
                yield from _row_problems(("states", i, "cones", k, key), rows, size)
    for i, state in enumerate(record.states):
        yield from _successor_problems(("states", i, "successors"), state, known)


def _row_problems(place: KeyPath, rows: Sequence[Sequence[float]], size: int) -> Iterator[Problem]:
    for m, row in enumerate(rows):
        length = math.hypot(*row)
        if len(row) != size:
            yield Problem((*place, m), f"a face vector has {len(row)} numbers", expected=f"{size} here")
        elif abs(length - 1) > UNIT_ROW:
            yield Problem((*place, m), "a face vector is no unit vector", f"one of length {length:.9g}", "length 1")


def _successor_problems(place: KeyPath, state: StateRecord, known: Mapping[str, StateRecord]) -> Iterator[Problem]:
    for k, name in enumerate(state.successors):
        if name not in known:
            yield Problem((*place, k), f"there is no state {name!r}", expected="a state's id")
        if name in state.successors[:k]:
            yield Problem((*place, k), f"{name} is there twice", expected="each successor once")
    if state.id not in state.successors and all(name in known for name in state.successors):
        yield Problem(place, f"{state.id} is not among its own successors", expected="itself, and those beside it")


def _transition_problems(record: ClassifierRecord) -> Iterator[Problem]:
    known = {state.id: state for state in record.states}
    seen: set[tuple[str, str]] = set()
    for i, each in enumerate(record.transitions):
        unknown = [(key, name) for key, name in (("source", each.source), ("target", each.target)) if name not in known]
        for key, name in unknown:
            yield Problem(("transitions", i, key), f"there is no state {name!r}", expected="a state's id")
        if unknown:
            continue
        if each.target not in known[each.source].successors:
            yield Problem(("transitions", i, "target"), f"{each.target} is no successor of {each.source}")
        if (each.source, each.target) in seen:
            yield Problem(("transitions", i), f"there are two transitions from {each.source} to {each.target}")
        seen.add((each.source, each.target))
        yield from _group_problems(("transitions", i, "faces"), each, known[each.target])


def _gaps(record: ClassifierRecord) -> Iterator[Problem]:
    """Successors that no transition leads to; a classifier without discriminants has no transitions at all."""
    there = {(each.source, each.target) for each in record.transitions}
    for source, target in ((state.id, name) for state in record.states for name in state.successors):
        if there and (source, target) not in there:
            yield Problem(("transitions",), f"there is no transition from {source} to its successor {target}")


def _group_problems(place: KeyPath, each: TransitionRecord, target: StateRecord) -> Iterator[Problem]:
    cones = target.cones
    if len(each.faces) != len(cones):
        problem = f"{len(each.faces)} groups of faces for the {len(cones)} cones of {each.target}"
        yield Problem(place, problem, expected="one for each cone")
        return
    for k, (faces, cone) in enumerate(zip(each.faces, cones, strict=True)):
        count = len(cone.faces) + 2 * len(cone.equalities)
        if any(face >= count for face in faces):
            problem = f"face {max(faces)} of a cone that has {count}"
            yield Problem((*place, k), problem, expected=f"numbers from 0 to {count - 1}")
