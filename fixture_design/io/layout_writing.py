"""From a layout to the keys and plain values of its file, in metres, defaults left out."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from fixture_design.contacts import Contact, Provenance
from fixture_design.errors import UnsupportedError
from fixture_design.io.pose_angles import planar_angle, roll_pitch_yaw
from fixture_design.io.records import LAYOUT_SCHEMA
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
    Pose,
    SoftTip,
    SphereTip,
    Stage,
    Tip,
)
from fixture_design.tolerances import SURFACE_GAP

Data = dict[str, object]


def layout_data(layout: Layout, folder: Path) -> Data:
    """The mapping that a layout file in ``folder`` holds."""
    sweep = layout.sweep
    data: Data = {
        "schema": LAYOUT_SCHEMA,
        "name": layout.name,
        "space": layout.space,
        "part": _part(layout.part, folder) if layout.part else None,
        "gravity": _numbers(layout.gravity),
        "friction": float(layout.friction) or None,
        "surface_gap": float(layout.surface_gap) if layout.surface_gap != SURFACE_GAP else None,
        "elements": [_element(element) for element in layout.elements],
        "bodies": [_body(body, folder) for body in layout.bodies],
        "contacts": [_contact(contact, layout) for contact in layout.contacts],
        "key_features": [_key_feature(feature) for feature in layout.key_features],
        "loads": [_load(load, folder) for load in layout.loads],
        "stages": [_stage(stage) for stage in layout.stages],
        "require": {group: list(words) for group, words in layout.require.items()},
        "sweep": _plain(sweep) if sweep is not None else None,
    }
    # empty lists are the defaults, but an empty sweep is one variant and not none
    return {
        key: value for key, value in data.items() if value not in (None, [], {}) or (key == "sweep" and value == {})
    }


def _part(part: Part, folder: Path) -> Data:
    geometry = _numbers(part.polygon) if part.file is None else _relative(part.file, folder)
    return _given(
        {
            part.kind: geometry,
            "scale": float(part.scale) if part.scale != 1 else None,
            "pose": _pose(part.pose),
            "mass": _number(part.mass),
            "center": _numbers(part.center),
            "form_error": _number(part.form_error),
            "faceted": part.faceted or None,
        }
    )


def _pose(pose: Pose) -> Data | None:
    """None for the identity."""
    if len(pose.translation) == 2:
        data: Data = {"xy": _numbers(pose.translation), "theta": planar_angle(pose)}
    else:
        data = {"xyz": _numbers(pose.translation), "rpy": roll_pitch_yaw(pose)}
    zero = not pose.translation.any() and (pose.rotation == Pose.identity(len(pose.translation)).rotation).all()
    return None if zero else data


def _element(element: Element) -> Data:
    return _given(
        {
            "name": element.name,
            "role": element.role,
            "at": _numbers(element.at),
            "tip": _tip(element.tip),
            "axis": _numbers(element.axis),
            "tolerance": _number(element.tolerance),
            "friction": _number(element.friction),
            "preload": _number(element.preload),
            "limits": _numbers(element.limits),
            "fixed": element.fixed or None,
            "stiffness": _number(element.stiffness),
        }
    )


def _tip(tip: Tip) -> Data | None:
    """None for a point."""
    match tip:
        case SphereTip():
            return {"sphere": float(tip.radius)}
        case SoftTip():
            return {"soft": float(tip.radius)}
        case PadTip():
            return {"pad": [float(tip.width), float(tip.height)], "along": _numbers(tip.along)}
        case LineTip():
            return {"line": float(tip.length), "along": _numbers(tip.along)}
        case PinTip():
            pin = {"diameter": float(tip.diameter), "clearance": float(tip.clearance), "shape": tip.shape}
            return _given({"pin": pin, "along": _numbers(tip.along)})
    return None


def _body(body: Body, folder: Path) -> Data:
    data: Data = {"name": body.name, "role": body.role, "urdf": _relative(body.file, folder)}
    return data | _given({"pose": _pose(body.pose), "friction": _number(body.friction)})


def _contact(contact: Contact, layout: Layout) -> Data:
    if contact.provenance != Provenance():
        raise UnsupportedError(
            f"contact {contact.name!r} has {contact.provenance.kind} normals; a layout file holds exact ones only",
            expected="the element that touches there, in place of its contact",
        )
    own = contact.name in layout.own_friction or contact.friction != layout.friction
    friction = float(contact.friction) if own else None
    data: Data = {"name": contact.name, "role": contact.role, "point": _numbers(contact.point)}
    return data | _normals(contact) | _given({"friction": friction})


def _normals(contact: Contact) -> Data:
    clauses = [[_numbers(normal) for normal in clause] for clause in contact.clauses]
    if len(clauses) == 1:
        return {"normal": clauses[0][0]} if len(clauses[0]) == 1 else {"any_of": clauses[0]}
    if all(len(clause) == 1 for clause in clauses):
        return {"all_of": [clause[0] for clause in clauses]}
    return {"normals": clauses}


def _key_feature(feature: KeyFeature) -> Data:
    point, direction = _numbers(feature.point), _numbers(feature.direction)
    return {"name": feature.name, "point": point, "direction": direction, "tolerance": float(feature.tolerance)}


def _load(load: Load, folder: Path) -> Data:
    moment = _numbers(load.moment)
    return _given(
        {
            "name": load.name,
            "point": _numbers(load.point),
            "force": _numbers(load.force),
            "moment": moment[0] if moment is not None and len(moment) == 1 else moment,
            "path": None if load.path is None else _relative(load.path, folder),
        }
    )


def _stage(stage: Stage) -> Data:
    data: Data = {"name": stage.name, "active": list(stage.active), "gravity": stage.gravity or None}
    return _given(data | {"loads": list(stage.loads) or None, "require": list(stage.require) or None})


def _given(data: Data) -> Data:
    return {key: value for key, value in data.items() if value is not None}


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _numbers(values: object) -> list[object] | None:
    """Arrays and tuples of numbers as lists of floats, of any depth."""
    if values is None:
        return None
    return [_numbers(v) if isinstance(v, Iterable) else float(v) for v in values]  # type: ignore[attr-defined]


def _plain(value: object) -> object:
    """Settings as they were read, with lists for tuples."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def _relative(file: Path, folder: Path) -> str:
    """Relative to the folder; absolute where there is no relative path (another drive)."""
    try:
        return Path(os.path.relpath(file, os.path.abspath(folder))).as_posix()
    except ValueError:
        return file.as_posix()
