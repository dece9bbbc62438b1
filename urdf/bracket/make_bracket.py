r"""Makes bracket.obj and bracket.urdf, next to this file: a machined aluminium bracket, 60 x 40 x 30 mm.

An L profile with a chamfer, drawn out along y, with a round hole through its base plate along z::

    z                                     y
    30 +---.                           40 +-----+---------------------+
       |    \                             |     |        .-.          |
    25 |     +                         20 |     |       (   )         |
    10 |     +-----[hole]--------+        |     |        `-'          |
     0 +-----------[    ]--------+ x    0 +-----+---------------------+ x
       0     20      42         60        0     20       42          60

Every facet is triangulated on its own corners only, and neighbours share these, so that the mesh is watertight without
T-junctions. Coordinates are decimals, in metres: whole millimetres for the corners, rounded to a nanometre on the hole,
whose rings have the same (x, y) above and below. So every planar face is exactly planar, as are the hole's strips.

    python make_bracket.py            writes both files
    python make_bracket.py --check    changes nothing; exit code 1 if a file differs from what would be written
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import shapely

FOLDER = Path(__file__).resolve().parent

#: Corners (x, z) of the profile, counter-clockwise with x to the right and z up [m].
PROFILE = [(0, 0), (0.06, 0), (0.06, 0.01), (0.02, 0.01), (0.02, 0.025), (0.015, 0.03), (0, 0.03)]
#: Extent along y [m].
DEPTH = 0.04
#: Thickness of the base plate, through which the hole goes [m].
PLATE = 0.01
#: Axis (x, y) and radius of the hole [m], and the number of strips that stand for its wall.
HOLE_CENTER = (0.042, 0.02)
HOLE_RADIUS = 0.006
HOLE_STRIPS = 48
#: Of aluminium [kg/m^3].
DENSITY = 2700.0
#: Decimals of a coordinate in metres: nanometres.
DECIMALS = 9

Corner = tuple[float, float, float]
Triangle = tuple[Corner, Corner, Corner]


def hole_ring(z: float) -> list[Corner]:
    """The corners of the hole at a height, counter-clockwise seen from above."""
    angles = 2 * np.pi * np.arange(HOLE_STRIPS) / HOLE_STRIPS
    x = HOLE_CENTER[0] + HOLE_RADIUS * np.cos(angles)
    y = HOLE_CENTER[1] + HOLE_RADIUS * np.sin(angles)
    return [(round(float(a), DECIMALS), round(float(b), DECIMALS), z) for a, b in zip(x, y, strict=True)]


def facet(ring: list[Corner], hole: list[Corner] | None = None) -> list[Triangle]:
    """Triangles of a planar facet, on its corners alone.

    Args:
        ring: the outer corners, counter-clockwise seen from outside the body (the normal follows from them).
        hole: the corners of a hole in it.
    """
    corners = np.array(ring)
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)  # Newell: twice the area, outward
    dropped = int(np.argmax(np.abs(normal)))  # seen along this axis the facet keeps its shape
    kept = [axis for axis in range(3) if axis != dropped]
    corner_at = {(corner[kept[0]], corner[kept[1]]): corner for corner in [*ring, *(hole or [])]}
    seen, seen_hole = ([(corner[kept[0]], corner[kept[1]]) for corner in loop] for loop in (ring, hole or []))
    outline = shapely.Polygon(seen, [seen_hole] if hole else None)
    triangles = []
    for piece in shapely.constrained_delaunay_triangles(outline).geoms:
        a, b, c = (corner_at[point] for point in piece.exterior.coords[:3])
        outward = np.cross(np.subtract(b, a), np.subtract(c, a)) @ normal > 0
        triangles.append((a, b, c) if outward else (a, c, b))
    return triangles


def bracket_triangles() -> list[Triangle]:
    """The surface of the bracket, each triangle counter-clockwise seen from outside."""
    triangles = []
    for (x0, z0), (x1, z1) in zip(PROFILE, PROFILE[1:] + PROFILE[:1], strict=True):
        ring = [(x0, 0, z0), (x0, DEPTH, z0), (x1, DEPTH, z1), (x1, 0, z1)]
        pierced = z0 == z1 and z0 in (0, PLATE)
        triangles += facet(ring, hole_ring(z0) if pierced else None)
    triangles += facet([(x, 0, z) for x, z in PROFILE])
    triangles += facet([(x, DEPTH, z) for x, z in reversed(PROFILE)])
    low, high = hole_ring(0), hole_ring(PLATE)
    for k in range(HOLE_STRIPS):
        after = (k + 1) % HOLE_STRIPS
        triangles += [(low[k], high[k], high[after]), (low[k], high[after], low[after])]
    return triangles


def indexed(triangles: list[Triangle]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in order of their coordinates and triangles (m, 3) in order of their vertices.

    The order is the same whatever order the triangulation has.
    """
    vertices = sorted({corner for triangle in triangles for corner in triangle})
    number = {corner: k for k, corner in enumerate(vertices)}
    faces = []
    for triangle in triangles:
        a, b, c = (number[corner] for corner in triangle)
        faces.append(min((a, b, c), (b, c, a), (c, a, b)))
    return np.array(vertices, dtype=float), np.array(sorted(faces))


