"""From a layout's record to the nouns: lengths in metres, files absolute, defaults filled in."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Literal

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.contacts import Contact
from fixture_design.errors import looking_at
from fixture_design.io.records import (
    BodyRecord,
    ContactRecord,
    ElementRecord,
    KeyFeatureRecord,
    LayoutRecord,
    LoadRecord,
    PartRecord,
    PoseRecord,
    StageRecord,
    SweepRecord,
    TipRecord,
)
from fixture_design.layout import (
    Body,
    Element,
    KeyFeature,
    Layout,
    LineTip,
    Load,
    PadTip,
    Part,
    PinTip,
    PointTip,
    Pose,
    SoftTip,
    SphereTip,
    Stage,
    Tip,
)
from fixture_design.tolerances import SURFACE_GAP

#: Metres from a file's lengths. A division for millimetres, since 0.001 is not exact in binary: 20 / 1000 is the float
#: nearest to 0.02, 20 * 0.001 need not be.
METRES: dict[str, Callable[[float], float]] = {
    "m": lambda length: length,
    "mm": lambda length: length / 1000,
    "in": lambda length: length * 0.0254,
}


def metres_of(units: str) -> Callable[[float], float]:
    """What makes metres of a file's lengths."""
    return METRES[units]


def layout_from_record(
    record: LayoutRecord, name: str, source: Path | None, folder: Path, places: Mapping[tuple[str, ...], str]
) -> Layout:
    """The layout; ``name`` where the record has none, files relative to ``folder``, ``places`` as in `Layout`.

    Raises:
        ContactError: a contact given outright that cannot be computed with.
    """
    convert = _Converter(record, folder)
    contacts = []
    for contact in record.contacts:
        with looking_at(source, places.get(("contacts", contact.name))):
            contacts.append(convert.contact(contact))
    require = record.require
    groups = {key: getattr(require, key) for key in ("locators", "all")} if require else {}
    return Layout(
        name=record.name or name,
        space=record.space,
        part=convert.part(record.part) if record.part else None,
        gravity=_vector(record.gravity),
        friction=record.friction,
        surface_gap=SURFACE_GAP if record.surface_gap is None else convert.metres(record.surface_gap),
        elements=tuple(map(convert.element, record.elements)),
        bodies=tuple(map(convert.body, record.bodies)),
        contacts=tuple(contacts),
        key_features=tuple(map(convert.key_feature, record.key_features)),
        loads=tuple(map(convert.load, record.loads)),
        stages=tuple(map(_stage, record.stages)),
        require={group: words for group, words in groups.items() if words is not None},
        sweep=convert.sweep(record.sweep) if record.sweep else None,
        source=source,
        units=record.units,
        places=places,
        own_friction=frozenset(c.name for c in record.contacts if c.friction is not None),
    )


