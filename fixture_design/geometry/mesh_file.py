"""Reading a mesh file as it is: vertices and triangles, nothing merged, nothing repaired."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fixture_design.errors import FileFormatError, UnsupportedError
from fixture_design.geometry.shapes import Triangles, Vertices
from fixture_design.geometry.stl_check import faulty_line, stl_problem

#: What this version reads, by the end of the file's name.
MESH_ENDINGS = (".stl", ".dae", ".obj", ".ply")


def read_mesh(file: Path, place: str | None = None, source: Path | None = None) -> tuple[Vertices, Triangles]:
    """All triangles of a mesh file in its own unit, scenes flattened.

    Args:
        file: STL, DAE, OBJ or PLY.
        place, source: for messages, where another file refers to this one.

    Returns:
        vertices, shape (v, 3), and triangles, shape (t, 3); both empty for a file without any. COLLADA's own unit is
        not applied: `scale` is, once, for every kind of file.

    Raises:
        UnsupportedError: another kind of file.  FileFormatError: missing, or not readable as what its name says.
    """
    where = {"source": source or file, "place": place}
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
        scene = trimesh.load_scene(str(file), process=False)
        flat = scene.to_mesh()
        vertices, triangles = np.array(flat.vertices, dtype=np.float64), np.array(flat.faces, dtype=np.int64)
    except Exception as cause:  # readers raise whatever their parsers do; all of it means that the file is no such mesh
        kind = file.suffix[1:].upper()
        found = (is_stl and faulty_line(file)) or _first_line(cause)
        raise FileFormatError(f"{file.name} cannot be read as {kind}", found=found, **where) from cause
    return vertices.reshape(-1, 3), triangles.reshape(-1, 3)


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
