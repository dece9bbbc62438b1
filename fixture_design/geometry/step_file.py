"""STEP: boundary surfaces cut up to triangles by OpenCASCADE, through the optional package cascadio."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.errors import FileFormatError, UnsupportedError

if TYPE_CHECKING:
    from trimesh import Scene

STEP_ENDINGS = (".step", ".stp")

#: Largest distance between triangles and the true surface [mm], the unit that OpenCASCADE converts to: `SURFACE_GAP`.
_SAG_MM = 0.01
#: Largest angle between the normals of neighbouring strips [rad]: well below `SMOOTH_ANGLE`.
_TURN = float(np.radians(10.0))


def step_scene(file: Path, place: str | None, source: Path) -> Scene:
    """All solids of a STEP file, in metres whatever the unit of the file.

    Raises:
        UnsupportedError: cascadio is not installed.  FileFormatError: OpenCASCADE cannot read the file.
    """
    try:
        import cascadio  # pyright: ignore[reportMissingImports]
    except ImportError as cause:
        raise UnsupportedError(
            f"reading STEP ({file.name}) needs the optional package cascadio",
            source=source,
            place=place,
            expected="it to be installed: pip install 'fixture-design[step]'",
        ) from cause
    import trimesh

    # cascadio says what is wrong on standard error only, and returns nothing
    glb = cascadio.to_glb_bytes(file.read_bytes(), tol_linear=_SAG_MM, tol_angular=_TURN)
    if not glb:
        raise FileFormatError(f"{file.name} cannot be read as STEP", source=source, place=place)
    return trimesh.load_scene(BytesIO(glb), file_type="glb", process=False)
