"""Posed scenes: distances at a pose, overlap and clearance of non-convex solids, many poses at a time."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from fixture_design.errors import GeometryError, UnknownNameError
from fixture_design.geometry import PartGeometry, PlacedBody, PosedScene, Scene
from fixture_design.geometry.segments import crossings, segment_distances, stretches
from fixture_design.geometry.sphere_tree import sphere_tree
from fixture_design.layout import Pose
from tests.geometry.parts import Mesh, box, l_shape, part, seven_eighths, shared

HERE = Pose.identity(3)


def solid(mesh: Mesh | trimesh.Trimesh, name: str = "solid") -> PartGeometry:
    vertices, triangles = (mesh.vertices, mesh.faces) if isinstance(mesh, trimesh.Trimesh) else mesh
    vertices = np.array(vertices, dtype=float)
    return PartGeometry(name, vertices, np.array(triangles), np.full(len(vertices), 1e-17))


def moved(*xyz: float, turned: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Pose:
    return Pose.from_xyz_rpy(xyz, turned)


def two(mesh: Mesh | trimesh.Trimesh, body: Mesh | trimesh.Trimesh, X_WB: Pose = HERE) -> Scene:
    return Scene(solid(mesh, "part"), [PlacedBody("body", solid(body), X_WB)])


CUBE = box(0.02, 0.02, 0.02)


def test_points_are_asked_in_the_frame_that_answers() -> None:
    X_WP, X_WB = moved(0.1, 0, 0, turned=(0, 0, np.pi / 2)), moved(0, 0.2, 0, turned=(0.3, 0, 0))
    posed = two(box(0.06, 0.02, 0.02), CUBE, X_WB).at(X_WP)
    assert isinstance(posed, PosedScene)
    points = np.array([[0.1, 0.05, 0], [0.12, 0, 0], [0.1, 0, 0]])
    np.testing.assert_allclose(posed.part_distances(points), [0.02, 0.01, -0.01], atol=1e-16)
    np.testing.assert_allclose(posed.body_distances("body", np.array([[0, 0.2, 0], [0.03, 0.2, 0]])), [-0.01, 0.02])
    with pytest.raises(UnknownNameError, match="there are: body"):
        posed.body_distances("jaw", points)


@pytest.mark.parametrize(
    ("pose", "distance"),
    [
        (moved(0.03, 0, 0), 0.01),  # face to face
        (moved(0.03, 0.03, 0), 0.01 * np.sqrt(2)),  # edge to edge
        (moved(0.03, 0.03, 0.03), 0.01 * np.sqrt(3)),  # vertex to vertex
        (moved(0.04, 0, 0, turned=(0, 0, np.pi / 4)), 0.03 - 0.01 * np.sqrt(2)),  # edge to face
        (moved(0.02, 0, 0), 0.0),  # touching
        (moved(0.019, 0, 0), -0.001),  # 1 mm inside
        (moved(0.0, 0, 0), -1),  # one in the other's place: all edges and vertices on the other's surface
        (moved(0.01, 0, 0), -1),  # slid along itself by half
    ],
)
def test_cubes_with_distances_that_one_can_see(pose: Pose, distance: float) -> None:
    posed = two(CUBE, CUBE).at(pose)
    if distance == -1:
        assert posed.clearance() < -1e-3
    else:
        assert posed.clearance() == pytest.approx(distance, abs=1e-15)
    assert (posed.overlap(1e-6) is not None) == (distance < -1e-6)


def test_two_crossed_edges_in_space() -> None:
    # a cube on its edge along x above one on its edge along y
    pose = Pose.from_xyz_rpy([0, 0, 0.04], [np.pi / 4, 0, 0])
    body = moved(0, 0, 0, turned=(0, np.pi / 4, 0))
    assert two(CUBE, CUBE, body).at(pose).clearance() == pytest.approx(0.04 - 2 * 0.01 * np.sqrt(2), abs=1e-15)


def test_crossed_bars_overlap_with_all_vertices_outside() -> None:
    scene = two(box(0.1, 0.01, 0.01), box(0.01, 0.1, 0.01))
    overlap = scene.at(moved(0, 0, 0.008)).overlap()
    assert overlap is not None
    assert overlap.body == "body"
    assert overlap.depth == pytest.approx(0.002)
    assert scene.at(moved(0, 0, 0.0101)).clearance() == pytest.approx(1e-4)
    assert scene.at(moved(0, 0, 0.01)).overlap() is None


def test_the_notch_of_an_l_is_free_and_not_filled_by_a_hull() -> None:
    scene = two(box(0.01, 0.01, 0.01), l_shape(0.04, 0.02))
    assert scene.at(moved(0.03, 0.03, 0.01)).clearance() == pytest.approx(0.005)
    assert scene.at(moved(0.025, 0.025, 0.01)).overlap() is None  # in the corner, touching both walls
    assert scene.at(moved(0.0249, 0.03, 0.01)).overlap() is not None


def test_wholly_inside_either_way() -> None:
    small, large = box(0.002, 0.002, 0.002), box(0.05, 0.05, 0.05)
    for scene in (two(small, large), two(large, small)):
        overlap = scene.at(moved(0.001, 0, 0)).overlap()
        assert overlap is not None
        assert scene.at(moved(0.001, 0, 0)).clearance() == pytest.approx(-0.025, abs=3e-3)


def test_an_overlap_has_a_point_inside_both() -> None:
    rng = np.random.default_rng(5)
    scene = two(l_shape(0.04, 0.02), seven_eighths(0.04), moved(0.01, 0.02, 0.03, turned=(0.1, 0.2, 0.3)))
    found = 0
    for _ in range(60):
        pose = moved(*rng.uniform(-0.04, 0.06, 3), turned=tuple(rng.uniform(-3, 3, 3)))
        posed = scene.at(pose)
        overlap = posed.overlap()
        if overlap is None:
            assert posed.clearance() >= -1e-5
            continue
        found += 1
        assert overlap.depth > 1e-5
        depth = max(posed.part_distances(overlap.point[None])[0], posed.body_distances("body", overlap.point[None])[0])
        assert depth <= 1e-12
    assert 5 < found < 55


def test_cavities_hold_what_they_have_room_for() -> None:
    (outer, first), (inner, second) = box(0.04, 0.04, 0.04), box(0.02, 0.02, 0.02)
    hollow = np.vstack([outer, inner]), np.vstack([first, second[:, ::-1] + 8])
    scene = two(box(0.01, 0.01, 0.01), hollow)
    assert scene.at(HERE).clearance() == pytest.approx(0.005)
    assert scene.at(moved(0.006, 0, 0)).overlap() is not None


def test_solids_that_overlap_in_one_part_are_one() -> None:
    # two bars that cross: near the inner surface of one, Drake's sign is that of outside
    (a, first), (b, second) = box(0.1, 0.02, 0.02), box(0.02, 0.1, 0.02)
    cross = np.vstack([a, b]), np.vstack([first, second + 8])
    scene = two(box(0.001, 0.001, 0.001), cross)
    for x in (0.0, 0.0095, 0.0105, 0.02):
        assert scene.at(moved(x, 0, 0)).overlap() is not None
    assert scene.at(moved(0.02, 0.02, 0)).overlap() is None


def brute_force(first: PartGeometry, second: PartGeometry, pose: Pose) -> float:
    """Distance of solids apart: vertices to faces through trimesh, edges to edges by sampling them finely."""
    moving = trimesh.Trimesh(pose.points(first.vertices), first.triangles, process=False)
    still = trimesh.Trimesh(second.vertices, second.triangles, process=False)
    steps = np.linspace(0, 1, 81)[:, None, None]
    least = np.inf
    for one, other in ((moving, still), (still, moving)):
        ends = one.vertices[one.edges_unique]
        samples = (ends[:, 0] + steps * (ends[:, 1] - ends[:, 0])).reshape(-1, 3)
        least = min(least, float(trimesh.proximity.closest_point(other, samples)[1].min()))
    return least


@pytest.mark.parametrize("seed", range(6))
def test_clearance_is_that_of_brute_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    first, second = solid(l_shape(0.04, 0.02)), solid(trimesh.creation.torus(0.03, 0.01, 10, 6))
    pose = moved(*(0.07 * rng.uniform(0.7, 1.2) * trimesh.unitize(rng.normal(size=3))), turned=(seed, 1.0, 2.0))
    scene = Scene(first, [PlacedBody("ring", second, HERE)])
    clearance = scene.at(pose).clearance()
    brute = brute_force(first, second, pose)
    if clearance > 0:
        # samples are at most half a step from the nearest point
        assert 0 <= brute - clearance < 0.04 * np.sqrt(2) / 160
    else:
        assert brute < 1e-3


@settings(max_examples=20)  # each builds scenes
@given(seed=st.integers(0, 10_000), shift=st.floats(-1, 1))
def test_clearance_does_not_depend_on_the_frame_or_on_who_moves(seed: int, shift: float) -> None:
    rng = np.random.default_rng(seed)
    ell, corner = solid(l_shape(0.04, 0.02)), solid(seven_eighths(0.03))
    pose, all_moved = (moved(*rng.uniform(-0.06, 0.06, 3), turned=tuple(rng.uniform(-3, 3, 3))) for _ in range(2))
    all_moved = Pose(all_moved.rotation, all_moved.translation + shift)
    plain = Scene(ell, [PlacedBody("b", corner, HERE)]).at(pose).clearance()
    together = Pose(all_moved.rotation @ pose.rotation, all_moved.points(pose.translation[None])[0])
    assert Scene(ell, [PlacedBody("b", corner, all_moved)]).at(together).clearance() == pytest.approx(plain, abs=1e-8)
    swapped = Scene(corner, [PlacedBody("b", ell, HERE)]).at(pose.inverse()).clearance()
    if plain > 0:
        assert swapped == pytest.approx(plain, abs=1e-9)
    assert (swapped > 0) == (plain > 0)


@settings(max_examples=20)  # each builds scenes
@given(seed=st.integers(0, 10_000))
def test_limit_cuts_off_and_changes_nothing_below(seed: int) -> None:
    rng = np.random.default_rng(seed)
    posed = two(l_shape(), l_shape()).at(moved(*rng.uniform(-0.08, 0.08, 3), turned=tuple(rng.uniform(-3, 3, 3))))
    exact = posed.clearance()
    assert posed.clearance(limit=0.01) == pytest.approx(min(exact, 0.01), abs=1e-12 if exact > 0 else 0.02)
    assert (posed.clearance(limit=0.01) > 0) == (exact > 0)


def test_several_bodies_have_their_own_clearances_and_names() -> None:
    jaw = solid(CUBE, "jaw")
    scene = Scene(
        solid(CUBE), [PlacedBody("left", jaw, moved(-0.03, 0, 0)), PlacedBody("right", jaw, moved(0.025, 0, 0))]
    )
    posed = scene.at(HERE)
    assert dict(posed.clearances()) == pytest.approx({"left": 0.01, "right": 0.005})
    assert posed.clearance() == pytest.approx(0.005)
    overlap = scene.at(moved(-0.015, 0, 0)).overlap()
    assert overlap is not None
    assert overlap.body == "left"
    with pytest.raises(GeometryError, match="'left' twice"):
        Scene(solid(CUBE), [PlacedBody("left", jaw, HERE), PlacedBody("left", jaw, HERE)])
    assert Scene(solid(CUBE)).at(HERE).clearance() == np.inf


def test_part_slides_along_a_face_without_overlap_and_not_through_it() -> None:
    pose = moved(0, 0, 0, turned=(0.3, 0.4, 0.5))
    scene = two(box(0.02, 0.03, 0.04), box(0.2, 0.2, 0.01), pose)
    for y in np.linspace(-0.05, 0.05, 11):
        on_top = Pose(pose.rotation, pose.points(np.array([[0.01, y, 0.025]]))[0])
        assert scene.at(on_top).overlap(1e-9) is None
        assert abs(scene.at(on_top).clearance()) < 1e-15
        sunk = Pose(pose.rotation, pose.points(np.array([[0.01, y, 0.025 - 2e-5]]))[0])
        assert scene.at(sunk).overlap() is not None


def test_many_poses_in_their_order_and_the_same_in_two_processes() -> None:
    scene = two(l_shape(), seven_eighths())
    rng = np.random.default_rng(1)
    poses = [moved(*rng.uniform(-0.08, 0.08, 3), turned=tuple(rng.uniform(-3, 3, 3))) for _ in range(150)]
    alone = scene.clearances(poses)
    np.testing.assert_array_equal(alone, [scene.at(pose).clearance() for pose in poses])
    np.testing.assert_array_equal(scene.clearances(poses, processes=2), alone)
    np.testing.assert_array_equal(scene.is_free(poses), alone >= -1e-5)
    assert 10 < scene.is_free(poses).sum() < 140
    assert scene.clearances([]).shape == (0,)
    with pytest.raises(GeometryError, match="one process or more"):
        scene.clearances(poses, processes=0)


def test_a_part_travels_as_what_it_was_made_of() -> None:
    scene = two(l_shape(), CUBE)
    expected = scene.at(moved(0.05, 0.03, 0)).clearance()
    assert pickle.loads(pickle.dumps(scene)).at(moved(0.05, 0.03, 0)).clearance() == expected


@pytest.mark.parametrize(
    ("pose", "problem"),
    [
        (Pose.identity(2), "not spatial"),
        (moved(np.nan, 0, 0), "not finite"),
        (Pose(2 * np.eye(3), np.zeros(3)), "no rotation"),
        (Pose(np.diag([1.0, 1, -1]), np.zeros(3)), "no rotation"),
    ],
)
def test_poses_that_are_none(pose: Pose, problem: str) -> None:
    with pytest.raises(GeometryError, match=problem):
        two(CUBE, CUBE).at(pose)
    with pytest.raises(GeometryError, match=problem):
        two(CUBE, CUBE, pose)


def test_points_that_are_not_finite_and_allowances_below_zero() -> None:
    posed = two(CUBE, CUBE).at(moved(0.05, 0, 0))
    with pytest.raises(GeometryError, match="not finite"):
        posed.part_distances(np.array([[0, 0, 0], [0, np.nan, 0]]))
    with pytest.raises(GeometryError, match="0 or more"):
        posed.overlap(-1e-6)
    assert posed.part_distances(np.empty((0, 3))).shape == (0,)


def test_real_part_rests_on_its_jaw_and_leaves_it() -> None:
    from fixture_design.geometry import load_part

    geometry = load_part(part(shared("trimesh/models/featuretype.STL"), 0.0254))
    below = geometry.low[2] - 0.01
    plate = solid(box(1.0, 1.0, 0.02), "plate")
    scene = Scene(geometry, [PlacedBody("plate", plate, moved(0, 0, below))])
    assert abs(scene.at(HERE).clearance()) < 1e-12
    assert scene.at(HERE).overlap() is None
    heights = np.array([1e-4, 1e-3, 0.02])
    np.testing.assert_allclose(scene.clearances([moved(0, 0, z) for z in heights]), heights, atol=1e-12)
    assert not scene.is_free([moved(0, 0, -1e-4)])[0]


def test_balls_of_the_tree_hold_their_triangles() -> None:
    mesh = trimesh.creation.torus(0.03, 0.01, 20, 11)
    tree = sphere_tree(np.array(mesh.vertices), np.array(mesh.faces))
    assert sorted(tree.triangles.tolist()) == list(range(len(mesh.faces)))
    assert len(tree.levels[0].radii) == 1
    balls = np.zeros(1, dtype=np.int64)
    for number, level in enumerate(tree.levels):
        if number:
            balls = tree.children(number - 1, balls)
        assert len(balls) == len(level.radii)
        width = 4 ** (len(tree.levels) - 1 - number)
        owner = np.arange(len(mesh.faces)) // width
        away = np.linalg.norm(mesh.triangles[tree.triangles] - level.centers[owner][:, None], axis=2).max(axis=1)
        assert (away <= level.radii[owner] * (1 + 1e-12)).all()


def test_segments_cross_triangles_where_they_do() -> None:
    triangle = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    segments = np.array(
        [
            [[0.2, 0.2, -1], [0.2, 0.2, 3]],  # through
            [[0.8, 0.8, -1], [0.8, 0.8, 1]],  # past
            [[0.5, 0.5, -1], [0.5, 0.5, 1]],  # through an edge
            [[-1, 0.2, 0], [1, 0.2, 0]],  # in the plane
            [[0.2, 0.2, 1], [0.2, 0.2, 2]],  # short
        ]
    )
    number, triangles, at = crossings(segments, triangle)
    assert triangles.tolist() == [0, 0]
    assert number.tolist() == [0, 2]
    np.testing.assert_allclose(at, [0.25, 0.5])
    number, at = stretches(number, at)
    assert number.tolist() == [0, 0, 2, 2]
    np.testing.assert_allclose(at, [0.125, 0.625, 0.25, 0.75])


@given(seed=st.integers(0, 100_000))
def test_segment_distances_are_those_of_a_fine_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    first, second = rng.integers(-2, 3, (2, 1, 2, 3)).astype(float)
    for ends in (first, second):  # no segment without length
        ends[0, 1] += 5 * (ends[0, 0] == ends[0, 1]).all()
    distance, nearest = segment_distances(first, second)
    steps = np.linspace(0, 1, 101)[:, None]
    ones = first[0, 0] + steps * (first[0, 1] - first[0, 0])
    others = second[0, 0] + steps * (second[0, 1] - second[0, 0])
    brute = np.linalg.norm(ones[:, None] - others[None], axis=2).min()
    assert -1e-12 < brute - distance[0] < 0.15
    assert np.linalg.norm(others - nearest[0], axis=1).min() - distance[0] < 0.15
