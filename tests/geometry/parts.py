"""Parts made on the spot, for geometry tests: triangle lists, files in several formats, and where real data lies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.geometry import PartGeometry, load_part
from fixture_design.layout import Element, Part, PointTip, Pose, SphereTip

Mesh = tuple[np.ndarray, np.ndarray]

#: Public parts that lie beside the repository on some machines; tests that use them skip elsewhere.
SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "data"


def shared(path: str) -> Path:
    """A file of the shared data, or a skip that says what is missing."""
    if not (SHARED / path).is_file():
        pytest.skip(f"no shared data beside the repository: {path}")
    return SHARED / path


def box(*sides: float) -> Mesh:
    """A box centred at the origin."""
    import trimesh

    mesh = trimesh.creation.box(sides)
    return np.array(mesh.vertices), np.array(mesh.faces)


def prism(outline: list[list[float]], height: float, holes: list[list[list[float]]] | None = None) -> Mesh:
    """An outline with holes, from z = 0 to ``height``, triangulated so that it is closed."""
    import shapely
    from shapely.geometry.polygon import orient

    shape = orient(shapely.Polygon(outline, holes or []))
    corners: list[list[float]] = [list(xy) for ring in (shape.exterior, *shape.interiors) for xy in ring.coords[:-1]]
    index = {tuple(xy): number for number, xy in enumerate(corners)}
    count = len(corners)
    flat = []
    for triangle in shapely.constrained_delaunay_triangles(shape).geoms:
        ring = orient(triangle).exterior.coords[:-1]
        flat.append([index[tuple(xy)] for xy in ring])
    top = np.array(flat) + count
    bottom = np.array(flat)[:, ::-1]
    walls = []
    for ring in (shape.exterior, *shape.interiors):
        numbers = [index[tuple(xy)] for xy in ring.coords[:-1]]
        for a, b in zip(numbers, numbers[1:] + numbers[:1], strict=True):
            walls += [[a, b, b + count], [a, b + count, a + count]]
    low = np.column_stack([corners, np.zeros(count)])
    return np.vstack([low, low + np.array([0, 0, height])]), np.vstack([bottom, top, walls])


def l_shape(side: float = 0.04, height: float = 0.02) -> Mesh:
    """An L with its inner edge along z at (side / 2, side / 2)."""
    half = side / 2
    return prism([[0, 0], [side, 0], [side, half], [half, half], [half, side], [0, side]], height)


def circle(radius: float, count: int, center: tuple[float, float] = (0.0, 0.0)) -> list[list[float]]:
    angles = 2 * np.pi * np.arange(count) / count
    return (np.array(center) + radius * np.column_stack([np.cos(angles), np.sin(angles)])).tolist()


def seven_eighths(side: float = 0.04) -> Mesh:
    """A cube [0, side]^3 without the octant at (side, side, side): voxels merged by their outer squares."""
    return voxels({(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)} - {(1, 1, 1)}, side / 2)


def voxels(cells: set[tuple[int, int, int]], size: float) -> Mesh:
    """The union of unit cells: two triangles for each square between full and empty."""
    vertices: dict[tuple[int, ...], int] = {}
    triangles = []
    for cell in sorted(cells):
        for axis in range(3):
            for side in (0, 1):
                step = np.eye(3, dtype=int)[axis] * (2 * side - 1)
                if tuple((np.array(cell) + step).tolist()) in cells:
                    continue
                first, second = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
                base = np.array(cell) + side * np.eye(3, dtype=int)[axis]
                square = [base, base + first, base + first + second, base + second]
                ids = [vertices.setdefault(tuple(corner.tolist()), len(vertices)) for corner in square]
                a, b, c, d = ids if side else ids[::-1]
                triangles += [[a, b, c], [a, c, d]]
    return np.array(list(vertices), dtype=float) * size, np.array(triangles)


def write(folder: Path, mesh: Mesh, name: str = "part.obj", factor: float = 1.0) -> Path:
    """The mesh, times a factor, as a file; OBJ by hand with all digits, the rest by trimesh."""
    vertices, triangles = mesh
    file = folder / name
    if file.suffix == ".obj":
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (vertices * factor).tolist()]
        file.write_text("\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles.tolist()]) + "\n")
    else:
        import trimesh

        trimesh.Trimesh(vertices * factor, triangles, process=False).export(file)
    return file


def part(file: Path, scale: float = 1.0) -> Part:
    kind = "urdf" if file.suffix == ".urdf" else "mesh"
    return Part(file.stem, kind, file, None, scale, Pose.identity(3))


def polygon_part(vertices: object, pose: Pose | None = None) -> Part:
    return Part("polygon", "polygon", None, np.array(vertices, dtype=float), 1.0, pose or Pose.identity(2))


def loaded(folder: Path, mesh: Mesh, name: str = "part.obj") -> PartGeometry:
    return load_part(part(write(folder, mesh, name)))


def element(at: object, radius: float | None = None, **more: object) -> Element:
    tip = PointTip() if radius is None else SphereTip(radius)
    return Element("E1", "locator", np.array(at, dtype=float), tip, **more)  # type: ignore[arg-type]


def unit(vector: object) -> np.ndarray:
    array = np.asarray(vector, dtype=float)
    return array / np.linalg.norm(array)
