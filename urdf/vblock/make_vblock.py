r"""Makes the files of a V-block with a bar in it, next to this script: vblock, bar and stop, each as OBJ and URDF.

All three are profiles (x, z) drawn out along y, in millimetres::

    vblock                            bar                     stop
    30 .--.          .--.        40 .-------.            20 .----.
       |   \        /   |           |       |               |    |
       |     \    /     |        20 \       /               |    |
     0 |       \/       |             \   /               1 '----'
   -10 '----------------'         0     v                 -10    10
     -40  -30  0  30   40          -20  0  20

    python make_vblock.py            writes the files
    python make_vblock.py --check    changes nothing; exit code 1 if a file differs from what would be written
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import shapely

FOLDER = Path(__file__).resolve().parent

#: Corners (x, z) of each profile, counter-clockwise with x to the right and z up, and its extent along y [m].
SOLIDS = {
    "vblock": (
        [(0, 0), (0.03, 0.03), (0.04, 0.03), (0.04, -0.01), (-0.04, -0.01), (-0.04, 0.03), (-0.03, 0.03)],
        (-0.06, 0.0),
    ),
    "bar": ([(0, 0), (0.02, 0.02), (0.02, 0.04), (-0.02, 0.04), (-0.02, 0.02)], (-0.055, -0.005)),
    "stop": ([(-0.01, 0.001), (0.01, 0.001), (0.01, 0.02), (-0.01, 0.02)], (-0.065, -0.055)),
}
#: Of steel [kg/m^3].
DENSITY = 7850.0


def prism(profile: list[tuple[float, float]], low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3) of a profile (x, z) drawn out along y; neighbours share their corners."""
    outline = shapely.geometry.polygon.orient(shapely.Polygon(profile))
    corners = [(float(x), float(z)) for x, z in outline.exterior.coords[:-1]]
    number = {corner: k for k, corner in enumerate(corners)}
    count = len(corners)
    front = []
    for piece in shapely.constrained_delaunay_triangles(outline).geoms:
        ring = shapely.geometry.polygon.orient(piece).exterior.coords[:-1]
        front.append([number[float(x), float(z)] for x, z in ring])
    # x to the right and z up is seen from -y
    triangles = [*front, *([c + count, b + count, a + count] for a, b, c in front)]
    for k in range(count):
        after = (k + 1) % count
        triangles += [[k, k + count, after], [after, k + count, after + count]]
    vertices = np.array([(x, y, z) for y in (low, high) for x, z in corners])
    return vertices, np.array(triangles)


def obj_text(name: str, vertices: np.ndarray, triangles: np.ndarray) -> str:
    """The mesh as a Wavefront OBJ file, in metres."""
    lines = [f"# {name}, in metres; made by make_vblock.py", f"o {name}"]
    lines += ["v " + " ".join(f"{value:.3f}" for value in vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(k + 1) for k in triangle) for triangle in triangles]
    return "\n".join(lines) + "\n"


def urdf_text(name: str, volume: float) -> str:
    """One link with the mesh; its mass, and no inertia, since nothing here moves it."""
    geometry = f'<geometry><mesh filename="{name}.obj"/></geometry>'
    return f"""<?xml version="1.0"?>
<!-- {name}: {DENSITY * volume:.3f} kg of steel; made by make_vblock.py. -->
<robot name="{name}">
  <link name="{name}">
    <visual>{geometry}</visual>
    <collision>{geometry}</collision>
  </link>
</robot>
"""


def files() -> dict[str, str]:
    """What the files hold, by name."""
    found = {}
    for name, (profile, (low, high)) in SOLIDS.items():
        vertices, triangles = prism(profile, low, high)
        found[f"{name}.obj"] = obj_text(name, vertices, triangles)
        found[f"{name}.urdf"] = urdf_text(name, shapely.Polygon(profile).area * (high - low))
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the files of the V-block next to this script.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a file differs")
    check = parser.parse_args().check
    differing = 0
    for name, text in files().items():
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
