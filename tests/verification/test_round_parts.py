"""Shafts, rings, tori and spheres: whatever touches them from outside, they can spin; a flat or a key stops that.

Contacts are drawn on the mesh as a user would pick them, on facets, edges and corners; the verdict is about the round
part that the mesh stands for, and does not depend on how fine the mesh is.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fixture_design.geometry import PartGeometry, load_part
from fixture_design.layout import Answer, Element, Layout
from fixture_design.verification import check, verify
from tests.geometry.parts import Mesh, circle, part, prism, shared, write

TURN = Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).as_matrix()


def stepped(count: int) -> Mesh:
    """A shaft of two diameters with a chamfer between them, around z."""
    profile = [[0.0, 0.0], [0.008, 0.0], [0.008, 0.015], [0.009, 0.016], [0.012, 0.016], [0.012, 0.03], [0.0, 0.03]]
    mesh = trimesh.creation.revolve(profile, sections=count)
    return np.array(mesh.vertices), np.array(mesh.faces)


def d_shaft(count: int) -> Mesh:
    """A shaft with a flat, around z."""
    angles = np.linspace(0.6, 2 * np.pi - 0.6, count)
    return prism((0.01 * np.column_stack([np.cos(angles), np.sin(angles)])).tolist(), 0.03)


def meshed(mesh: trimesh.Trimesh) -> Mesh:
    return np.array(mesh.vertices), np.array(mesh.faces)


def layouts(file: Path, rng: np.random.Generator, count: int, contacts: int, scale: float = 1.0) -> list[Layout]:
    """Layouts with elements on facets, edges and corners of the mesh."""
    geometry = load_part(part(file, scale))
    return [replace(_layout(geometry, rng, contacts), part=part(file, scale)) for _ in range(count)]


def _layout(geometry: PartGeometry, rng: np.random.Generator, contacts: int) -> Layout:
    areas = np.linalg.norm(
        np.cross(*(np.diff(geometry.vertices[geometry.triangles], axis=1).transpose(1, 0, 2))), axis=1
    )
    elements = []
    for number in range(contacts):
        corners = geometry.vertices[geometry.triangles[rng.choice(len(areas), p=areas / areas.sum())]]
        weights = rng.dirichlet([1, 1, 1])
        if number % 5 == 4:
            weights[rng.integers(3)] = 0.0
        elements.append(Element(f"E{number}", "locator", weights @ corners / weights.sum()))
    return Layout("round", elements=tuple(elements), surface_gap=1e-4)


ROUND = {
    "shaft 12": lambda: prism(circle(0.01, 12), 0.03),
    "shaft 36": lambda: prism(circle(0.01, 36), 0.03),
    "shaft 120": lambda: prism(circle(0.01, 120), 0.03),
    "stepped 24": lambda: stepped(24),
    "stepped 90": lambda: stepped(90),
    "tube": lambda: prism(circle(0.02, 48), 0.03, [circle(0.015, 40)]),
    "torus 24": lambda: meshed(trimesh.creation.torus(0.03, 0.01, 24, 16)),
    "torus 48": lambda: meshed(trimesh.creation.torus(0.03, 0.01, 48, 24)),
    "sphere": lambda: meshed(trimesh.creation.icosphere(3, 0.02)),
    "cone": lambda: meshed(trimesh.creation.cone(0.02, 0.03, sections=48)),
}
COARSE = {
    "shaft 6": lambda: prism(circle(0.01, 6), 0.03),
    "shaft 8": lambda: prism(circle(0.01, 8), 0.03),
    "shaft 10": lambda: prism(circle(0.01, 10), 0.03),
    "torus 8": lambda: meshed(trimesh.creation.torus(0.03, 0.01, 8, 8)),
    "sphere 8": lambda: meshed(trimesh.creation.uv_sphere(0.02, count=[8, 8])),
}


@pytest.mark.parametrize("turned", [False, True], ids=["square", "turned"])
@pytest.mark.parametrize("name", ROUND)
def test_round_parts_are_never_closed_and_spin(tmp_path: Path, name: str, turned: bool) -> None:
    rng = np.random.default_rng([7, len(name), turned])
    vertices, triangles = ROUND[name]()
    moved = vertices @ TURN.T + np.array([0.1, 0.2, -0.1]) if turned else vertices
    # as a binary STL leaves them: float32
    file = write(tmp_path, (moved.astype(np.float32).astype(float), triangles))
    for contacts in (8, 24):
        for layout in layouts(file, rng, 3, contacts):
            verdict = verify(layout)
            findings = verdict.groups["all"].findings
            assert findings["form_closure"].answer is Answer.NO, findings["form_closure"].reason
            assert findings["accessible"].answer is Answer.YES
            assert findings["deterministic"].answer is Answer.NO
            assert check(verdict) == []


@pytest.mark.parametrize("name", COARSE)
def test_coarse_round_parts_are_never_called_closed(tmp_path: Path, name: str) -> None:
    rng = np.random.default_rng([8, len(name)])
    file = write(tmp_path, COARSE[name]())
    for layout in layouts(file, rng, 6, 24):
        assert verify(layout).groups["all"].findings["form_closure"].answer is not Answer.YES


def around(angles: np.ndarray, radius: float = 0.02, height: float = 0.05) -> Mesh:
    return prism((radius * np.column_stack([np.cos(angles), np.sin(angles)])).tolist(), height)


@pytest.mark.parametrize(
    ("count", "extra"), [(24, (4, -19)), (36, (2.5, -12.5)), (36, (5, -15)), (60, (1.5, -7.5)), (120, (0.8, -3.8))]
)
def test_a_strip_between_narrower_ones_is_a_strip(tmp_path: Path, count: int, extra: tuple[float, float]) -> None:
    """As an imprinted edge or a cross hole leaves it: no flat that would keep the shaft from turning."""
    angles = np.sort(np.concatenate([2 * np.pi * np.arange(count) / count, np.radians(extra) % (2 * np.pi)]))
    file = write(tmp_path, around(angles))
    step = 2 * np.pi / count
    strip = [(-0.9 * step, 0.01), (-0.9 * step, 0.04), (-0.1 * step, 0.01), (-0.1 * step, 0.04)]
    sides = [(np.radians(a), z) for a in (115, 235) for z in (0.01, 0.04)]
    at = [[0.02 * np.cos(a), 0.02 * np.sin(a), z] for a, z in (*strip, *sides)]
    at += [[0.01 * np.cos(a), 0.01 * np.sin(a), z] for a in (0, 2, 4) for z in (0, 0.05)]
    elements = tuple(Element(f"E{i}", "locator", np.array(point)) for i, point in enumerate(at))
    verdict = verify(Layout("imprint", part=part(file), elements=elements, surface_gap=2e-4))
    assert verdict.groups["all"].findings["form_closure"].answer is Answer.NO
    assert verdict.groups["all"].findings["deterministic"].answer is Answer.NO


@pytest.mark.parametrize(("count", "uneven"), [(6, 0.002), (6, 0.02), (8, 0.002), (8, 0.01), (10, 0.005)])
def test_coarse_and_uneven_shafts_are_never_called_closed(tmp_path: Path, count: int, uneven: float) -> None:
    rng = np.random.default_rng(count)
    file = write(tmp_path, around(2 * np.pi * np.arange(count) / count + uneven * rng.uniform(-1, 1, count)))
    for layout in layouts(file, rng, 4, 24):
        assert verify(layout).groups["all"].findings["form_closure"].answer is not Answer.YES


@pytest.mark.parametrize("steps", [4, 5, 6, 12])
def test_half_round_parts_are_not_located_by_their_round_side(tmp_path: Path, steps: int) -> None:
    angles = np.pi * np.arange(steps + 1) / steps
    file = write(tmp_path, around(angles))
    middles = (angles[1:] + angles[:-1]) / 2
    at = [
        [0.02 * np.cos(np.pi / steps / 2) * f(a) for f in (np.cos, np.sin)] + [z] for a in middles for z in (0.01, 0.04)
    ]
    at += [[0.004, 0.008, 0.0], [-0.004, 0.008, 0.0], [0.0, 0.004, 0.05]]
    elements = tuple(Element(f"E{i}", "locator", np.array(point)) for i, point in enumerate(at))
    verdict = verify(Layout("half", part=part(file), elements=elements, surface_gap=1e-4))
    assert verdict.groups["all"].findings["deterministic"].answer is not Answer.YES


@pytest.mark.parametrize("count", [40, 120])
def test_a_flat_stops_the_spin(tmp_path: Path, count: int) -> None:
    file = write(tmp_path, d_shaft(count))
    x = 0.01 * np.cos(0.6)
    at = [[x, -0.004, 0.01], [x, 0.004, 0.02], [x, 0.004, 0.01], [0.004, 0.004, 0.03], [0, 0, 0.0]]
    for angle, z in ((1.2, 0.005), (2.4, 0.025), (3.7, 0.01), (5.0, 0.02), (np.pi, 0.015), (2.0, 0.02)):
        at.append([0.01 * np.cos(angle), 0.01 * np.sin(angle), z])
    elements = tuple(Element(f"E{i}", "locator", np.array(point)) for i, point in enumerate(at))
    layout = Layout("keyed", part=part(file), elements=elements, surface_gap=1e-4)
    assert verify(layout).groups["all"].findings["form_closure"].answer is Answer.YES
    free = replace(layout, elements=elements[3:])
    assert verify(free).groups["all"].findings["form_closure"].answer is Answer.NO


@pytest.mark.parametrize(
    ("path", "scale"),
    [
        ("trimesh/models/round.stl", 0.001),
        ("trimesh/models/torus.STL", 0.0254),
        ("metaworld/metaworld/assets/objects/meshes/assembly_peg/assembly_peg_rod.stl", 1.0),
        ("metaworld/metaworld/assets/objects/meshes/assembly_peg/assembly_peg_ring.stl", 1.0),
        ("metaworld/metaworld/assets/objects/meshes/hammer/nail.stl", 1.0),
        ("IsaacGymEnvs/assets/factory/mesh/factory_insertion/factory_round_peg_8mm_loose.obj", 1.0),
    ],
)
def test_real_round_parts_are_never_closed(path: str, scale: float) -> None:
    rng = np.random.default_rng([10, len(path)])
    for layout in layouts(shared(path), rng, 4, 24, scale):
        assert verify(layout).groups["all"].findings["form_closure"].answer is not Answer.YES


def test_prismatic_parts_slide(tmp_path: Path) -> None:
    """Contacts on the walls of an extrusion leave it free along them, though the normals of oblique walls are off."""
    outline = [[0, 0], [0.05, 0.01], [0.06, 0.04], [0.02, 0.05], [-0.01, 0.03]]
    vertices, triangles = prism(outline, 0.03)
    file = write(tmp_path, ((vertices @ TURN.T).astype(np.float32).astype(float), triangles))
    geometry = load_part(part(file))
    walls = [f for f in geometry.facets if abs(f.normal @ TURN[:, 2]) < 1e-3 * np.linalg.norm(f.normal)]
    assert len(walls) == 5
    rng = np.random.default_rng(3)
    elements = []
    for number in range(15):
        corners = geometry.vertices[geometry.triangles[rng.choice(walls[number % 5].triangles)]]
        elements.append(Element(f"E{number}", "locator", rng.dirichlet([2, 2, 2]) @ corners))
    verdict = verify(Layout("slides", part=part(file), elements=tuple(elements), surface_gap=1e-4))
    findings = verdict.groups["all"].findings
    assert findings["form_closure"].answer is Answer.NO
    assert findings["deterministic"].answer is Answer.NO
    assert check(verdict) == []
