"""Round surfaces recognised in meshes: what they are, where, and what is not one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fixture_design.contacts import tangents
from fixture_design.geometry import PartGeometry, load_part
from fixture_design.geometry.round_fits import jacobian, normal_error
from fixture_design.geometry.smooth_surface import RoundShape, SmoothSurface
from tests.geometry.parts import Mesh, circle, loaded, part, prism, shared, unit

TURN = Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).as_matrix()


def moved(mesh: trimesh.Trimesh | Mesh) -> Mesh:
    vertices, triangles = (mesh.vertices, mesh.faces) if isinstance(mesh, trimesh.Trimesh) else mesh
    return np.array(vertices) @ TURN.T + np.array([0.1, -0.2, 0.05]), np.array(triangles)


def kinds(geometry: PartGeometry) -> list[str]:
    return [surface.kind for surface in geometry.smooth_surfaces]


def covered(geometry: PartGeometry) -> int:
    return sum(len(surface.facets) for surface in geometry.smooth_surfaces)


@pytest.mark.parametrize(
    ("mesh", "kind", "sizes"),
    [
        (trimesh.creation.cylinder(0.01, 0.03, sections=16), "cylinder", (0.01, 0)),
        (trimesh.creation.cylinder(0.01, 0.03, sections=128), "cylinder", (0.01, 0)),
        (trimesh.creation.icosphere(2, 0.02), "sphere", (0.02, 0)),
        (trimesh.creation.uv_sphere(0.02, count=[24, 24]), "sphere", (0.02, 0)),
        (trimesh.creation.torus(0.03, 0.01, 24, 16), "torus", (0.01, 0.03)),
        (trimesh.creation.torus(0.03, 0.01, 64, 48), "torus", (0.01, 0.03)),
        (trimesh.creation.cone(0.02, 0.03, sections=36), "cone", (np.arctan2(2, 3), 0)),
    ],
    ids=["shaft 16", "shaft 128", "icosphere", "sphere", "torus 24", "torus 64", "cone"],
)
def test_primitives_are_recognised_wherever_they_are(
    tmp_path: Path, mesh: trimesh.Trimesh, kind: str, sizes: tuple[float, float]
) -> None:
    geometry = loaded(tmp_path, moved(mesh))
    (surface,) = geometry.smooth_surfaces
    assert surface.kind == kind
    np.testing.assert_allclose((surface.radius, surface.ring), sizes, rtol=1e-9, atol=1e-12)
    if kind != "sphere":
        assert abs(surface.axis @ TURN[:, 2]) == pytest.approx(1, abs=1e-12)
    assert not surface.hollow
    assert surface.normal_error < 1e-9
    assert {geometry.provenance_of(int(facet)).kind for facet in surface.facets} == {"fitted"}
    # the caps of shafts and cones are flat, and stay so
    flats = set(range(len(geometry.facets))) - set(surface.facets.tolist())
    assert {geometry.provenance_of(facet).kind for facet in flats} <= {"exact"}


def test_a_bore_is_hollow_and_its_normal_points_to_its_axis(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, prism(circle(0.03, 4), 0.03, [circle(0.01, 24)]))
    (surface,) = geometry.smooth_surfaces
    assert (surface.kind, surface.hollow) == ("cylinder", True)
    np.testing.assert_allclose(surface.normal(np.array([0.006, 0.008, 0.01])), [-0.6, -0.8, 0], atol=1e-12)
    np.testing.assert_allclose(surface.project(np.array([0.0066, 0.0088, 0.01])), [0.006, 0.008, 0.01], atol=1e-15)
    assert surface.distance(np.array([0.0066, 0.0088, 0.01])) == pytest.approx(-0.001)


def test_flats_between_fillets_are_exact_and_fillets_are_fitted(tmp_path: Path) -> None:
    r, s, steps = 0.004, 0.04, 6
    outline = []
    for x, y, start in ((s - r, r, -90), (s - r, s - r, 0), (r, s - r, 90), (r, r, 180)):
        for angle in np.radians(start + np.linspace(0, 90, steps + 1)):
            outline.append([x + r * np.cos(angle), y + r * np.sin(angle)])
    geometry = loaded(tmp_path, prism(outline, 0.01))
    assert kinds(geometry) == ["cylinder"] * 4
    assert covered(geometry) == 4 * steps
    # narrow flats, no wider than the strips beside them, are tangent to the fillets all the same
    outline = [[x - 0.6 * 0.04 * (x > 0.02), y] for x, y in outline]
    narrow = loaded(tmp_path, prism([[x if x < 0.02 else x - 0.0065, y] for x, y in outline], 0.01))
    exact = [f for f in range(len(narrow.facets)) if narrow.provenance_of(f).kind == "exact"]
    assert len(exact) == 6


@pytest.mark.parametrize("cut", [0.5, 0.8, 0.95])
def test_a_flat_cut_into_a_shaft_is_no_part_of_it(tmp_path: Path, cut: float) -> None:
    """All four of its corners lie on the shaft, but it is deeper under it than the strips."""
    start = np.arccos(cut)
    angles = np.linspace(start, 2 * np.pi - start, 49)
    outline = (0.01 * np.column_stack([np.cos(angles), np.sin(angles)])).tolist()
    geometry = loaded(tmp_path, prism(outline, 0.03))
    (surface,) = geometry.smooth_surfaces
    assert len(surface.facets) == 48
    flat = next(i for i, f in enumerate(geometry.facets) if unit(f.normal)[0] > 0.999 and i not in surface.facets)
    assert geometry.provenance_of(flat).kind == "exact"


def test_symmetric_bevels_are_no_fillet(tmp_path: Path) -> None:
    """Three bevels of 22.5 degrees between two flats have their corners on a circle, whatever they are meant to be."""
    outline = [[0, 0], [0.04, 0], [0.04, 0.02], [0.037, 0.0275], [0.03, 0.0305], [0, 0.0305]]
    geometry = loaded(tmp_path, prism(outline, 0.03))
    assert geometry.smooth_surfaces == ()


def test_halves_of_a_bore_that_a_slot_cuts_are_one_surface(tmp_path: Path) -> None:
    angles = np.radians(np.arange(-170, 171, 5))
    right = [[0.01 * np.cos(a), 0.01 * np.sin(a)] for a in angles if np.cos(a) > 0.2]
    left = [[0.01 * np.cos(a), 0.01 * np.sin(a)] for a in np.radians(np.arange(100, 261, 5)) if np.cos(a) < -0.2]
    top, bottom = [[-0.0015, 0.02], [0.0015, 0.02]], [[0.0015, -0.02], [-0.0015, -0.02]]
    outline = [*right, [0.0015, 0.0098], top[1], top[0], [-0.0015, 0.0098], *left, [-0.0015, -0.0098]]
    hole = [*outline, bottom[1], bottom[0], [0.0015, -0.0098]]
    geometry = loaded(tmp_path, prism(circle(0.05, 4), 0.02, [hole]))
    assert kinds(geometry) == ["cylinder"]


def test_the_fit_is_as_good_as_the_vertices(tmp_path: Path) -> None:
    """What is said of the normal's error covers what it is, in three of four meshes and more."""
    rng = np.random.default_rng(5)
    for noise in (1e-8, 1e-7):
        vertices, triangles = moved(trimesh.creation.cylinder(0.01, 0.03, sections=48))
        shaken = vertices + noise * rng.uniform(-1, 1, vertices.shape)
        (surface,) = loaded(tmp_path, (shaken, triangles)).smooth_surfaces
        assert abs(surface.radius - 0.01) < noise
        there = (np.array([[0.01, 0, 0.0], [0, 0.01, 0.01], [0, -0.01, -0.01]])) @ TURN.T + np.array([0.1, -0.2, 0.05])
        true = np.array([[1, 0, 0], [0, 1, 0], [0, -1, 0]]) @ TURN.T
        off = [np.linalg.norm(surface.normal(point) - normal) for point, normal in zip(there, true, strict=True)]
        assert max(off) <= surface.normal_error < 300 * noise


