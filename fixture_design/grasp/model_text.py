"""A URDF or SDF file as text that Drake's parser takes: what is only looked at is left out, meshes are OBJ files.

Drake reads no STL, DAE or PLY as collision geometry, knows no packages that nobody told it of, and follows joints that
mimic others in few of its plants only. So meshes are read here and written again as OBJ, at their true size; mimic is
taken out and told apart; visual geometry, transmissions and sensors are dropped.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fixture_design.errors import FileFormatError, UnsupportedError
from fixture_design.geometry.distance import obj_text
from fixture_design.geometry.mesh_file import read_mesh, unreadable
from fixture_design.geometry.package import resolve
from fixture_design.geometry.scene import RawMesh
from fixture_design.geometry.urdf_tree import robot_of
from fixture_design.grasp.hand import JointRule

#: Elements that say nothing of how a hand moves or touches.
_DROPPED = ("visual", "transmission", "gazebo", "mimic", "sensor", "plugin", "ros2_control", "safety_controller")

#: Elements that only matter where something moves by itself.
_DYNAMIC = ("inertial", "dynamics")

_DRAKE = "https://drake.mit.edu"


@dataclass(frozen=True, eq=False)
class ModelText:
    """A model for Drake.

    Attributes:
        file: for Drake's parser.
        meshes: what each OBJ file is, by its name; vertices in metres.
        rules: effort limits and joints that follow others, as the file gives them.
    """

    file: Path
    meshes: dict[str, RawMesh]
    rules: dict[str, JointRule]


def model_text(file: Path, folder: Path, dynamic: bool = False) -> ModelText:
    """A model for Drake, written into ``folder``; with its inertia only if it is to be ``dynamic``.

    Raises:
        FileFormatError: missing, not XML, neither URDF nor SDF, a mesh that is missing.
        UnsupportedError: xacro; meshes of kinds that nothing here reads.
    """
    kind = "sdf" if file.suffix.lower() in (".sdf", ".world") else "urdf"
    root = _sdf_root(file) if kind == "sdf" else robot_of(file)
    try:
        rules = dict(map(_rule, _joints(root)))
        _drop(root, _DROPPED if dynamic else (*_DROPPED, *_DYNAMIC))
        scaled = list(_meshes(root, kind))
    except FileFormatError as error:
        raise error.within(file) from error
    meshes: dict[str, RawMesh] = {}
    for number, (element, name, scale) in enumerate(scaled, start=1):
        place = f"mesh {name!r}"
        raw = read_mesh(resolve(name, file, place), place, file)
        vertices = raw.vertices * scale
        triangles = raw.triangles[:, ::-1] if np.prod(scale) < 0 else raw.triangles
        target = folder / f"mesh_{number}.obj"
        target.write_text(obj_text(vertices, np.ascontiguousarray(triangles)), encoding="ascii")
        meshes[target.name] = RawMesh(vertices, np.ascontiguousarray(triangles), raw.rounding * np.abs(scale).max())
        _point_to(element, target, kind)
    ElementTree.register_namespace("drake", _DRAKE)
    target = folder / f"model.{kind}"
    target.write_text(ElementTree.tostring(root, encoding="unicode"), encoding="utf-8")
    return ModelText(target, meshes, rules)


def _sdf_root(file: Path) -> ElementTree.Element:
    if problem := unreadable(file, "such file"):
        raise FileFormatError(problem, source=file, expected="a URDF or SDF file")
    try:
        root = ElementTree.fromstring(file.read_bytes())
    except (ElementTree.ParseError, LookupError, ValueError) as cause:
        raise FileFormatError("not XML", source=file, found=str(cause), expected="an SDF file") from cause
    if root.tag != "sdf":
        raise FileFormatError("not SDF", source=file, found=f"<{root.tag}>", expected="<sdf> as the root element")
    if root.find(".//include") is not None:
        raise UnsupportedError("SDF files that include others", source=file, expected="one file with the whole hand")
    return root


def _joints(root: ElementTree.Element) -> list[ElementTree.Element]:
    """The joints themselves, not what transmissions say of them."""
    return [joint for joint in root.iter("joint") if joint.get("type") and joint.get("name")]


def _rule(joint: ElementTree.Element) -> tuple[str, JointRule]:
    """What URDF has as attributes and SDF as elements."""
    limit, mimic = joint.find(".//limit"), joint.find(".//mimic")
    effort = _number(limit, "effort", 0.0)
    return joint.get("name", ""), JointRule(
        effort=effort if effort > 0 else None,
        follows=None if mimic is None else mimic.get("joint"),
        multiplier=_number(mimic, "multiplier", 1.0),
        offset=_number(mimic, "offset", 0.0),
    )


def _number(element: ElementTree.Element | None, key: str, default: float) -> float:
    text = None if element is None else element.get(key, element.findtext(key))
    if text is None:
        return default
    try:
        return float(text)
    except ValueError as cause:
        raise FileFormatError(f"{key!r} is no number", found=repr(text), expected="a number") from cause


def _drop(root: ElementTree.Element, tags: tuple[str, ...]) -> None:
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in tags:
                parent.remove(child)


def _meshes(root: ElementTree.Element, kind: str) -> Iterator[tuple[ElementTree.Element, str, np.ndarray]]:
    """Each mesh element with its file name and its scale, shape (3,)."""
    for mesh in root.iter("mesh"):
        name = (mesh.get("filename") if kind == "urdf" else mesh.findtext("uri")) or ""
        text = (mesh.get("scale") if kind == "urdf" else mesh.findtext("scale")) or "1 1 1"
        yield mesh, name.strip(), _scale(text, f"mesh {name.strip()!r}")


def _scale(text: str, place: str) -> np.ndarray:
    """One factor for all axes or one each, finite and not zero, shape (3,)."""
    expected = "one number or three, none of them 0"
    try:
        factors = np.array([float(word) for word in text.split()])
    except ValueError as cause:
        raise FileFormatError("'scale' cannot be read", place=place, found=repr(text), expected=expected) from cause
    if len(factors) not in (1, 3) or not np.isfinite(factors).all() or not factors.all():
        raise FileFormatError("'scale' cannot be used", place=place, found=repr(text), expected=expected)
    return factors * np.ones(3)


def _point_to(mesh: ElementTree.Element, target: Path, kind: str) -> None:
    if kind == "urdf":
        mesh.set("filename", str(target))
        mesh.attrib.pop("scale", None)
        return
    for child in list(mesh):
        mesh.remove(child)
    ElementTree.SubElement(mesh, "uri").text = str(target)
