"""Reading a mesh file as it is: vertices and triangles, nothing merged, nothing repaired."""

from __future__ import annotations

import os
from pathlib import Path

from fixture_design.errors import FileFormatError, InputError, UnsupportedError
from fixture_design.geometry.scene import RawMesh, flattened
from fixture_design.geometry.step_file import STEP_ENDINGS, step_scene
from fixture_design.geometry.stl_check import faulty_line, stl_problem

#: What this version reads, by the end of the file's name.
MESH_ENDINGS = (".stl", ".dae", ".obj", ".ply", ".gltf", ".glb", ".3mf", *STEP_ENDINGS)


def read_mesh(file: Path, place: str | None = None, source: Path | None = None) -> RawMesh:
    """All triangles of a mesh file in its own unit, scenes flattened.

    Args:
        file: STL, DAE, OBJ, PLY, glTF, GLB, 3MF or STEP.
        place, source: for messages, where another file refers to this one.

    Returns:
        The numbers as they stand in the file, empty for a file without triangles. The units that COLLADA and 3MF files
        name are not applied: `scale` is, once, for every kind of file. glTF and STEP are in metres.

    Raises:
        UnsupportedError: another kind of file; STEP without its extra package.
        FileFormatError: missing, or not readable as what its name says.
    """
    where = {"source": source or file, "place": place}
    if os.path.isdir(file):  # a name may be too long for `Path.is_dir`
        raise FileFormatError(f"this is a folder: {str(file)!r:.200}", expected="a mesh", **where)
    if file.suffix.lower() not in MESH_ENDINGS:
        raise UnsupportedError(
            f"cannot read meshes of kind {file.suffix or file.name!r}",
            expected=f"one of {', '.join(MESH_ENDINGS)}",
            **where,
        )
    if problem := unreadable(file):
        raise FileFormatError(f"{problem}: {str(file)!r:.200}", expected="an existing file", **where)
    is_stl = file.suffix.lower() == ".stl"
    if is_stl and (wrong := stl_problem(file)):
        raise FileFormatError(wrong.problem, found=wrong.found, expected=wrong.expected, **where)
    import trimesh

    try:
        if file.suffix.lower() in STEP_ENDINGS:
            scene = step_scene(file, place, source or file)
        else:
            scene = trimesh.load_scene(str(file), process=False)
    except InputError:
        raise
    except Exception as cause:  # readers raise whatever their parsers do; all of it means that the file is no such mesh
        kind = file.suffix[1:].upper()
        found = (is_stl and faulty_line(file)) or _first_line(cause)
        raise FileFormatError(f"{file.name} cannot be read as {kind}", found=found, **where) from cause
    return flattened(scene)


def unreadable(file: Path, kind: str = "mesh file") -> str | None:
    """Why a file cannot be read, None if it can: missing, a folder, not permitted, a name that no file can have."""
    try:
        if file.is_dir():
            return "this is a folder"
        if file.exists() and not file.is_file():
            return "this is no regular file"
        with file.open("rb"):
            return None
    except FileNotFoundError:
        return f"there is no {kind}"
    except OSError as cause:
        return f"the {kind} cannot be read ({cause.strerror or cause})"
    except ValueError as cause:  # a NUL in the name
        return f"the {kind} cannot be read ({cause})"


def _first_line(cause: Exception) -> str:
    return f"{type(cause).__name__}: {(str(cause).splitlines() or [''])[0][:200]}"
