"""The bracket: its files are what the script makes, and the mesh is the solid that the script's docstring draws."""

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh

BRACKET = Path(__file__).resolve().parents[2] / "urdf" / "bracket"
SCRIPT = BRACKET / "make_bracket.py"

# The drawing, in metres, independently of the script's constants.
PROFILE = np.array([[0, 0], [60, 0], [60, 10], [20, 10], [20, 25], [15, 30], [0, 30]]) / 1000
DEPTH, PLATE = 0.04, 0.01
HOLE, RADIUS, STRIPS = np.array([0.042, 0.02]), 0.006, 48
NANOMETRE = 1e-9  # the coordinates of the hole are rounded to it


@pytest.fixture(scope="module")
def mesh() -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3), read without any mesh library."""
    rows = [line.split() for line in (BRACKET / "bracket.obj").read_text().splitlines()]
    vertices = np.array([[float(value) for value in row[1:]] for row in rows if row[0] == "v"])
    faces = np.array([[int(value) - 1 for value in row[1:]] for row in rows if row[0] == "f"])
    return vertices, faces


def run_script(script: Path, *arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, script, *arguments], cwd=folder, capture_output=True, text=True, check=False)


def test_the_files_are_what_the_script_makes(tmp_path):
    done = run_script(SCRIPT, "--check", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_script_writes_next_to_itself_and_notices_a_change(tmp_path):
    folder, elsewhere = tmp_path / "bracket", tmp_path / "elsewhere"
    folder.mkdir()
    elsewhere.mkdir()
    script = folder / SCRIPT.name
    script.write_bytes(SCRIPT.read_bytes())
    assert run_script(script, "--check", folder=elsewhere).returncode == 1
    assert run_script(script, folder=elsewhere).returncode == 0
    assert not list(elsewhere.iterdir())
    for name in ("bracket.obj", "bracket.urdf"):
        assert (folder / name).read_bytes() == (BRACKET / name).read_bytes()
    (folder / "bracket.urdf").write_text("<robot/>")
    changed = run_script(script, "--check", folder=elsewhere)
    assert changed.returncode == 1
    assert "bracket.urdf: differs" in changed.stdout


def test_the_mesh_is_watertight_without_t_junctions(mesh):
    vertices, faces = mesh
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    directed = {tuple(edge) for edge in edges.tolist()}
    assert len(directed) == len(edges), "an edge is run through twice in the same direction"
    assert directed == {(b, a) for a, b in directed}, "an edge lacks its opposite"
    assert len(np.unique(vertices, axis=0)) == len(vertices)
    assert np.array_equal(np.unique(faces), np.arange(len(vertices)))
    assert len(vertices) - len(edges) // 2 + len(faces) == 0  # one body with one hole through it (genus 1)


def test_no_vertex_lies_inside_an_edge(mesh):
    vertices, faces = mesh
    for a, b in {
        tuple(sorted(edge)) for face in faces.tolist() for edge in zip(face, face[1:] + face[:1], strict=True)
    }:
        along = vertices[b] - vertices[a]
        t = (vertices - vertices[a]) @ along / (along @ along)
        off = np.linalg.norm(vertices - vertices[a] - np.outer(t, along), axis=1)
        assert not np.any((off < 10 * NANOMETRE) & (t > 1e-6) & (t < 1 - 1e-6)), (a, b)


def test_winding_is_outward_and_the_volume_is_right(mesh):
    vertices, faces = mesh
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    x, z = PROFILE.T
    profile_area = (x @ np.roll(z, -1) - z @ np.roll(x, -1)) / 2
    hole_area = STRIPS * RADIUS**2 * np.sin(2 * np.pi / STRIPS) / 2  # of the inscribed polygon
    assert volume == pytest.approx(profile_area * DEPTH - hole_area * PLATE, rel=1e-6)
    # Every triangle looks away from material: a point just outside is outside, one just inside is inside.
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    middle = (a + b + c) / 3
    assert not any(in_solid(point) for point in middle + 1e-6 * normals)
    assert all(in_solid(point) for point in middle - 1e-6 * normals)


def in_solid(point: np.ndarray) -> bool:
    """Whether a point lies in the solid of the drawing, with the hole as a polygon."""
    x, y, z = point
    half_step = np.pi / STRIPS
    angle = np.arctan2(y - HOLE[1], x - HOLE[0]) % (2 * half_step) - half_step
    in_hole = np.hypot(x - HOLE[0], y - HOLE[1]) * np.cos(angle) < RADIUS * np.cos(half_step)
    below_chamfer = (x - 0.015) + (z - 0.03) < 0
    in_profile = (0 < z < 0.03 and 0 < x < 0.02 and below_chamfer) or (0 < z < PLATE and 0 < x < 0.06)
    return bool(in_profile and 0 < y < DEPTH and not in_hole)


def test_the_hole_is_where_the_drawing_has_it(mesh):
    vertices, _ = mesh
    distance = np.linalg.norm(vertices[:, :2] - HOLE, axis=1)
    rim = vertices[distance < 0.01]
    assert len(rim) == 2 * STRIPS
    assert np.abs(np.linalg.norm(rim[:, :2] - HOLE, axis=1) - RADIUS).max() < NANOMETRE
    low, high = rim[rim[:, 2] == 0], rim[rim[:, 2] == PLATE]
    assert np.array_equal(low[:, :2], high[:, :2]), "the strips are not exactly upright"
    steps = np.diff(np.sort(np.arctan2(*(low[:, :2] - HOLE).T[::-1])))
    assert np.allclose(steps, 2 * np.pi / STRIPS, atol=1e-6)


def test_planar_faces_are_exactly_planar_and_corners_decimal(mesh):
    vertices, faces = mesh
    on_rim = np.linalg.norm(vertices[:, :2] - HOLE, axis=1) < 0.01
    assert np.array_equal(vertices[~on_rim], np.round(vertices[~on_rim], 3))
    assert np.array_equal(vertices, np.round(vertices, 9))
    normals = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    zeros = (normals == 0).sum(axis=1)  # cross products on the decimals, not within a tolerance
    wall = on_rim[faces].all(axis=1)
    assert wall.sum() == 2 * STRIPS
    assert np.all(normals[wall][:, 2] == 0)
    assert (zeros[~wall] == 2).sum() == (~wall).sum() - 2  # along an axis, but for the two triangles of the chamfer
    chamfer = normals[~wall][zeros[~wall] == 1]
    assert chamfer.shape == (2, 3)
    assert np.allclose(chamfer[:, 0], chamfer[:, 2], rtol=1e-12, atol=0)


def test_there_are_no_sliver_caps(mesh):
    vertices, faces = mesh
    corners = vertices[faces]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    assert (2 * areas / sides.max(axis=1)).min() > 1e-4  # a tenth of a millimetre


def test_the_urdf_has_the_mass_of_the_solid():
    link = ElementTree.parse(BRACKET / "bracket.urdf").getroot().find("link")
    assert link is not None
    body = trimesh.load(BRACKET / "bracket.obj", process=False)
    body.density = 2700.0
    inertial = {child.tag: child.attrib for child in link.find("inertial")}
    assert float(inertial["mass"]["value"]) == pytest.approx(body.mass, rel=1e-6)
    assert [float(v) for v in inertial["origin"]["xyz"].split()] == pytest.approx(body.center_mass, abs=2 * NANOMETRE)
    moments = [float(inertial["inertia"][key]) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
    assert moments == pytest.approx(body.moment_inertia[np.triu_indices(3)], rel=1e-5, abs=1e-12)
    for kind in ("visual", "collision"):
        assert [m.attrib["filename"] for m in link.findall(f"{kind}/geometry/mesh")] == ["bracket.obj"]


def test_drake_and_yourdfpy_read_the_urdf():
    import yourdfpy

    robot = yourdfpy.URDF.load(
        str(BRACKET / "bracket.urdf"), build_collision_scene_graph=True, load_collision_meshes=True
    )
    assert np.allclose(robot.collision_scene.bounds, [[0, 0, 0], [0.06, 0.04, 0.03]])
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder

    plant, _ = AddMultibodyPlantSceneGraph(DiagramBuilder(), 0.0)
    parser = Parser(plant)
    parser.SetStrictParsing()
    (model,) = parser.AddModels(str(BRACKET / "bracket.urdf"))
    plant.Finalize()
    assert len(plant.GetCollisionGeometriesForBody(plant.GetBodyByName("bracket", model))) == 1
    assert plant.CalcTotalMass(plant.CreateDefaultContext()) == pytest.approx(0.1036, rel=1e-3)


@pytest.mark.parametrize("name", ["bracket.obj", "bracket.urdf"])
def test_files_have_unix_line_ends_and_no_negative_zero(name):
    text = (BRACKET / name).read_bytes().decode("ascii")
    assert "\r" not in text
    assert text.endswith("\n")
    assert not re.search(r"-0\.0+(e[+-]\d+)?[\s\"]", text)
