"""Loading meshes: formats, units, mending, and every way in which a file can be wrong."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import FileFormatError, GeometryError, InputError, UnsupportedError
from fixture_design.geometry import load_part
from fixture_design.layout import Part, Pose
from tests.geometry.parts import Mesh, box, l_shape, loaded, part, seven_eighths, shared, write

SIDES = (0.05, 0.03, 0.02)


def test_importing_geometry_loads_no_backend() -> None:
    code = (
        "import sys, fixture_design.geometry; print([m for m in sys.modules if m in ('pydrake', 'trimesh', 'shapely')])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize("ending", ["stl", "obj", "ply", "dae", "glb", "gltf", "3mf"])
@pytest.mark.parametrize(("unit", "scale"), [(1000.0, 0.001), (1 / 0.0254, 0.0254), (1.0, 1.0)])
def test_formats_and_units_give_the_same_box(tmp_path: Path, ending: str, unit: float, scale: float) -> None:
    geometry = load_part(part(write(tmp_path, box(*SIDES), f"box.{ending}", unit), scale))
    assert len(geometry.vertices) == 8
    assert len(geometry.triangles) == 12
    assert len(geometry.facets) == 6
    np.testing.assert_allclose(np.ptp(geometry.vertices, axis=0), SIDES, rtol=1e-6)
    np.testing.assert_allclose(geometry.box_center, 0, atol=1e-8)
    assert geometry.half_diagonal == pytest.approx(np.linalg.norm(SIDES) / 2, rel=1e-6)
    assert geometry.notes == ()


def test_size_outside_what_parts_have_is_noted_with_a_hint(tmp_path: Path) -> None:
    large, small = loaded(tmp_path, box(50, 30, 20)), loaded(tmp_path, box(5e-5, 3e-5, 2e-5))
    assert "scale" in large.notes[0]
    assert "0.001" in large.notes[0]
    assert "50 m" in large.notes[0]
    assert "scale" in small.notes[0]
    assert "50 um" in small.notes[0]


def test_inside_out_mesh_is_turned_and_noted(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    geometry = loaded(tmp_path, (vertices, triangles[:, ::-1]))
    assert any("inside out" in note for note in geometry.notes)
    assert geometry.surface.at(np.zeros(3))[0] == pytest.approx(-0.01)


def test_cavity_stays_a_cavity_and_disjoint_shells_are_fine(tmp_path: Path) -> None:
    (outer, first), (inner, second) = box(0.04, 0.04, 0.04), box(0.02, 0.02, 0.02)
    hollow = loaded(tmp_path, (np.vstack([outer, inner]), np.vstack([first, second[:, ::-1] + 8])))
    assert hollow.notes == ()
    assert not hollow.is_one_shell
    assert hollow.inside(np.array([[0, 0, 0], [0.015, 0, 0], [0.03, 0, 0]])).tolist() == [False, True, False]
    apart = loaded(tmp_path, (np.vstack([outer, inner + 1]), np.vstack([first, second[:, ::-1] + 8])))
    assert any("1 shells" in note for note in apart.notes)
    assert apart.inside(np.array([[0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5]])).tolist() == [True, True, False]


def test_needles_and_repeated_corners_are_taken_out(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    # a vertex in the middle of one edge, in one of the two triangles there only; the gap is closed by a needle
    first, second = triangles[0, :2]
    extra = (vertices[first] + vertices[second]) / 2
    split = [[first, 8, triangles[0, 2]], [8, second, triangles[0, 2]], [first, second, 8], [0, 0, 1]]
    geometry = loaded(tmp_path, (np.vstack([vertices, extra]), np.vstack([triangles[1:], split])))
    assert any("2 triangles without area" in note for note in geometry.notes)
    assert len(geometry.facets) == 6
    assert len(geometry.triangles) == 14
    assert geometry.surface.at(np.array([0.0, 0.0, 0.03]))[0] == pytest.approx(0.02)


def test_noise_between_equal_vertices_is_merged(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    soup = vertices[triangles].reshape(-1, 3)
    noisy = soup + np.random.default_rng(1).uniform(-1e-12, 1e-12, soup.shape)
    assert len(loaded(tmp_path, (noisy, np.arange(36).reshape(-1, 3))).vertices) == 8


@pytest.mark.parametrize(
    ("name", "text", "error", "words"),
    [
        ("empty.obj", "", GeometryError, ["no triangles"]),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", GeometryError, ["no triangles"]),
        ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n", GeometryError, ["not finite", "nan"]),
        ("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", GeometryError, ["flat"]),
        ("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", FileFormatError, ["OBJ"]),
        ("broken.ply", "garbage", FileFormatError, ["PLY", "Not a ply file"]),
        ("broken.dae", "<a>", FileFormatError, ["DAE"]),
        ("broken.glb", "garbage", FileFormatError, ["GLB"]),
        ("broken.gltf", "garbage", FileFormatError, ["GLTF"]),
        ("buffer.gltf", '{"asset": {"version": "2.0"}, "buffers": [{"uri": "gone.bin", "byteLength": 4}]}',
         FileFormatError, ["GLTF", "gone.bin"]),
        ("broken.3mf", "garbage", FileFormatError, ["3MF", "zip"]),
        ("part.igs", "", UnsupportedError, [".igs", ".stl"]),
    ],
)  # fmt: skip
def test_bad_mesh_files_say_what_is_wrong(
    tmp_path: Path, name: str, text: str, error: type[InputError], words: list[str]
) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(error) as caught:
        load_part(part(tmp_path / name))
    for word in [name, *words]:
        assert word in str(caught.value)


def test_missing_file_and_step_and_polygon(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"no mesh file.*gone\.stl"):
        load_part(part(tmp_path / "gone.stl"))
    with pytest.raises(FileFormatError, match=r"no mesh file.*gone\.step"):
        load_part(Part("a", "step", tmp_path / "gone.step", None, 1.0, Pose.identity(3)))
    with pytest.raises(FileFormatError, match=r"a\.stl is not STEP; expected a name that ends in \.step or \.stp"):
        load_part(Part("a", "step", tmp_path / "a.stl", None, 1.0, Pose.identity(3)))
    with pytest.raises(GeometryError, match="solid"):
        load_part(Part("a", "polygon", None, np.eye(2), 1.0, Pose.identity(2)))
    with pytest.raises(GeometryError, match="scale"):
        load_part(part(write(tmp_path, box(1, 1, 1)), scale=float("nan")))


def test_step_without_its_package_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cascadio", None)
    (tmp_path / "a.stp").write_text("ISO-10303-21;")
    for kind in ("step", "mesh"):
        with pytest.raises(UnsupportedError, match=r"a\.stp.*pip install 'fixture-design\[step\]'"):
            load_part(Part("a", kind, tmp_path / "a.stp", None, 1.0, Pose.identity(3)))


def test_step_that_is_none_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("cascadio", reason="the extra `step` is not installed")
    (tmp_path / "a.step").write_text("garbage")
    with pytest.raises(FileFormatError, match=r"a\.step cannot be read as STEP"):
        load_part(Part("a", "step", tmp_path / "a.step", None, 1.0, Pose.identity(3)))


def test_step_is_the_same_part_as_its_mesh() -> None:
    pytest.importorskip("cascadio", reason="the extra `step` is not installed")
    mesh = load_part(part(shared("trimesh/models/featuretype.STL"), 0.0254))
    step = load_part(Part("a", "step", shared("trimesh/models/featuretype.STEP"), None, 1.0, Pose.identity(3)))
    for end in ("low", "high"):
        np.testing.assert_allclose(getattr(step, end), getattr(mesh, end), atol=1e-7)
    assert step.is_one_shell
    # each other's vertices lie on the surface, up to the chords of either
    rng = np.random.default_rng(2)
    for one, other in ((mesh, step), (step, mesh)):
        points = one.vertices[rng.choice(len(one.vertices), 200)]
        assert max(abs(other.surface.at(point)[0]) for point in points) < 1e-4
    flats = [sorted(np.linalg.norm(facet.normal) for facet in g.facets)[-6:] for g in (mesh, step)]
    np.testing.assert_allclose(flats[0], flats[1], rtol=2e-3)


def test_scenes_are_flattened_and_keep_the_digits_of_their_file(tmp_path: Path) -> None:
    import trimesh

    vertices, triangles = box(0.03, 0.02, 0.01)
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    scene = trimesh.Scene()
    turned = trimesh.transformations.euler_matrix(0.3, 0.4, 0.5)
    mirrored = np.diag([-1.0, 1, 1, 1])
    mirrored[0, 3] = 0.1
    scene.add_geometry(mesh, "a", transform=turned)
    scene.add_geometry(mesh, "b", geom_name="a", transform=mirrored)
    scene.export(tmp_path / "two.glb")
    geometry = load_part(part(tmp_path / "two.glb"))
    assert geometry.notes == ()
    assert len(geometry.facets) == 12
    assert geometry.inside(np.array([[0.0, 0, 0], [0.1, 0, 0], [0.05, 0, 0]])).tolist() == [True, True, False]
    # single precision, whatever the scene did with it
    assert geometry.rounding.max() > 1e-10


def test_open_mesh_names_edges_and_a_place(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    with pytest.raises(GeometryError, match=r"part\.obj.* 3 open edges.*found one at \[.*expected a closed"):
        loaded(tmp_path, (vertices, triangles[1:]))


def test_one_triangle_turned_round_is_an_error(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    turned = np.vstack([triangles[:1, ::-1], triangles[1:]])
    with pytest.raises(GeometryError, match="3 edges whose two triangles are wound against each other"):
        loaded(tmp_path, (vertices, turned))


@pytest.mark.parametrize("mesh", [l_shape(), seven_eighths()], ids=["L", "7/8"])
def test_non_convex_parts_are_known_inside_and_out(tmp_path: Path, mesh: Mesh) -> None:
    geometry = loaded(tmp_path, mesh)
    low, high = geometry.low, geometry.high
    assert geometry.surface.at(high - 0.1 * (high - low))[0] > 0
    assert geometry.surface.at(low + 0.1 * (high - low))[0] < 0


@pytest.mark.parametrize(
    ("path", "scale", "size", "facets"),
    [
        ("trimesh/models/featuretype.STL", 0.0254, (0.127, 0.0635, 0.034925), 844),
        (
            "airo-models/airo_models/grippers/fingertips/originals/robotiq_adapter.stl",
            0.001,
            (0.0321, 0.019, 0.057),
            12911,
        ),
    ],
)
def test_real_parts(path: str, scale: float, size: tuple[float, ...], facets: int) -> None:
    geometry = load_part(part(shared(path), scale))
    np.testing.assert_allclose(np.ptp(geometry.vertices, axis=0), size, rtol=1e-5)
    assert len(geometry.facets) == facets
    # the area vectors of a closed surface add up to nothing
    normals = np.array([facet.normal for facet in geometry.facets])
    assert np.abs(normals.sum(axis=0)).max() < 1e-12 * np.abs(normals).sum()
    # flats of a machined part are exact, and most of its surface
    largest = sorted(geometry.facets, key=lambda facet: -np.linalg.norm(facet.normal))[:6]
    assert {(facet.provenance.kind, facet.normal_error) for facet in largest} == {("exact", 0.0)}


def test_real_part_with_holes_is_refused() -> None:
    path = "airo-models/airo_models/grippers/fingertips/originals/camera_arduino_holder.stl"
    with pytest.raises(GeometryError, match=r"camera_arduino_holder\.stl.*open edges.*a crack 0\.0076\d* um wide"):
        load_part(part(shared(path), 0.001))


def test_real_part_with_degenerate_triangles_is_mended() -> None:
    path = "IsaacGymEnvs/assets/industreal/mesh/industreal_gears/industreal_gear_small.obj"
    geometry = load_part(part(shared(path)))
    assert any("triangles without area" in note for note in geometry.notes)
    assert geometry.surface.at(geometry.high + 0.01)[0] > 0.01
