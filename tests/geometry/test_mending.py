"""Mending: cracks, faces that are there twice, needles, sheets, and shells that are inside out."""

from __future__ import annotations

import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixture_design.errors import GeometryError
from fixture_design.geometry.edges import edges_of
from tests.geometry.parts import Mesh, box, circle, l_shape, loaded, prism, shared, voxels
from tests.geometry.parts import part as part_of

SIDES = (0.05, 0.03, 0.02)


def enclosed(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """The volume inside a closed mesh."""
    first, second, third = (vertices[triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", first, np.cross(second, third))) / 6


def joined(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    triangles = [triangles + start for (_, triangles), start in zip(meshes, starts, strict=False)]
    return np.vstack([vertices for vertices, _ in meshes]), np.vstack(triangles)


def moved(mesh: Mesh, *by: float) -> Mesh:
    return mesh[0] + np.array(by), mesh[1]


def finer_on_one_side(count: int, off: float = 0.0) -> Mesh:
    """A box whose triangles on one side of an edge end at ``count`` vertices along it, which the other side lacks."""
    vertices, triangles = box(*SIDES)
    first, second, apex = triangles[0]
    steps = np.arange(1, count + 1)[:, None] / (count + 1)
    extra = vertices[first] + steps * (vertices[second] - vertices[first])
    # across the edge and in the plane of the first triangle, so that this one stays flat
    edge = vertices[second] - vertices[first]
    across = vertices[apex] - vertices[first]
    across -= (across @ edge) / (edge @ edge) * edge
    extra = extra + off * across / np.linalg.norm(across)
    chain = [first, *range(8, 8 + count), second]
    fan = [[one, other, apex] for one, other in pairwise(chain)]
    return np.vstack([vertices, extra]), np.vstack([triangles[1:], fan])


def test_cracks_at_t_junctions_are_closed_and_noted(tmp_path: Path) -> None:
    geometry = loaded(tmp_path, finer_on_one_side(5))
    assert any("5 vertices" in note and "T-junctions" in note for note in geometry.notes)
    assert not edges_of(geometry.triangles, len(geometry.vertices)).odd.any()
    assert len(geometry.facets) == 6
    assert enclosed(geometry.vertices, geometry.triangles) == pytest.approx(np.prod(SIDES), rel=1e-12)


def test_cracks_within_the_digits_of_the_file_are_closed_and_say_how_wide(tmp_path: Path) -> None:
    # six decimals: known to half a micrometre
    geometry = loaded(tmp_path, finer_on_one_side(5, 1e-6))
    assert any("5 vertices" in note and "at most 1 um" in note for note in geometry.notes)


def test_cracks_wider_than_the_digits_of_the_file_are_holes(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"7 open edges.*found one at \["):
        loaded(tmp_path, finer_on_one_side(5, 1e-5))


def cracked(mesh: Mesh, seed: int) -> Mesh:
    """A mesh whose triangles have been split along some of their sides, each without a word to its neighbour."""
    rng = np.random.default_rng(seed)
    vertices, triangles, result = mesh[0].tolist(), mesh[1].tolist(), []
    for triangle in triangles:
        if rng.random() < 0.5:
            result.append(triangle)
            continue
        start, end, apex = np.roll(triangle, rng.integers(3)).tolist()
        chain = [start]
        for share in np.sort(rng.uniform(0.05, 0.95, rng.integers(1, 4))):
            vertices.append(((1 - share) * np.array(vertices[start]) + share * np.array(vertices[end])).tolist())
            chain.append(len(vertices) - 1)
        result += [[one, other, apex] for one, other in pairwise([*chain, end])]
    return np.array(vertices), rng.permutation(np.array(result))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("mesh", [l_shape(), prism(circle(0.02, 12), 0.03)], ids=["L", "prism"])
def test_cracks_anywhere_on_either_side(tmp_path: Path, mesh: Mesh, seed: int) -> None:
    vertices, triangles = cracked(mesh, seed)
    # as an STL file would have it
    geometry = loaded(tmp_path, (vertices.astype(np.float32).astype(float), triangles))
    assert any("T-junctions" in note for note in geometry.notes)
    assert geometry.is_one_shell
    assert enclosed(geometry.vertices, geometry.triangles) == pytest.approx(enclosed(*mesh), rel=1e-6)
    assert geometry.surface.at(geometry.high + 0.01)[0] > 0.01


def test_a_triangle_with_cracks_on_all_its_sides(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    alone, rest = triangles[0], [list(row) for row in triangles[1:]]
    for number, (start, end) in enumerate(zip(alone, np.roll(alone, -1), strict=True)):
        index = next(i for i, row in enumerate(rest) if {start, end} <= set(row))
        row = rest.pop(index)
        apex = next(corner for corner in row if corner not in (start, end))
        rest += [[end, 8 + number, apex], [8 + number, start, apex]]
    middles = (vertices[alone] + vertices[np.roll(alone, -1)]) / 2
    geometry = loaded(tmp_path, (np.vstack([vertices, middles]), np.array([alone.tolist(), *rest])))
    assert any("3 vertices" in note for note in geometry.notes)
    assert len(geometry.facets) == 6
    assert enclosed(geometry.vertices, geometry.triangles) == pytest.approx(np.prod(SIDES), rel=1e-12)


@pytest.mark.parametrize("name", ["round_hole_8mm", "round_hole_16mm", "rectangular_hole_8mm"])
def test_real_parts_with_cracks(name: str) -> None:
    from fixture_design.geometry import load_part

    folder = "IsaacGymEnvs/assets/factory/mesh/factory_insertion"
    geometry = load_part(part_of(shared(f"{folder}/factory_{name}_subdiv_3x.obj")))
    assert geometry.is_one_shell
    assert any("T-junctions" in note and "at most 0 um" in note for note in geometry.notes)
    assert any("slivers folded" in note for note in geometry.notes) == name.startswith("round")
    # the hole is a hole: its axis is outside, a corner is not
    assert geometry.inside(np.array([[0, 0, 0.004], [0.0122, 0.0122, 0.004]])).tolist() == [False, True]


def test_needles_that_rounding_turned_over_are_flipped_away(tmp_path: Path) -> None:
    # a needle per edge of a prism at an angle, whose middle corner six decimals put on either side of the edge
    vertices, triangles = prism(circle(0.02, 11), 0.03)
    vertices = vertices @ Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).as_matrix().T
    middles, result = [], []
    for start, end, apex in triangles.tolist():
        middle = len(vertices) + len(middles)
        middles.append(0.45 * vertices[start] + 0.55 * vertices[end])
        result += [[start, middle, apex], [middle, end, apex], [start, end, middle]]
    mesh = np.round(np.vstack([vertices, middles]), 6), np.array(result)
    assert not edges_of(mesh[1], len(mesh[0])).odd.any()
    geometry = loaded(tmp_path, mesh)
    assert any("slivers folded" in note and " um" in note for note in geometry.notes)
    assert geometry.is_one_shell
    assert enclosed(geometry.vertices, geometry.triangles) == pytest.approx(enclosed(*mesh), rel=1e-4)
    assert geometry.surface.at(geometry.high + 0.01)[0] > 0.01


def test_triangles_that_are_there_twice(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    once_more = loaded(tmp_path, (vertices, np.vstack([triangles, triangles[3:4]])))
    assert any("1 triangles that were there twice" in note for note in once_more.notes)
    all_twice = loaded(tmp_path, (vertices, np.vstack([triangles, np.roll(triangles, 1, axis=1)])))
    assert any("12 triangles that were there twice" in note for note in all_twice.notes)
    for geometry in (once_more, all_twice):
        assert len(geometry.triangles) == 12
        assert geometry.is_one_shell


def test_a_fin_without_thickness_is_taken_out(tmp_path: Path) -> None:
    vertices, triangles = box(*SIDES)
    tip = np.array([[0.1, 0.0, 0.1]])
    fin = [[0, 1, 8], [1, 0, 8]]
    geometry = loaded(tmp_path, (np.vstack([vertices, tip]), np.vstack([triangles, fin])))
    assert any("1 pairs of triangles back to back" in note for note in geometry.notes)
    # its tip is no part of the size either
    np.testing.assert_allclose(geometry.high, np.array(SIDES) / 2)


def test_solids_face_to_face_become_one(tmp_path: Path) -> None:
    cube = voxels({(0, 0, 0)}, 0.02)
    geometry = loaded(tmp_path, joined(cube, moved((cube[0] * [-1, 1, 1], cube[1][:, ::-1]), 0.0, 0.0, 0.0)))
    assert any("2 pairs" in note for note in geometry.notes)
    assert geometry.is_one_shell
    assert len(geometry.facets) == 6
    assert enclosed(geometry.vertices, geometry.triangles) == pytest.approx(2 * 0.02**3)


def test_solids_that_touch_along_an_edge_stay_and_are_wound_one_by_one(tmp_path: Path) -> None:
    cube = voxels({(0, 0, 0)}, 0.02)
    turned = moved((cube[0], cube[1][:, ::-1]), 0.02, 0.02, 0.0)
    geometry = loaded(tmp_path, joined(cube, turned))
    assert any("1 shells were inside out" in note for note in geometry.notes)
    assert not geometry.is_one_shell
    points = np.array([[0.01, 0.01, 0.01], [0.03, 0.03, 0.01], [0.01, 0.03, 0.01]])
    assert geometry.inside(points).tolist() == [True, True, False]


def test_a_solid_that_touches_itself_along_an_edge_stays_as_it_is(tmp_path: Path) -> None:
    cells = {(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)} - {(0, 0, 1), (1, 1, 1)}
    vertices, triangles = voxels(cells, 0.02)
    geometry = loaded(tmp_path, (vertices, triangles))
    assert len(geometry.triangles) == len(triangles)
    assert geometry.notes == ()
    turned = loaded(tmp_path, (vertices, triangles[:, ::-1]))
    assert any("1 shells were inside out" in note for note in turned.notes)
    assert enclosed(turned.vertices, turned.triangles) == pytest.approx(6 * 0.02**3)


def test_sheets_that_enclose_nothing_are_taken_out(tmp_path: Path) -> None:
    # a square, cut along one diagonal above and along the other below
    corners = np.array([[0, 0, 0], [0.01, 0, 0], [0.01, 0.01, 0], [0, 0.01, 0]]) + 0.1
    sheet = corners, np.array([[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]])
    geometry = loaded(tmp_path, joined(box(*SIDES), sheet))
    assert any("1 shells without thickness" in note for note in geometry.notes)
    assert len(geometry.triangles) == 12
    np.testing.assert_allclose(geometry.high, np.array(SIDES) / 2)
    tilted = moved((sheet[0][:, [1, 2, 0]], sheet[1]), 0.05, 0, 0)
    with pytest.raises(GeometryError, match="encloses nothing"):
        loaded(tmp_path, joined(sheet, tilted))


def test_a_hollow_part_that_is_inside_out_throughout_is_turned_with_its_cavity(tmp_path: Path) -> None:
    nested = [box(side, side, side) for side in (0.06, 0.04, 0.02)]
    vertices, triangles = joined(*((v, t if index % 2 else t[:, ::-1]) for index, (v, t) in enumerate(nested)))
    geometry = loaded(tmp_path, (vertices, triangles))
    assert any("3 shells were inside out" in note for note in geometry.notes)
    assert geometry.inside(np.array([[0, 0, 0], [0.015, 0, 0], [0.025, 0, 0]])).tolist() == [True, False, True]


def test_a_shell_in_the_mouth_of_another_is_no_cavity(tmp_path: Path) -> None:
    # within the box of a U, but not in its material
    cells = {(x, y, z) for x in range(3) for y in range(3) for z in range(3)} - {(1, 1, z) for z in (1, 2)}
    vertices, triangles = box(0.01, 0.01, 0.01)
    lone = moved((vertices, triangles[:, ::-1]), 0.03, 0.03, 0.045)
    geometry = loaded(tmp_path, joined(voxels(cells, 0.02), lone))
    assert any("1 shells were inside out" in note for note in geometry.notes)
    assert geometry.inside(np.array([[0.03, 0.03, 0.045], [0.03, 0.03, 0.055]])).tolist() == [True, False]


def with_needles(count: int) -> Mesh:
    """A strip of small boxes, each with a needle along one edge."""
    vertices, triangles = box(0.004, 0.004, 0.004)
    first, second, apex = triangles[0]
    middle = (vertices[first] + vertices[second]) / 2
    vertices = np.vstack([vertices, middle])
    triangles = np.vstack([triangles[1:], [[first, 8, apex], [8, second, apex], [first, second, 8]]])
    return joined(*(moved((vertices, triangles), 0.006 * number, 0, 0) for number in range(count)))


def test_many_needles_take_time_in_proportion(tmp_path: Path) -> None:
    times = []
    for count in (100, 800):
        start = time.process_time()
        geometry = loaded(tmp_path, with_needles(count))
        times.append(time.process_time() - start)
        assert any(f"{count} triangles without area" in note for note in geometry.notes)
        assert len(geometry.triangles) == 14 * count
    assert times[1] < 40 * times[0]


def test_needles_on_needles(tmp_path: Path) -> None:
    # two needles back to front: 0 - 9 - 8 - 1 on one edge, the second needle on a short side of the first
    vertices, triangles = box(*SIDES)
    first, second, apex = triangles[0]
    edge = vertices[second] - vertices[first]
    vertices = np.vstack([vertices, vertices[first] + edge / 2, vertices[first] + edge / 4])
    parts = [[first, 9, apex], [9, 8, apex], [8, second, apex], [first, 8, 9], [first, second, 8]]
    geometry = loaded(tmp_path, (vertices, np.vstack([triangles[1:], parts])))
    assert any("2 triangles without area" in note for note in geometry.notes)
    assert len(geometry.facets) == 6
    assert geometry.is_one_shell