@pytest.mark.parametrize("kind", ["cylinder", "cone", "sphere", "torus"])
def test_derivatives_of_offsets(kind: str) -> None:
    rng = np.random.default_rng(2)
    shape = RoundShape(kind, rng.normal(size=3), unit(rng.normal(size=3)), 0.4, 2.0 * (kind == "torus"))  # type: ignore[arg-type]
    points = rng.normal(size=(20, 3))
    given = jacobian(shape, shape.seen(points))
    for axis in range(3):
        step = 1e-6 * np.eye(3)[axis]
        ahead = RoundShape(shape.kind, shape.point + step, shape.axis, shape.radius, shape.ring).offsets(points)
        behind = RoundShape(shape.kind, shape.point - step, shape.axis, shape.radius, shape.ring).offsets(points)
        np.testing.assert_allclose(given[:, axis], (ahead - behind) / 2e-6, atol=1e-8)
    wider = RoundShape(shape.kind, shape.point, shape.axis, shape.radius + 1e-6, shape.ring).offsets(points)
    narrower = RoundShape(shape.kind, shape.point, shape.axis, shape.radius - 1e-6, shape.ring).offsets(points)
    np.testing.assert_allclose(given[:, 5], (wider - narrower) / 2e-6, atol=1e-8)
    for column, tangent in enumerate(tangents(shape.axis), start=3):
        tilted = [unit(shape.axis + step * tangent) for step in (1e-6, -1e-6)]
        ahead, behind = (replace(shape, axis=axis).offsets(points) for axis in tilted)
        np.testing.assert_allclose(given[:, column], (ahead - behind) / 2e-6, atol=1e-8)
    if kind == "torus":
        wider, narrower = (replace(shape, ring=2.0 + step).offsets(points) for step in (1e-6, -1e-6))
        np.testing.assert_allclose(given[:, 6], (wider - narrower) / 2e-6, atol=1e-8)


