"""Reading a mesh file as it is: vertices and triangles, nothing merged, nothing repaired."""

from __future__ import annotations

from pathlib import Path

from fixture_design.errors import FileFormatError, InputError, UnsupportedError
from fixture_design.geometry.scene import RawMesh, flattened
from fixture_design.geometry.step_file import STEP_ENDINGS, step_scene

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
    if file.suffix.lower() not in MESH_ENDINGS:
        raise UnsupportedError(
            f"cannot read meshes of kind {file.suffix or file.name!r}",
            expected=f"one of {', '.join(MESH_ENDINGS)}",
            **where,
        )
    if not file.is_file():
        raise FileFormatError(f"there is no mesh file {str(file)!r}", expected="an existing file", **where)
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
        raise FileFormatError(f"{file.name} cannot be read as {kind}", found=_first_line(cause), **where) from cause
    return flattened(scene)


def _first_line(cause: Exception) -> str:
    return f"{type(cause).__name__}: {(str(cause).splitlines() or [''])[0][:200]}"
