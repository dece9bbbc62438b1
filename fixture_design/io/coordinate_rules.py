"""Coordinates: as many as the space has, and directions that point somewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fixture_design.io.places import KeyPath, key_path_text
from fixture_design.io.problems import Problem
from fixture_design.io.records import ContactRecord, ElementRecord, LayoutRecord, PoseRecord


@dataclass(frozen=True)
class _Coordinates:
    """Some coordinates, where they stand, and whether they are a direction (then zero is none)."""

    path: KeyPath
    values: tuple[float, ...]
    direction: bool = False


def coordinate_problems(layout: LayoutRecord) -> Iterator[Problem]:
    """Points, directions, poses and moments that do not fit the layout's space."""
    count = 2 if layout.space == "planar" else 3
    for given in _all_coordinates(layout):
        if len(given.values) != count:
            yield _wrong_count(given.path, len(given.values), layout.space, f"{count} coordinates")
        elif given.direction and not any(given.values):
            yield Problem(given.path, f"{_key(given.path)!r} has zero length", expected="a direction")
    for index, load in enumerate(layout.loads):
        wanted = 1 if layout.space == "planar" else 3
        if load.moment is not None and len(load.moment) != wanted:
            words = "one number as a moment" if wanted == 1 else "3 numbers as a moment"
            yield _wrong_count(("loads", index, "moment"), len(load.moment), layout.space, words)
    for path, pose in _poses(layout):
        for key in ("xyz", "rpy") if layout.space == "planar" else ("xy", "theta"):
            if getattr(pose, key) is not None:
                wanted = "{xy: [x, y], theta: angle}" if layout.space == "planar" else "{xyz: [...], rpy: [...]}"
                problem = f"{key!r} does not fit 'space: {layout.space}'"
                yield Problem((*path, key), problem, expected=wanted)


def _wrong_count(path: KeyPath, found: int, space: str, wanted: str) -> Problem:
    return Problem(path, f"'space: {space}' wants {wanted}, found {found} at {key_path_text(path)}")


def _key(path: KeyPath) -> str:
    return next(key for key in reversed(path) if isinstance(key, str))


def _all_coordinates(layout: LayoutRecord) -> Iterator[_Coordinates]:
    if layout.gravity is not None:
        yield _Coordinates(("gravity",), layout.gravity)
    if layout.part is not None and layout.part.center is not None:
        yield _Coordinates(("part", "center"), layout.part.center)
    for index, element in enumerate(layout.elements):
        yield from _of_element(element, ("elements", index))
    for index, contact in enumerate(layout.contacts):
        yield from _of_contact(contact, ("contacts", index))
    for index, feature in enumerate(layout.key_features):
        yield _Coordinates(("key_features", index, "point"), feature.point)
        yield _Coordinates(("key_features", index, "direction"), feature.direction, direction=True)
    for index, load in enumerate(layout.loads):
        for key, values in (("point", load.point), ("force", load.force)):
            if values is not None:
                yield _Coordinates(("loads", index, key), values)


def _of_element(element: ElementRecord, path: KeyPath) -> Iterator[_Coordinates]:
    yield _Coordinates((*path, "at"), element.at)
    if element.axis is not None:
        yield _Coordinates((*path, "axis"), element.axis, direction=True)
    if element.tip is not None and element.tip.along is not None:
        yield _Coordinates((*path, "tip", "along"), element.tip.along, direction=True)
    if element.tip is not None and element.tip.pin is not None and element.tip.pin.along is not None:
        yield _Coordinates((*path, "tip", "pin", "along"), element.tip.pin.along, direction=True)


def _of_contact(contact: ContactRecord, path: KeyPath) -> Iterator[_Coordinates]:
    yield _Coordinates((*path, "point"), contact.point)
    if contact.normal is not None:
        yield _Coordinates((*path, "normal"), contact.normal, direction=True)
    for key, normals in (("any_of", contact.any_of), ("all_of", contact.all_of)):
        for index, normal in enumerate(normals or ()):
            yield _Coordinates((*path, key, index), normal, direction=True)
    for row, clause in enumerate(contact.normals or ()):
        for index, normal in enumerate(clause):
            yield _Coordinates((*path, "normals", row, index), normal, direction=True)


def _poses(layout: LayoutRecord) -> Iterator[tuple[KeyPath, PoseRecord]]:
    if layout.part is not None and layout.part.pose is not None:
        yield ("part", "pose"), layout.part.pose
    for index, body in enumerate(layout.bodies):
        # a planar layout may have no bodies at all, and one complaint is enough
        if body.pose is not None and layout.space == "spatial":
            yield ("bodies", index, "pose"), body.pose
    if layout.sweep is not None and layout.sweep.part_pose is not None:
        yield ("sweep", "part_pose"), layout.sweep.part_pose
