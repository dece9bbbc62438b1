"""A URDF file as a tree of links held together by fixed joints, each with its pose in the root link's frame."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fixture_design.arrays import Point
from fixture_design.errors import FileFormatError, UnsupportedError
from fixture_design.geometry.mesh_file import unreadable
from fixture_design.layout import Pose


@dataclass(frozen=True, eq=False)
class UrdfFile:
    """A file and its parsed robot element, to say where things are."""

    file: Path
    robot: ElementTree.Element

    def error(
        self, problem: str, place: str | None, found: str | None = None, expected: str | None = None
    ) -> FileFormatError:
        return FileFormatError(problem, source=self.file, place=place, found=found, expected=expected)

    def numbers(
        self, element: ElementTree.Element, key: str, default: str, place: str, counts: tuple[int, ...] = (3,)
    ) -> Point:
        """An attribute as finite numbers, as many as one of ``counts``."""
        text = element.get(key, default)
        expected = f"{' or '.join(map(str, counts))} numbers in {key!r}"
        try:
            values = np.array([float(word) for word in text.split()])
        except ValueError as cause:
            raise self.error("not a number", place, found=repr(text), expected=expected) from cause
        if len(values) not in counts or not np.isfinite(values).all():
            raise self.error(f"{key!r} cannot be used", place, found=repr(text), expected=expected)
        return values

    def origin(self, element: ElementTree.Element, place: str) -> Pose:
        """The pose in <origin xyz rpy>, identity without one."""
        found = element.find("origin")
        if found is None:
            return Pose.identity(3)
        xyz, rpy = self.numbers(found, "xyz", "0 0 0", place), self.numbers(found, "rpy", "0 0 0", place)
        return Pose.from_xyz_rpy(xyz, rpy)


def robot_of(file: Path) -> ElementTree.Element:
    """The root element of a URDF file.

    Raises:
        FileFormatError: no file, not XML, not URDF.  UnsupportedError: xacro.
    """
    if problem := unreadable(file, "such file"):
        raise FileFormatError(problem, source=file, expected="a URDF file")
    try:
        robot = ElementTree.fromstring(_declared(file.read_bytes()))
    except ElementTree.ParseError as cause:
        line, column = cause.position
        found = str(cause).partition(": line")[0]  # the parser counts columns from 0, we from 1
        raise FileFormatError(
            "not XML", source=file, place=f"line {line}, column {column + 1}", found=found, expected="a URDF file"
        ) from cause
    except (LookupError, ValueError) as cause:  # an encoding that Python or its XML parser does not know
        raise FileFormatError("not XML", source=file, place="line 1", found=str(cause), expected="UTF-8") from cause
    if robot.tag != "robot":
        raise FileFormatError("not URDF", source=file, found=f"<{robot.tag}>", expected="<robot> as the root element")
    if any("xacro" in str(element.tag) for element in robot.iter()):
        raise UnsupportedError("this is xacro, not URDF", source=file, expected="the URDF that xacro makes of it")
    return robot


def _declared(text: bytes) -> bytes:
    """The text with the prefix ``drake:`` declared in its root element: Drake reads it undeclared, XML does not."""
    if b"<drake:" not in text or b"xmlns:drake" in text:
        return text
    return re.sub(rb"<robot\b", b'<robot xmlns:drake="https://drake.mit.edu"', text, count=1)


def links_in_root(urdf: UrdfFile) -> dict[str, Pose]:
    """X_RL of every link: its pose in the root link's frame, joints multiplied from the root outward."""
    names = [link.get("name", "") for link in urdf.robot.findall("link")]
    if not names or "" in names:
        raise urdf.error("there are no links" if not names else "a link has no name", None, expected="<link name=...>")
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise urdf.error("two links have the same name", None, found=repr(twice))
    joints = {child: (parent, X_PC) for parent, child, X_PC in _joints(urdf, names)}
    roots = [name for name in names if name not in joints]
    if len(roots) != 1:
        raise urdf.error("the links do not form one tree", None, f"roots {roots}", "one link that is nobody's child")
    return {name: _pose_in_root(urdf, name, joints) for name in names}


def _joints(urdf: UrdfFile, names: list[str]) -> Iterator[tuple[str, str, Pose]]:
    children = set()
    for joint in urdf.robot.findall("joint"):
        place = f"joint {joint.get('name', '')!r}"
        if joint.get("type") != "fixed":
            found = f"type {joint.get('type')!r}"
            raise UnsupportedError("a part must be rigid", source=urdf.file, place=place, found=found, expected="fixed")
        ends = [getattr(joint.find(end), "attrib", {}).get("link", "") for end in ("parent", "child")]
        for name in ends:
            if name not in names:
                raise urdf.error("no such link", place, found=repr(name), expected=f"one of {', '.join(names)}")
        if ends[1] in children:
            raise urdf.error("a link has two parents", place, found=repr(ends[1]))
        children.add(ends[1])
        yield ends[0], ends[1], urdf.origin(joint, place)


def _pose_in_root(urdf: UrdfFile, name: str, joints: dict[str, tuple[str, Pose]]) -> Pose:
    X_RL, at, steps = Pose.identity(3), name, 0
    while at in joints:
        at, X_PC = joints[at]
        X_RL = composed(X_PC, X_RL)
        steps += 1
        if steps > len(joints):
            raise urdf.error("the joints form a loop", f"link {name!r}", expected="a tree")
    return X_RL


def composed(X_AB: Pose, X_BC: Pose) -> Pose:
    """X_AC."""
    return Pose(X_AB.rotation @ X_BC.rotation, X_AB.points(X_BC.translation[None])[0])