def mass_properties(vertices: np.ndarray, faces: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2] of a closed mesh, filled with aluminium.

    Sums over the tetrahedra (origin, a, b, c): volume a . (b X c) / 6, and with s = a + b + c second moments
    volume / 20 (a a^T + b b^T + c c^T + s s^T).
    """
    corners = vertices[faces]
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    sums = corners.sum(axis=1)
    volume = volumes.sum()
    center = volumes @ sums / (4 * volume)
    second = np.einsum("i,ikj,ikl->jl", volumes, corners, corners) + np.einsum("i,ij,il->jl", volumes, sums, sums)
    second = second / 20 - volume * np.outer(center, center)
    return DENSITY * volume, center, DENSITY * (np.trace(second) * np.eye(3) - second)


def obj_text(vertices: np.ndarray, faces: np.ndarray) -> str:
    """The mesh as a Wavefront OBJ file, in metres."""
    lines = ["# bracket, 60 x 40 x 30 mm, in metres; made by make_bracket.py", "o bracket"]
    lines += ["v " + " ".join(f"{value:.{DECIMALS}f}" for value in vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
    return "\n".join(lines) + "\n"


def urdf_text(mass: float, center: np.ndarray, inertia: np.ndarray) -> str:
    """The part as URDF: one link, its frame the mesh's."""
    numbers = {
        f"i{'xyz'[i]}{'xyz'[j]}": f"{round(float(inertia[i, j]), 12) + 0.0:.6e}" for i in range(3) for j in range(i, 3)
    }
    moments = " ".join(f'{name}="{value}"' for name, value in numbers.items())
    origin = " ".join(f"{value:.{DECIMALS}f}" for value in center)
    geometry = '<geometry><mesh filename="bracket.obj"/></geometry>'
    return f"""<?xml version="1.0"?>
<!-- A machined bracket, 60 x 40 x 30 mm, of aluminium ({DENSITY:.0f} kg/m^3); made by make_bracket.py. -->
<robot name="bracket">
  <link name="bracket">
    <inertial>
      <origin xyz="{origin}" rpy="0 0 0"/>
      <mass value="{mass:.9f}"/>
      <inertia {moments}/>
    </inertial>
    <visual>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      {geometry}
      <material name="aluminium"><color rgba="0.75 0.77 0.8 1"/></material>
    </visual>
    <collision>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      {geometry}
    </collision>
  </link>
</robot>
"""


def bracket_files() -> dict[str, str]:
    """What the files hold, by name."""
    vertices, faces = indexed(bracket_triangles())
    return {"bracket.obj": obj_text(vertices, faces), "bracket.urdf": urdf_text(*mass_properties(vertices, faces))}


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes bracket.obj and bracket.urdf next to this script.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a file differs")
    check = parser.parse_args().check
    differing = 0
    for name, text in bracket_files().items():
        path = FOLDER / name
        if check:
            same = path.is_file() and path.read_bytes() == text.encode()
            differing += not same
            print(f"{name}: {'as made' if same else 'differs from what this script makes; run it without --check'}")
        else:
            path.write_bytes(text.encode())
            print(f"{name}: written")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