class _Converter:
    """Converts records of one layout, whose units, space and folder it knows."""

    def __init__(self, layout: LayoutRecord, folder: Path) -> None:
        self.metres = METRES[layout.units]
        self._layout = layout
        self._folder = folder

    def _maybe_metres(self, length: float | None) -> float | None:
        return None if length is None else self.metres(length)

    def _point(self, coordinates: Iterable[float]) -> Point:
        return read_only([self.metres(length) for length in coordinates])

    def _file(self, name: str) -> Path:
        return Path(os.path.abspath(self._folder / name))

    def _pose(self, pose: PoseRecord | None) -> Pose:
        pose = pose or PoseRecord()  # type: ignore[call-arg]
        if self._layout.space == "planar":
            return Pose.from_xy_theta(self._point(pose.xy or (0.0, 0.0)), pose.theta or 0.0)
        return Pose.from_xyz_rpy(self._point(pose.xyz or (0.0, 0.0, 0.0)), pose.rpy or (0.0, 0.0, 0.0))

    def part(self, part: PartRecord) -> Part:
        kind, file = _geometry(part)
        path = None if file is None else self._file(file)
        polygon = [self._point(vertex) for vertex in part.polygon or ()]
        return Part(
            name=path.stem if path else "polygon",
            kind=kind,
            file=path,
            polygon=read_only(polygon) if polygon else None,
            scale=1.0 if part.scale is None else part.scale,
            pose=self._pose(part.pose),
            mass=part.mass,
            center=None if part.center is None else self._point(part.center),
            form_error=self._maybe_metres(part.form_error),
            faceted=part.faceted,
        )

    def element(self, element: ElementRecord) -> Element:
        return Element(
            name=element.name,
            role=element.role,
            at=self._point(element.at),
            tip=tip_from_record(element.tip, self.metres),
            axis=_vector(element.axis),
            tolerance=self._maybe_metres(element.tolerance),
            friction=element.friction,
            preload=element.preload,
            limits=None if element.limits is None else (element.limits[0], element.limits[1]),
            fixed=element.fixed,
            stiffness=element.stiffness,
        )

    def body(self, body: BodyRecord) -> Body:
        return Body(body.name, body.role, self._file(body.urdf), self._pose(body.pose), body.friction)

    def contact(self, contact: ContactRecord) -> Contact:
        friction = self._layout.friction if contact.friction is None else contact.friction
        clauses = tuple(tuple(read_only(normal) for normal in clause) for clause in _clauses(contact))
        return Contact(contact.name, contact.role, self._point(contact.point), clauses, friction)

    def key_feature(self, feature: KeyFeatureRecord) -> KeyFeature:
        point, direction = self._point(feature.point), read_only(feature.direction)
        return KeyFeature(feature.name, point, direction, self.metres(feature.tolerance))

    def load(self, load: LoadRecord) -> Load:
        point = None if load.point is None else self._point(load.point)
        path = None if load.path is None else self._file(load.path)
        return Load(load.name, point, _vector(load.force), _vector(load.moment), path)

    def sweep(self, sweep: SweepRecord) -> dict[str, object]:
        settings: dict[str, object] = sweep.model_dump(exclude_none=True)
        if sweep.at is not None:
            settings["at"] = self.metres(sweep.at)
        if sweep.part_pose is not None:
            pose = sweep.part_pose.model_dump(exclude_none=True)
            lengths = {key: tuple(map(self.metres, pose[key])) for key in ("xyz", "xy") if key in pose}
            settings["part_pose"] = pose | lengths
        return settings


def tip_from_record(tip: TipRecord | None, metres: Callable[[float], float]) -> Tip:
    """The tip, its lengths made metres; a point where there is none."""
    if tip is None:
        return PointTip()
    if tip.sphere is not None:
        return SphereTip(metres(tip.sphere))
    if tip.soft is not None:
        return SoftTip(metres(tip.soft))
    if tip.pad is not None and tip.along is not None:
        return PadTip(metres(tip.pad[0]), metres(tip.pad[1]), read_only(tip.along))
    if tip.line is not None and tip.along is not None:
        return LineTip(metres(tip.line), read_only(tip.along))
    if tip.pin is not None:
        along = _vector(tip.along if tip.pin.along is None else tip.pin.along)
        return PinTip(metres(tip.pin.diameter), metres(tip.pin.clearance), tip.pin.shape, along)
    return PointTip()


def _geometry(part: PartRecord) -> tuple[Literal["urdf", "mesh", "step", "polygon"], str | None]:
    """Kind and file; the layout's rules made sure that there is exactly one of them."""
    if part.urdf is not None:
        return "urdf", part.urdf
    if part.mesh is not None:
        return "mesh", part.mesh
    return ("polygon", None) if part.step is None else ("step", part.step)


def _clauses(contact: ContactRecord) -> Iterable[Iterable[tuple[float, ...]]]:
    if contact.normal is not None:
        return ((contact.normal,),)
    if contact.any_of is not None:
        return (contact.any_of,)
    if contact.all_of is not None:
        return ((normal,) for normal in contact.all_of)
    return contact.normals or ()


def _stage(stage: StageRecord) -> Stage:
    return Stage(stage.name, stage.active, stage.gravity, stage.loads, stage.require)


def _vector(values: Iterable[float] | None) -> np.ndarray | None:
    return None if values is None else read_only(list(values))
