"""The swept way: exact against dense sampling of poses, and cases that one can see."""

from __future__ import annotations

import time

import numpy as np
import pytest
import shapely
import trimesh

from fixture_design.geometry import PartGeometry, PlanarSurroundings, Surroundings, polygon_of
from fixture_design.geometry.barriers import BallBarrier, Barrier, PointBarrier, SolidBarrier
from fixture_design.geometry.planar_way import PlanarBarrier
from fixture_design.layout import Pose
from tests.geometry.parts import Mesh, box, l_shape, polygon_part, prism, seven_eighths, unit
from tests.geometry.solids import Convex, Solid, cuboid
from tests.geometry.test_posed_scene import solid

GAP = 1e-5
HERE = Pose.identity(3)
X, Y, Z = np.eye(3)


def placed(mesh: Mesh, *xyz: float, turned: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mesh:
    return Pose.from_xyz_rpy(xyz, turned).points(np.asarray(mesh[0], dtype=float)), mesh[1]


def body(mesh: Mesh, name: str = "body") -> SolidBarrier:
    geometry = solid(mesh, name)
    return SolidBarrier(name, geometry.vertices[geometry.triangles], None, geometry)


def around(part: PartGeometry, *barriers: Barrier, X_WP: Pose = HERE) -> Surroundings:
    return Surroundings(part, barriers, X_WP, GAP)


def clear(surroundings: Surroundings, direction: object) -> bool:
    return surroundings.meeting(unit(direction)) is None


CUBE = solid(box(0.02, 0.02, 0.02))


def test_a_lid_above_a_part_is_met_where_it_is() -> None:
    lid = body(placed(box(0.1, 0.1, 0.002), 0, 0, 0.031), "lid")
    meeting = around(CUBE, lid).meeting(Z)
    assert meeting is not None
    assert meeting.certain
    assert meeting.obstacle.name == "lid"
    assert meeting.obstacle.after == pytest.approx(0.02, abs=1e-12)
    assert meeting.obstacle.point[2] == pytest.approx(0.03, abs=1e-12)
    assert clear(around(CUBE, lid), X)
    assert clear(around(CUBE, lid), -Z)
    # in the 45 degrees up to its edge and past it
    assert not clear(around(CUBE, lid), [1, 0, 1])
    assert clear(around(CUBE, lid), [3.1, 0, 1])


def test_sliding_along_walls_is_clear_and_into_them_is_not() -> None:
    walls = [body(placed(box(0.1, 0.01, 0.1), 0, sign * 0.015, 0), f"wall {sign}") for sign in (-1, 1)]
    channel = around(CUBE, *walls)
    for direction in (X, -X, Z, -Z, [1, 0, 2]):
        assert clear(channel, direction)
    for direction in (Y, -Y, [1, 0.05, 1], [1, -1e-3, 0]):
        assert not clear(channel, direction)


def test_what_lies_within_the_gap_is_touching() -> None:
    deeper = [body(placed(box(0.1, 0.01, 0.1), 0, 0.015 - off, 0)) for off in (0.9 * GAP, -0.9 * GAP)]
    assert all(clear(around(CUBE, wall), Z) for wall in deeper)
    # a rim that grows towards the part by more than the gap, further up
    rim = placed(box(0.1, 0.01, 0.01), 0, 0.015 - 3 * GAP, 0.03)
    meeting = around(CUBE, body(rim)).meeting(Z)
    assert meeting is not None
    assert meeting.obstacle.after == pytest.approx(0.015, abs=1e-9)


def test_a_tee_in_its_slot_slides_out_along_it_and_no_other_way() -> None:
    mm = 1e-3
    tee = [[-2, 0], [2, 0], [2, 6], [6, 6], [6, 10], [-6, 10], [-6, 6], [-2, 6]]
    left = [[-2.1, -2], [-2.1, 5.9], [-6.1, 5.9], [-6.1, 10.1], [-2.1, 10.1], [-2.1, 14], [-12, 14], [-12, -2]]
    part = solid(prism([[x * mm, y * mm] for x, y in tee], 0.03))
    sides = [body(prism([[sign * x * mm, y * mm] for x, y in left][::sign], 0.03), f"side {sign}") for sign in (1, -1)]
    slot = around(part, *sides)
    assert clear(slot, Z)
    assert clear(slot, -Z)
    for direction in (X, -X, Y, -Y, [1, 1, 0], [0, -1, 0.5], [0.2, 0, 1]):
        assert not clear(slot, direction)
    closed = around(part, *sides, body(placed(box(0.02, 0.02, 0.002), 0, 0.005, 0.04), "stop"))
    assert not clear(closed, Z)
    assert clear(closed, -Z)


def test_balls_under_an_overhang() -> None:
    """An L that lies on its side: a ball in its notch lets it go away from the notch only."""
    part = solid(l_shape(0.04, 0.02))
    ball = BallBarrier("ball", np.array([0.024, 0.024, 0.01]), 0.004, 0.0)
    notch = around(part, ball)
    for direction in ([-1, 0, 0], [0, -1, 0], [-1, -1, 0], [0, 0, 1], [0, -1, 0.3]):
        assert clear(notch, direction)
    for direction in ([1, 0, 0], [0, 1, 0], [1, 1, 0], [0.2, 0, 1]):
        assert not clear(notch, direction)
    away = BallBarrier("ball", np.array([0.05, 0.01, 0.01]), 0.004, 0.0)
    meeting = around(part, away).meeting(X)
    assert meeting is not None
    assert meeting.obstacle.after == pytest.approx(0.006, abs=1e-12)
    # past it by 0.1 mm, and into it by 0.1 mm
    for offset, free in ((0.0041, True), (0.0039, False)):
        aside = BallBarrier("ball", np.array([0.05, -offset, 0.01]), 0.004, 0.0)
        assert clear(around(part, aside), X) is free


def test_points_are_in_the_way_only_where_all_around_them_is_passed_over() -> None:
    for offset, free in ((-2 * GAP, True), (0.0, True), (0.5 * GAP, True), (2 * GAP, False)):
        point = PointBarrier("tip", np.array([0.01 - offset, 0, 0.03]), 0.0)
        meeting = around(CUBE, point).meeting(Z)
        assert (meeting is None) is free
        if meeting is not None:
            assert meeting.obstacle.after == pytest.approx(0.02, abs=1e-12)


def depths_on_the_way(part: Convex, other: Convex, direction: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """How deep a convex part is in another solid after each step, negative where they are apart: separating axes."""
    across = np.cross(part.edges[:, None], other.edges[None]).reshape(-1, 3)
    lengths = np.linalg.norm(across, axis=1)
    axes = np.vstack([part.normals, other.normals, across[lengths > 1e-5] / lengths[lengths > 1e-5, None]])
    ours, theirs, shift = part.vertices @ axes.T, other.vertices @ axes.T, np.outer(steps, axes @ direction)
    below = ours.max(axis=0) + shift - theirs.min(axis=0)
    above = theirs.max(axis=0) - ours.min(axis=0) - shift
    return np.minimum(below, above).min(axis=1)


#: Obstacles as convex pieces: a box, an L, a box with a notch.
PIECES = (
    [([-1, -1, -1], [1, 1, 1])],
    [([-2, -2, -1], [2, 0, 1]), ([-2, -2, -1], [0, 2, 1])],
    [([-2, -2, -2], [2, 2, 0]), ([-2, -2, -2], [2, 0, 2]), ([-2, -2, -2], [0, 2, 2])],
)


@pytest.mark.parametrize("seed", range(20))
def test_random_boxes_against_dense_sampling(seed: int) -> None:
    """A turned box among turned obstacles, convex or not; poses every 0.05 mm, and a verdict beyond ten gaps."""
    rng = np.random.default_rng(seed)
    sides = rng.uniform(0.005, 0.02, 3)
    part = cuboid(-sides, sides).placed(Pose.from_xyz_rpy([0, 0, 0], rng.uniform(-3, 3, 3)).rotation, np.zeros(3))
    geometry = Solid((part,)).geometry("part")
    steps, counts = np.arange(0, 0.12, 5e-5), {True: 0, False: 0}
    for _ in range(20):
        size = rng.uniform(0.003, 0.01, 3)
        pose = Pose.from_xyz_rpy(0.05 * unit(rng.normal(size=3)), rng.uniform(-3, 3, 3))
        pieces = [cuboid(size * low, size * high) for low, high in PIECES[rng.integers(3)]]
        obstacle = Solid(tuple(piece.placed(pose.rotation, pose.translation) for piece in pieces))
        direction = unit(pose.translation + rng.normal(size=3) * 0.03)
        depths = np.max([depths_on_the_way(part, piece, direction, steps) for piece in obstacle.pieces], axis=0)
        deepest = float(depths.max())
        if depths[0] > 0 or abs(deepest) < 10 * GAP:
            continue
        barrier = obstacle.geometry("body")
        solid_barrier = SolidBarrier("body", barrier.vertices[barrier.triangles], None, barrier)
        meeting = around(geometry, solid_barrier).meeting(direction)
        assert (meeting is None) is (deepest < 0), (seed, deepest)
        counts[meeting is None] += 1
        if meeting is not None:
            # met at one of the columns: not before the first touch, and on the way
            first = float(steps[np.argmax(depths > 0)])
            assert first - 1e-4 <= meeting.obstacle.after <= float(steps[depths > 0][-1]) + 1e-4
    assert min(counts.values()) >= 1


@pytest.mark.parametrize("seed", range(6))
def test_random_balls_and_points_against_distances_along_the_way(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    part = solid(placed(seven_eighths(0.03), -0.015, -0.015, -0.015, turned=tuple(rng.uniform(-3, 3, 3))))
    counts = {True: 0, False: 0}
    for _ in range(60):
        direction = unit(rng.normal(size=3))
        start = rng.uniform(0.02, 0.04) * unit(direction + 0.7 * rng.normal(size=3))
        radius = float(rng.uniform(0.0, 0.006)) * rng.integers(2)
        apart = part.surface.distances(start - np.arange(0, 0.08, 1e-4)[:, None] * direction)
        if apart[0] < radius + GAP:
            continue
        barrier = BallBarrier("b", start, radius, 0.0) if radius else PointBarrier("b", start, 0.0)
        free = clear(around(part, barrier), direction)
        if abs(apart.min() - radius) > 1e-4:
            assert free is bool(apart.min() > radius)
            counts[free] += 1
    assert min(counts.values()) >= 3


def test_the_same_wherever_it_stands() -> None:
    rng = np.random.default_rng(3)
    lid = body(placed(box(0.1, 0.1, 0.002), 0, 0, 0.031), "lid")
    ball = BallBarrier("ball", np.array([0.03, 0.002, 0.001]), 0.004, 0.0)
    for _ in range(20):
        X_WP = Pose.from_xyz_rpy(rng.uniform(-1, 1, 3), rng.uniform(-3, 3, 3))
        moved, here = around(CUBE, lid, ball, X_WP=X_WP), around(CUBE, lid, ball)
        direction = unit(rng.normal(size=3))
        one, other = here.meeting(direction), moved.meeting(X_WP.rotation @ direction)
        assert (one is None) == (other is None)
        if one is not None and other is not None:
            assert other.obstacle.name == one.obstacle.name
            assert other.obstacle.after == pytest.approx(one.obstacle.after, abs=1e-9)
            # where faces meet all at once any point of them will do
            assert X_WP.inverse().points(other.obstacle.point[None])[0] @ Z == pytest.approx(one.obstacle.point @ Z)
        assert moved.length(X_WP.rotation @ direction) == pytest.approx(here.length(direction), abs=1e-12)


def test_a_fine_part_among_bodies_and_tips_is_quick() -> None:
    part = solid(trimesh.creation.uv_sphere(radius=0.03, count=[72, 72]))
    assert len(part.triangles) > 10_000
    base = prism([[-0.05, -0.05], [0.05, -0.05], [0.05, 0.05], [-0.05, 0.05]], 0.01)
    bodies = [
        body(placed(base, 0, 0, -0.0401), "base"),
        body(placed(box(0.01, 0.1, 0.1), -0.0351, 0, 0), "wall"),
        body(placed(box(0.1, 0.01, 0.1), 0, -0.0351, 0), "side"),
    ]
    balls = [BallBarrier(f"L{k}", 0.034 * unit(d), 0.004, 0.0) for k, d in enumerate(([-1, -1, 0], [-1, 0, -1], -Z))]
    points = [PointBarrier(f"P{k}", 0.03 * unit(d), 0.0) for k, d in enumerate((-X, -Y, [-1, -1, -1]))]
    surroundings = around(part, *bodies, *balls, *points)
    assert clear(surroundings, [1, 1, 1])
    start = time.process_time()
    assert clear(surroundings, [1, 2, 3])
    assert not clear(surroundings, [0.1, -0.2, 1])
    # 0.3 s where nothing else runs; processor time grows where others compete for the caches
    assert time.process_time() - start < 10.0


def planar(vertices: object, *barriers: PlanarBarrier) -> PlanarSurroundings:
    return PlanarSurroundings(polygon_of(polygon_part(vertices)), barriers, Pose.identity(2), GAP)


def tip(*points: object, radius: float = 0.0) -> PlanarBarrier:
    return PlanarBarrier("tip", np.array(points, dtype=float), radius, 0.0)


def test_a_planar_tee_between_tips() -> None:
    tee = [[-2, 0], [2, 0], [2, 6], [6, 6], [6, 10], [-6, 10], [-6, 6], [-2, 6]]
    for under in (tip([4, 6]), tip([3, 6], [5, 6]), tip([4, 5], radius=1.0)):
        surroundings = planar(tee, under)
        assert surroundings.meeting(np.array([0.0, -1.0])) is not None
        assert surroundings.meeting(np.array([0.0, 1.0])) is None
    above = planar(tee, tip([4, 12]))
    meeting = above.meeting(np.array([0.0, 1.0]))
    assert meeting is not None
    assert meeting.obstacle.after == pytest.approx(2.0, abs=1e-4)
    np.testing.assert_allclose(meeting.obstacle.point, [4, 12], atol=1e-9)
    # beside it, by less and by more than the gap
    assert planar(tee, tip([6 - 0.5 * GAP, 12])).meeting(np.array([0.0, 1.0])) is None
    assert planar(tee, tip([6 - 2 * GAP, 12])).meeting(np.array([0.0, 1.0])) is not None


def test_planar_ways_against_dense_sampling() -> None:
    rng = np.random.default_rng(8)
    tee = np.array([[-2, 0], [2, 0], [2, 6], [6, 6], [6, 10], [-6, 10], [-6, 6], [-2, 6]], dtype=float)
    shape = shapely.Polygon(tee)
    steps, counts = np.arange(0, 25, 0.01), {True: 0, False: 0}
    for _ in range(100):
        point, direction = rng.uniform([-10, -6], [10, 14]), unit(rng.normal(size=2))
        way = shapely.points(point - steps[:, None] * direction)
        inside, off = shapely.contains(shape, way), shapely.distance(shape.exterior, way)
        if inside[0] or (off.min() < 0.02 and not inside.any()) or (inside.any() and off[inside].max() < 0.02):
            continue
        free = planar(tee, tip(point)).meeting(direction) is None
        assert free is not bool(inside.any())
        counts[free] += 1
    assert min(counts.values()) > 20