@pytest.mark.parametrize("kind", ["cylinder", "cone", "sphere", "torus"])
def test_slips_move_a_surface_along_itself(kind: str) -> None:
    rng = np.random.default_rng(4)
    shape = RoundShape(kind, rng.normal(size=3), unit(rng.normal(size=3)), 0.4, 2.0 * (kind == "torus"))  # type: ignore[arg-type]
    surface = SmoothSurface("s", shape, False, np.array([0]), 0.0, 0.0, 0.0)
    points = np.array([surface.project(point) for point in shape.point + rng.normal(size=(20, 3))])
    for slip in surface.slips():
        moves = slip[:3] + np.cross(slip[3:], points)
        np.testing.assert_allclose(np.einsum("ij,ij->i", moves, shape.directions(points)), 0, atol=1e-12)
    assert len(surface.slips()) == {"cylinder": 2, "sphere": 3}.get(kind, 1)


@pytest.mark.parametrize(
    ("path", "scale", "cylinders"),
    [
        ("trimesh/models/round.stl", 0.001, [(0.002235, True), (0.00254, False)]),
        (
            "IsaacGymEnvs/assets/factory/mesh/factory_insertion/factory_round_peg_16mm_tight.obj",
            1.0,
            [(0.0079971, False)],
        ),
        ("metaworld/metaworld/assets/objects/meshes/assembly_peg/assembly_peg_rod.stl", 1.0, [(0.012, False)]),
    ],
)
def test_real_shafts(path: str, scale: float, cylinders: list[tuple[float, bool]]) -> None:
    geometry = load_part(part(shared(path), scale))
    found = sorted((s.radius, s.hollow) for s in geometry.smooth_surfaces if s.kind == "cylinder")
    assert [hollow for _, hollow in found] == [hollow for _, hollow in cylinders]
    np.testing.assert_allclose([r for r, _ in found], [r for r, _ in cylinders], rtol=1e-3)
    rest = [f for f in range(len(geometry.facets)) if geometry.provenance_of(f).kind == "approximate"]
    assert rest == []


def test_a_real_torus_is_one() -> None:
    geometry = load_part(part(shared("trimesh/models/torus.STL"), 0.0254))
    assert kinds(geometry) == ["torus"]


def test_names_do_not_depend_on_the_order_of_triangles(tmp_path: Path) -> None:
    vertices, triangles = prism(circle(0.05, 4), 0.02, [circle(0.01, 24, (0.01, 0.01)), circle(0.01, 36, (-0.015, 0))])
    shuffled = np.random.default_rng(3).permutation(triangles)
    one, other = (loaded(tmp_path, (vertices, t)).smooth_surfaces for t in (triangles, shuffled))
    assert [s.name for s in one] == ["cylinder 1", "cylinder 2"]
    for first, second in zip(one, other, strict=True):
        np.testing.assert_allclose(first.point, second.point, atol=1e-12)


def test_surfaces_that_urdf_gives_are_exact(tmp_path: Path) -> None:
    file = tmp_path / "pin.urdf"
    file.write_text(
        '<robot name="pin"><link name="a"><collision><origin xyz="0.1 0 0" rpy="0.3 0.2 0"/><geometry>'
        '<capsule radius="0.004" length="0.02"/></geometry></collision></link></robot>'
    )
    for faceted in (False, True):
        geometry = load_part(replace(part(file), faceted=faceted))
        assert sorted(kinds(geometry)) == ["cylinder", "sphere", "sphere"]
        assert covered(geometry) == len(geometry.facets)
        assert {surface.normal_error for surface in geometry.smooth_surfaces} == {0.0}
        assert {geometry.provenance_of(facet).kind for facet in range(len(geometry.facets))} == {"exact"}


@pytest.mark.parametrize("oval", [1e-9, 1e-8, 3e-8])
def test_a_shaft_that_is_not_quite_round_says_so(tmp_path: Path, oval: float) -> None:
    """Its normals are off by more than noise would explain, and that is within what is said of them."""
    angles = 2 * np.pi * np.arange(100) / 100
    outline = np.column_stack([(0.01 + oval) * np.cos(angles), 0.01 * np.sin(angles)])
    (surface,) = loaded(tmp_path, prism(outline.tolist(), 0.03)).smooth_surfaces
    true = np.column_stack([np.cos(angles), (1 + oval / 0.01) * np.sin(angles)])
    off = [
        np.linalg.norm(surface.normal(np.array([*point, 0.01]))[:2] - unit(normal))
        for point, normal in zip(outline, true, strict=True)
    ]
    assert max(off) <= surface.normal_error < 1e-4


def test_too_little_of_a_torus_is_no_torus(tmp_path: Path) -> None:
    """What the vertices leave open is not known, and a surface that is not known is none."""
    shape = RoundShape("torus", np.zeros(3), np.array([0, 0, 1.0]), 0.01, 0.03)
    points = np.array([[0.04, 0, 0], [0.0399, 0.001, 0], [0.0399, -0.001, 0]])
    assert normal_error(shape, points, points, 1e-9, 1e-9, 1e-3) == np.inf
