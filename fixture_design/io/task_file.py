"""Task files: read into a `Task`; and the task that a bare part file stands for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np

from fixture_design.arrays import read_only
from fixture_design.design import CandidateRules, Grid, Limits, PinRules, Task
from fixture_design.errors import FileFormatError
from fixture_design.io.documents import Document, read_document
from fixture_design.io.layout_file import read_layout
from fixture_design.io.layout_places import layout_places
from fixture_design.io.layout_reading import layout_from_record, metres_of, tip_from_record
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import content_error
from fixture_design.io.records import LAYOUT_SCHEMA
from fixture_design.io.schema_key import require_schema
from fixture_design.io.task_records import CandidatesRecord, LimitsRecord, PinsRecord, StemRecord, TaskRecord
from fixture_design.io.task_rules import as_layout, task_problems
from fixture_design.layout import Layout, Part, Pose, StemSizes

#: Endings of files that are tasks; all others are parts.
TASK_ENDINGS = (".yaml", ".yml", ".json")


def read_task(path: str | Path) -> Task:
    """The task in a YAML or JSON file, in metres; its start layout is read too.

    Raises:
        FileFormatError: the file cannot be read, does not parse or is not a task; or its start layout is none, or is
            of another space.
    """
    path = Path(path)
    return _task(read_document(path), path)


def read_task_or_layout(path: str | Path) -> Task | Layout:
    """The task, or the layout, in a file.

    Raises:
        FileFormatError: as `read_task` and `read_layout` do.
    """
    path = Path(path)
    document = read_document(path)
    return read_layout(path) if document.values.get("schema") == LAYOUT_SCHEMA else _task(document, path)


def _task(document: Document, path: Path) -> Task:
    require_schema(document, "task")
    record = validated(TaskRecord, document)
    if problems := list(task_problems(record)):
        raise content_error(problems, document)
    shared = as_layout(record)
    layout = layout_from_record(shared, path.stem, path, path.parent, layout_places(shared, document.place))
    assert layout.part is not None  # a task record has one
    return Task(
        name=layout.name,
        part=layout.part,
        space=layout.space,
        candidates=_rules(record.candidates or CandidatesRecord.model_validate({}), record),
        start=None if record.start is None else _start(path.parent / record.start, layout, path),
        require=layout.require or None,
        limits=_limits(record.limits or LimitsRecord.model_validate({}), record),
        objective=record.objective,
        gravity=layout.gravity,
        friction=layout.friction,
        surface_gap=layout.surface_gap,
        key_features=layout.key_features,
        loads=layout.loads,
        source=path,
        places=layout.places,
    )


def task_of_part(path: str | Path, scale: float = 1.0) -> Task:
    """The task that a part file alone stands for: locate it, let it out, close it, with the fewest elements.

    Raises:
        FileFormatError: a scale for a URDF file, whose meshes carry their own.
    """
    path = Path(path)
    if path.suffix.lower() == ".urdf" and scale != 1:
        raise FileFormatError(
            "`scale` is not for URDF", source=path, found=f"{scale:g}", expected="scale=... of its meshes"
        )
    kinds: dict[str, Literal["urdf", "step"]] = {".urdf": "urdf", ".step": "step", ".stp": "step"}
    kind: Literal["urdf", "step", "mesh"] = kinds.get(path.suffix.lower(), "mesh")
    return Task(path.stem, Part(path.stem, kind, path.absolute(), None, scale, Pose.identity(3)), source=path)


def _start(path: Path, task: Layout, source: Path) -> Layout:
    """The layout to begin with; it must be of the same space, and its own part is that of the task."""
    start = read_layout(path)
    if start.space != task.space:
        problem = f"the start layout is {start.space}, and the task {task.space}"
        raise FileFormatError(problem, source=source, found=str(path))
    return Layout(
        start.name, start.space, task.part, start.gravity, start.friction, start.surface_gap, start.elements,
        start.bodies, start.contacts, source=start.source, places=start.places, own_friction=start.own_friction,
    )  # fmt: skip


def _rules(rules: CandidatesRecord, task: TaskRecord) -> CandidateRules:
    metres = metres_of(task.units)

    def point(values: tuple[float, ...]) -> np.ndarray:
        return read_only([metres(value) for value in values])

    tips = tuple(tip_from_record(tip, metres) for tip in rules.tips or (rules.tip,))
    return CandidateRules(
        spacing=None if rules.spacing is None else metres(rules.spacing),
        edge_margin=None if rules.edge_margin is None else metres(rules.edge_margin),
        facets=rules.facets,
        keep_out=tuple((point(region.box[0]), point(region.box[1])) for region in rules.keep_out),
        points=None if rules.points is None else read_only([point(values) for values in rules.points]),
        grid=None if rules.grid is None else Grid(point(rules.grid.origin), metres(rules.grid.pitch), rules.grid.plane),
        tip=tips[0],
        more_tips=tips[1:],
        pins=None if rules.pins is None else _pins(rules.pins, metres),
        stem=_stem(rules.stem, metres),
        round_too=rules.round,
        tolerance=None if rules.tolerance is None else metres(rules.tolerance),
    )


def _pins(pins: PinsRecord, metres: Callable[[float], float]) -> PinRules:
    low, high = pins.diameters
    return PinRules(metres(pins.clearance), (metres(low), metres(high)))


def _stem(stem: StemRecord | None, metres: Callable[[float], float]) -> StemSizes:
    given = {} if stem is None else stem.model_dump(exclude_none=True)
    return StemSizes(**{key: metres(value) for key, value in given.items()})


def _limits(limits: LimitsRecord, task: TaskRecord) -> Limits:
    loading = None if limits.loading is None else read_only(limits.loading)
    preload = None if limits.preload is None else (limits.preload[0], limits.preload[1])
    return Limits(limits.locators, limits.clamps, metres_of(task.units)(limits.spacing), loading, preload)
