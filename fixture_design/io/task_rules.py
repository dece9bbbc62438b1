"""What a task's keys must satisfy together; what a layout has too is checked as there."""

from __future__ import annotations

from collections.abc import Iterator

from fixture_design.io.layout_rules import given_keys, layout_problems, order_problems, tip_problems
from fixture_design.io.places import KeyPath
from fixture_design.io.problems import Problem
from fixture_design.io.records import LAYOUT_SCHEMA, LayoutRecord, TipRecord
from fixture_design.io.task_records import CandidatesRecord, LimitsRecord, TaskRecord

#: Tips that new elements may have.
_TIPS = ("sphere", "soft", "pad", "line")

#: Keys that a task has as a layout has them.
_SHARED = ("name", "space", "units", "part", "gravity", "friction", "surface_gap", "key_features", "loads", "require")


def as_layout(task: TaskRecord) -> LayoutRecord:
    """The layout without elements that has what the task shares with one."""
    shared = {key: getattr(task, key) for key in _SHARED if getattr(task, key) is not None}
    return LayoutRecord.model_validate({"schema": LAYOUT_SCHEMA, **shared})


def task_problems(task: TaskRecord) -> Iterator[Problem]:
    """Everything about a task that its keys' types do not tell."""
    yield from layout_problems(as_layout(task))
    if task.candidates is not None:
        yield from _candidate_problems(task.candidates, task.space == "planar")
    if task.limits is not None:
        yield from _limit_problems(task.limits, task.space == "planar")
    for index, word in enumerate(task.objective):
        if word in task.objective[:index]:
            yield Problem(("objective", index), f"{word!r} is an objective twice", expected="it once")


def _candidate_problems(candidates: CandidatesRecord, planar: bool) -> Iterator[Problem]:
    given = given_keys(candidates, ("spacing", "points", "grid"))
    if len(given) > 1:
        problem = f"candidates have {' and '.join(map(repr, given))} together"
        yield Problem(("candidates", given[1]), problem, expected="one of them")
    if candidates.grid is not None and planar:
        yield Problem(("candidates", "grid"), "a grid of candidates is for spatial parts", expected="`points`")
    elif candidates.grid is not None:
        yield from _count_problems(candidates.grid.origin, ("candidates", "grid", "origin"), planar)
    for index, region in enumerate(candidates.keep_out):
        path: KeyPath = ("candidates", "keep_out", index, "box")
        low, high = region.box
        counts = [p for k, corner in enumerate(region.box) for p in _count_problems(corner, (*path, k), planar)]
        yield from counts
        if not counts and any(a > b for a, b in zip(low, high, strict=True)):
            yield Problem(path, "the box's first corner is not its lowest", f"{low} and {high}", "[lowest, highest]")
    for index, point in enumerate(candidates.points or ()):
        yield from _count_problems(point, ("candidates", "points", index), planar)
    if candidates.pins is not None and planar:
        yield Problem(("candidates", "pins"), "pins in holes are for spatial parts", expected="no `pins` here")
    elif candidates.pins is not None and candidates.pins.diameters[0] > candidates.pins.diameters[1]:
        path = ("candidates", "pins", "diameters")
        found = f"[{candidates.pins.diameters[0]:g}, {candidates.pins.diameters[1]:g}]"
        yield Problem(path, "'diameters' is out of order", found, "the smaller one first")
    if candidates.stem is not None and planar:
        yield Problem(("candidates", "stem"), "stems are spatial: elements stand upright beside a planar part")
    if candidates.tip is not None and candidates.tips is not None:
        yield Problem(("candidates", "tips"), "candidates have 'tip' and 'tips' together", expected="one of them")
    if candidates.tip is not None:
        yield from _new_tip_problems(candidates.tip, ("candidates", "tip"), planar)
    for index, tip in enumerate(candidates.tips or ()):
        if tip is not None:
            yield from _new_tip_problems(tip, ("candidates", "tips", index), planar)


def _new_tip_problems(tip: TipRecord, path: KeyPath, planar: bool) -> Iterator[Problem]:
    if not given_keys(tip, _TIPS):
        expected = "point, {sphere: radius}, {soft: radius}, {pad: [w, h], along: v} or {line: length, along: v}"
        yield Problem(path, "design places no tips of this kind", expected=expected)
        return
    yield from tip_problems(tip, path, "new elements")
    if tip.along is not None:
        yield from _count_problems(tip.along, (*path, "along"), planar)
        if not any(tip.along):
            yield Problem((*path, "along"), "'along' has zero length", expected="a direction")


def _limit_problems(limits: LimitsRecord, planar: bool) -> Iterator[Problem]:
    if limits.loading is not None:
        yield from _count_problems(limits.loading, ("limits", "loading"), planar)
        if not any(limits.loading):
            yield Problem(("limits", "loading"), "'loading' has zero length", expected="a direction")
    if limits.preload is not None:
        yield from order_problems(limits.preload, ("limits", "preload"))


def _count_problems(values: tuple[float, ...], path: KeyPath, planar: bool) -> Iterator[Problem]:
    count, space = (2, "planar") if planar else (3, "spatial")
    if len(values) != count:
        yield Problem(path, f"'space: {space}' wants {count} coordinates, found {len(values)}")
