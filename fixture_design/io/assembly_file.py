"""Assembly files: read into an `Assembly`, and as graph files embed them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.arrays import read_only
from fixture_design.assembly import Assembly, AssemblyBody, Region
from fixture_design.io.assembly_records import AssemblyRecord, BodyShapeRecord, RegionRecord
from fixture_design.io.assembly_rules import SHAPES, assembly_problems
from fixture_design.io.documents import Document, read_document
from fixture_design.io.layout_reading import METRES
from fixture_design.io.places import Place
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import content_error
from fixture_design.io.schema_key import require_schema
from fixture_design.layout import Pose


def read_assembly(path: str | Path) -> Assembly:
    """The assembly in a YAML or JSON file, in metres; files it names are absolute paths, which need not exist.

    Raises:
        FileFormatError: the file cannot be read, does not parse or is not an assembly. The message tells file, line,
            key path, what was found and what was expected, for the first problem, and counts the others.
    """
    return _assembly(read_document(path), Path(path))


def assembly_from_data(values: Mapping[str, object], source: str | Path, places: Place | None = None) -> Assembly:
    """The assembly that a mapping describes, as `read_assembly` would read it from ``source``."""
    return _assembly(Document(dict(values), str(source), places or Place()), Path(source))


def _assembly(document: Document, path: Path) -> Assembly:
    require_schema(document, "assembly")
    record = validated(AssemblyRecord, document)
    if problems := list(assembly_problems(record)):
        raise content_error(problems, document)
    metres = METRES[record.units]
    return Assembly(
        name=record.name or path.stem,
        space=record.space,
        moving=_body(record.moving, record, metres, path.parent),
        fixed=tuple(_body(body, record, metres, path.parent) for body in record.fixed),
        region=None if record.region is None else _region(record.region, record, metres),
        source=path,
        data=document.values,
    )


def _body(
    body: BodyShapeRecord, assembly: AssemblyRecord, metres: Callable[[float], float], folder: Path
) -> AssemblyBody:
    kind = next(key for key in SHAPES if getattr(body, key) is not None)
    file = body.mesh or body.urdf
    pose: Pose | None = None
    if body.pose is not None and assembly.space == "planar":
        pose = Pose.from_xy_theta([metres(x) for x in body.pose.xy or (0.0, 0.0)], body.pose.theta or 0.0)
    elif body.pose is not None:
        pose = Pose.from_xyz_rpy([metres(x) for x in body.pose.xyz or (0.0,) * 3], body.pose.rpy or (0.0,) * 3)
    polygon = [[metres(x) for x in vertex] for vertex in body.polygon or ()]
    return AssemblyBody(
        kind=kind,  # type: ignore[arg-type]
        polygon=read_only(polygon) if polygon else None,
        box=None if body.box is None else read_only([metres(side) for side in body.box]),
        file=None if file is None else Path(os.path.abspath(folder / file)),
        scale=1.0 if body.scale is None else body.scale,
        pose=pose,
        apices=dict(body.apices),
        facets=dict(body.facets),
    )


def _region(region: RegionRecord, assembly: AssemblyRecord, metres: Callable[[float], float]) -> Region:
    limits = [region.x, region.y] if region.z is None else [region.x, region.y, region.z]
    low, high = np.array([[metres(x) for x in pair] for pair in limits]).T
    turns: Any = region.theta if assembly.space == "planar" else None
    if region.rotation is not None:
        turns = (0.0, region.rotation)
    return Region(read_only(low), read_only(high), None if turns is None else (turns[0], turns[1]))
