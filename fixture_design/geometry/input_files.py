"""The files that a layout depends on, each with the hash of what it held: what exactly a verdict is about."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

from fixture_design.geometry.package import resolve
from fixture_design.geometry.urdf_tree import robot_of
from fixture_design.layout import Layout


@dataclass(frozen=True)
class InputFile:
    """``sha256`` of the bytes of a ``file``, None where it is not there, and its ``role``: "layout", "part", "body
    vblock", "load cutting".
    """

    role: str
    file: Path
    sha256: str | None


def input_files(layout: Layout) -> tuple[InputFile, ...]:
    """The layout's own file, its part, bodies and load paths, with the meshes that URDF files name.

    Raises:
        FileFormatError: a file that is missing.
    """
    named = [("layout", layout.source)] if layout.source is not None and layout.source.is_file() else []
    if layout.part is not None and layout.part.file is not None:
        named += [("part", file) for file in with_meshes(layout.part.file)]
    named += [(f"body {body.name}", file) for body in layout.bodies for file in with_meshes(body.file)]
    named += [(f"load {load.name}", load.path) for load in layout.loads if load.path is not None]
    return tuple(InputFile(role, file, _sha256(file)) for role, file in dict.fromkeys(named))


def with_meshes(file: Path) -> list[Path]:
    """A file with the files that it names: meshes of a URDF, buffers of a glTF.

    Raises:
        InputError: it cannot be read, or a mesh is not there.
    """
    meshes = files_named_in(file)
    return list(dict.fromkeys([file, *meshes, *(buffer for mesh in meshes for buffer in files_named_in(mesh))]))


def files_named_in(file: Path) -> tuple[Path, ...]:
    """The meshes that a URDF names, the buffers that a glTF names; none of other files.

    Raises:
        InputError: a URDF that cannot be read, or a mesh that is not there.
    """
    ending = file.suffix.lower()
    if ending == ".gltf":
        return _buffers_of(file)
    if ending != ".urdf":
        return ()
    meshes = [mesh.get("filename", "") for mesh in robot_of(file).iter() if _is_mesh(mesh)]
    return tuple(dict.fromkeys(resolve(name, file, f"mesh {name!r}") for name in meshes if name))


def _buffers_of(file: Path) -> tuple[Path, ...]:
    """The files with a glTF's numbers, but for those that are not there; none where it is no glTF that can be read."""
    try:
        buffers = json.loads(file.read_bytes()).get("buffers", [])
        names = [buffer["uri"] for buffer in buffers if "uri" in buffer]
    except (OSError, ValueError, AttributeError, TypeError):  # loading it says what is wrong
        return ()
    found = [file.parent / unquote(name) for name in names if isinstance(name, str) and not name.startswith("data:")]
    return tuple(buffer for buffer in found if buffer.is_file())


def _is_mesh(element: ElementTree.Element) -> bool:
    return str(element.tag).rpartition("}")[2] == "mesh"


def _sha256(file: Path) -> str | None:
    if not file.is_file():  # a load path that no stage uses
        return None
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
