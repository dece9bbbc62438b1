"""Bodies in space that are not convex, each given whole as one mesh."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely.geometry import Point, Polygon

from fixture_design.assembly import (
    Assembly,
    ContactStateGraph,
    contacts_at,
    rotations,
    state_at,
    state_control,
    state_graph,
)
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.polyhedron import Polyhedron, polyhedron_of
from fixture_design.assembly.rims import ConvexRims, PolygonRims
from fixture_design.assembly.separation import SeparatingAxes
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.errors import AssemblyError, UnsupportedError
from fixture_design.io import assembly_from_data, write_graph
from fixture_design.viewing import graph_picture, preview
from fixture_design.viewing.graph_outlines import outlines_of
from fixture_design.viewing.graph_scene import graph_scene
from fixture_design.viewing.graph_solids import drawn
from fixture_design.viewing.scene.shapes import Mesh, Sphere
from tests.assembly.solids import prism
from tests.geometry.parts import SHARED

FLOOR = {"box": [20, 20, 2], "pose": {"xyz": [0, 0, -1]}}
L_SHAPE = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
PLATE, HOLE = [[-4, -4], [4, -4], [4, 4], [-4, 4]], [[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]]


def spatial(moving: dict, fixed: dict | list, **region: object) -> Assembly:
    data = {"schema": "fixture_design/assembly/1", "space": "spatial", "moving": moving, "name": "test"}
    return assembly_from_data(data | {"fixed": fixed, "region": region}, "test.yaml")


def features(body: Polyhedron) -> tuple[int, int, int, int]:
    return len(body.vertices), len(body.edges), len(body.normals), len(body.pieces)


def test_an_l_has_no_apex_and_no_edge_inside(tmp_path: Path) -> None:
    """Twelve corners less the two inner ones, eighteen edges less the inner one, two facets that are not convex."""
    assembly = spatial(prism(tmp_path / "l.obj", L_SHAPE, 0, 1), FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 2])
    body = polyhedron_of(assembly.moving)
    assert features(body) == (10, 17, 8, 2)
    assert sum(piece.volume for piece in body.pieces) == pytest.approx(3, abs=1e-12)
    assert sum(not ring for ring in body.rings) == 2


def test_a_hole_has_edges_but_no_apices(tmp_path: Path) -> None:
    """A plane that touches a corner of the hole touches its rim: the rim's edges and the walls are what can be met."""
    assembly = spatial(FLOOR, prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE]), x=[-1, 1], y=[-1, 1], z=[0, 2])
    body = polyhedron_of(assembly.fixed[0])
    assert features(body) == (8, 12 + 8, 6 + 4, 4)
    assert sum(piece.volume for piece in body.pieces) == pytest.approx(8 * 8 * 2 - 1.2**2 * 2, abs=1e-9)


def test_a_step(tmp_path: Path) -> None:
    """The ends of inner edges, on the sides, are no apices."""
    steps = prism(tmp_path / "steps.obj", [[0, 0], [3, 0], [3, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]], 0, 1)
    body = polyhedron_of(spatial(steps, FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 2]).moving)
    assert features(body)[:3] == (12, 24 - 2, 10)


def test_rims_are_distances_to_polygons() -> None:
    """Against shapely: with holes, at random points, and on lines through corners, where crossings are counted."""
    area = Polygon([[0, 0], [4, 0], [4, 3], [2, 1], [0, 3]], [[[1, 0.25], [2, 0.5], [1, 0.75]]])
    rings = [np.array(ring.coords) for ring in (area.exterior, *area.interiors)]
    border = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    turned = rotations.matrices(rotations.from_vectors(np.array([[0.3, -0.4, 0.5]])))[0]
    rims = PolygonRims.around(turned[:, 2][None], [np.dstack([border, np.zeros(border.shape[:2])]) @ turned.T])
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 5, size=(400, 2))
    points[:200, 1] = rng.choice([0, 0.25, 0.5, 0.75, 1, 3], size=200)
    seen = np.column_stack([points, rng.normal(size=400)]) @ turned.T
    expected = np.array([area.boundary.distance(Point(p)) * (-1 if area.contains(Point(p)) else 1) for p in points])
    np.testing.assert_allclose(rims.beyond(seen[:, None])[:, 0, 0], expected, atol=1e-12)
    over, away = rims.over(seen[:, None], np.zeros((1, 1), dtype=int))
    np.testing.assert_allclose(over[:, 0], np.maximum(expected, 0), atol=1e-12)
    nearer, _ = rims.over(seen[:, None] - 1e-6 * away, np.zeros((1, 1), dtype=int))
    outside = expected > 1e-3
    np.testing.assert_allclose(over[outside, 0] - nearer[outside, 0], 1e-6, rtol=1e-5)


def test_both_kinds_of_rims_agree_within() -> None:
    corners = np.array([[0, 0, 0], [2, 0, 0], [3, 2, 0], [1, 3, 0.0]])
    border = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    up = np.array([[0, 0, 1.0]])
    points = np.random.default_rng(1).uniform([-1, -1, 0], [4, 4, 0], size=(300, 1, 3))
    convex, any_kind = ConvexRims.around(up, [border]).beyond(points), PolygonRims.around(up, [border]).beyond(points)
    np.testing.assert_allclose(convex[convex < 0], any_kind[convex < 0], atol=1e-12)
    assert (any_kind[convex > 0] >= convex[convex > 0] - 1e-12).all()


def test_overlap_is_that_of_prisms(tmp_path: Path) -> None:
    """An L in a plate's hole, upright at any yaw: they overlap if and only if their outlines do, at one height."""
    small = (np.array(L_SHAPE) * 0.3 - 0.3).tolist()
    assembly = spatial(
        prism(tmp_path / "l.obj", small, 0, 1),
        prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE]),
        x=[-1, 1], y=[-1, 1], z=[-3.2, 0.2],
    )  # fmt: skip
    geometry = geometry_of(assembly)
    rng = np.random.default_rng(0)
    xyz, yaw = rng.uniform([-0.7, -0.7, -3.2], [0.7, 0.7, 0.2], size=(300, 3)), rng.uniform(-np.pi, np.pi, 300)
    turned = rotations.from_vectors(np.column_stack([np.zeros((300, 2)), yaw]))
    depth = geometry.overlap(np.column_stack([xyz, turned]))
    plate = Polygon(PLATE, [HOLE])
    c, s = np.cos(yaw), np.sin(yaw)
    outlines = shapely.polygons(
        np.einsum("nij,vj->nvi", np.moveaxis(np.array([[c, -s], [s, c]]), -1, 0), small) + xyz[:, None, :2]
    )
    expected = (shapely.area(shapely.intersection(outlines, plate)) > 1e-9) & (xyz[:, 2] < 0) & (xyz[:, 2] > -3)
    np.testing.assert_array_equal(depth > 1e-9, expected)
    assert 30 < expected.sum() < 270


@pytest.fixture(scope="module")
def graph(tmp_path_factory: pytest.TempPathFactory) -> ContactStateGraph:
    """An L on a plane."""
    body = prism(tmp_path_factory.mktemp("parts") / "l.obj", L_SHAPE, -0.5, 0.5) | {"pose": {"xyz": [-0.7, -0.7, 0]}}
    return state_graph(spatial(body, FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 3]), samples=4)


def test_an_l_on_a_plane(graph: ContactStateGraph) -> None:
    """It stands as its convex hull does, a prism with five sides; its inner facets touch nothing."""
    assert sorted(len(state.contacts) for state in graph.states) == [0] + [1] * 10 + [2] * 15 + [4] * 5 + [5] * 2
    for state in graph.states:
        for q in state.samples:
            assert state_at(graph.assembly, q).contacts == state.contacts


def test_pictures_in_space(graph: ContactStateGraph, tmp_path: Path) -> None:
    """A drawing for each state, with the facets that are seen: eight of the moving part at most, the floor's three."""
    picture = graph_picture(graph)
    assert picture.count("<title>") == len(graph.states)
    assert picture.count("<line ") == len(graph.transitions)
    outlines = [list(outlines_of(graph, 100.0, 80.0)(state)) for state in graph.states]
    seen = [len(each) - 2 * 3 for each in outlines]
    assert min(seen) >= 1
    assert max(seen) <= 7
    preview(graph).save(tmp_path / "graph.png")
    assert (tmp_path / "graph.png").read_bytes().startswith(b"\x89PNG")


def test_a_hole_is_drawn_as_one(tmp_path: Path) -> None:
    """Both plane sides have an outer ring one way round and an inner one the other; triangles cover what is left."""
    assembly = spatial(FLOOR, prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE]), x=[-1, 1], y=[-1, 1], z=[0, 2])
    body = drawn(assembly.fixed[0])
    assert sorted(len(facet.rings) for facet in body.facets) == [1] * 8 + [2] * 2
    a, b, c = (body.mesh.vertices[body.mesh.triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(2 * (64 - 1.44) + 4 * 8 * 2 + 4 * 1.2 * 2, abs=1e-9)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(8 * 8 * 2 - 1.44 * 2, abs=1e-9)


def test_a_preview_in_space_has_every_state(graph: ContactStateGraph, tmp_path: Path) -> None:
    """One story a state, with a dot where each contact is; the page loads nothing and names them all."""
    scene = graph_scene(graph)
    assert [story.claim for story in scene.stories] == [state.id for state in graph.states]
    for story, state in zip(scene.stories, graph.states, strict=True):
        dots = [thing.shape for thing in story.things if isinstance(thing.shape, Sphere)]
        assert len(dots) == len(state.contacts)
        assert all(abs(dot.center[2]) < 1e-9 for dot in dots)
        low = min(thing.shape.vertices[:, 2].min() for thing in story.things if isinstance(thing.shape, Mesh))
        assert (abs(low) < 1e-9) == bool(state.contacts)
    write_graph(graph, tmp_path / "graph.json")
    preview(tmp_path / "graph.json").save(tmp_path / "graph.html")
    page = (tmp_path / "graph.html").read_text()
    assert page.count('class="answer"') == len(graph.states)
    assert "33 contact states" in page
    assert "pushes that balance" not in page
    assert "default-src 'none'" in page.replace("&#x27;", "'")


#: Where a unit cube is in the hole of the plate, and what its motions are: those of a wall, of a concave corner, of the
#: plate's top, none, and at the rim those above or inside it.
IN_THE_HOLE = {
    (0.1, 0, 0.3): (4, 3, 4, 1),
    (0.1, 0.1, 0.3): (6, 1, 8, 1),
    (0.3, 0, 0.5): (4, 3, 4, 1),
    (0, 0, 0.5): (0, 6, 0, 1),
    (0.1, 0, 0.5): (2, 4, 0, 4),
}


@pytest.mark.parametrize("place", IN_THE_HOLE)
def test_contacts_and_control_in_space(tmp_path: Path, place: tuple[float, float, float]) -> None:
    """Contacts, dimensions of free motion, spans of the forces, cones of displacements."""
    assembly = spatial({"box": [1, 1, 1]}, prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE]), x=[-1, 1], y=[-1, 1],
                       z=[-3, 2])  # fmt: skip
    contacts, control = contacts_at(assembly, [*place, 1, 0, 0, 0]), state_control(assembly, [*place, 1, 0, 0, 0])
    cones = len(list(control.displacements))
    assert (len(contacts), len(control.position_controlled), len(control.forces.spans), cones) == IN_THE_HOLE[place]


def test_normals_in_space_are_face_vectors(tmp_path: Path) -> None:
    """A corner on a floor, an edge across an edge: leaving is admissible, entering is not."""
    assembly = spatial({"box": [1, 1, 1]}, FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 2])
    (q,) = rotations.from_vectors(np.array([[0.3, 0.4, 0]]))
    height = -(rotations.matrices(q[None])[0] @ (np.array(list(np.ndindex(2, 2, 2))).T - 0.5))[2].min()
    (contact,) = contacts_at(assembly, [0, 0, height, *q])
    np.testing.assert_allclose(contact.normals, [[0, 0, -1]], atol=1e-12)
    assert contact.point[2] == pytest.approx(-height, abs=1e-12)
    with pytest.raises(AssemblyError, match="overlap"):
        contacts_at(assembly, [0, 0, height - 1e-3, *q])


@pytest.mark.slow
def test_a_square_peg_over_a_hole_in_one_mesh(tmp_path: Path) -> None:
    """The states that four boxes around a hole have, counted in `test_space`."""
    plate = prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE])
    region: dict = {"x": [-0.5, 0.5], "y": [-0.5, 0.5], "z": [-0.4, 1.5], "rotation": "fixed"}
    graph = state_graph(spatial({"box": [1, 1, 1]}, plate, **region), samples=4)
    assert len(graph.states) == 1 + 4 + 4 + (5 * 5 - 1)
    assert all(state_at(graph.assembly, q).admissible for state in graph.states for q in state.samples)


def test_round_parts_are_refused_by_name(tmp_path: Path) -> None:
    """A pipe: what moves must be convex."""
    circle = np.array([[np.cos(t), np.sin(t)] for t in np.linspace(0, 2 * np.pi, 48, endpoint=False)])
    pipe = prism(tmp_path / "pipe.obj", circle.tolist(), 0, 3, [(0.5 * circle).tolist()])
    with pytest.raises(UnsupportedError, match=r"'pipe' has round surfaces \(cylinder 1, cylinder 2\)"):
        state_graph(spatial(pipe, FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 3]))


def test_the_factory_peg_and_hole() -> None:
    """The peg has bevelled edges, cut into hundreds of triangles; it has the play of its data sheet."""
    folder = SHARED / "IsaacGymEnvs" / "assets" / "factory" / "urdf"
    if not folder.is_dir():
        pytest.skip("needs the shared data")
    peg, hole = (
        {"urdf": str(folder / f"factory_rectangular_{name}_8mm{kind}.urdf")}
        for name, kind in (("peg", "_loose"), ("hole", ""))
    )
    assembly = spatial(peg, hole, x=[-0.01, 0.01], y=[-0.01, 0.01], z=[-0.001, 0.03])
    geometry = geometry_of(assembly)
    assert features(geometry.moving) == (16, 24, 10, 1)  # type: ignore[attr-defined]
    assert features(geometry.fixed[0]) == (8, 20, 10, 4)  # type: ignore[attr-defined]
    assert state_at(assembly, [0, 0, 0.001, 1, 0, 0, 0]).contacts == ()
    # the mesh has the sides of the sheet to six decimals
    play = (0.008144 - 0.007964) / 2
    assert play == pytest.approx((0.0081444 - 0.007964) / 2, abs=1e-6)
    walls = {contact.split(" - ")[1] for contact in state_at(assembly, [play, 0, 0.001, 1, 0, 0, 0], 1e-8).contacts}
    assert len([wall for wall in walls if wall.startswith("facet")]) == 1
    assert not state_at(assembly, [play + 1e-6, 0, 0.001, 1, 0, 0, 0]).admissible


def test_pieces_along_the_same_axes_are_looked_at_together(tmp_path: Path) -> None:
    """The four boxes of a plate with a hole; a turned one is alone. How deep they overlap is as one by one."""
    plate = prism(tmp_path / "plate.obj", PLATE, -2, 0, [HOLE])
    turned = {"box": [1, 1, 1], "pose": {"xyz": [3, 0, 0.5], "rpy": [0, 0, 0.5]}}
    geometry = geometry_of(spatial({"box": [1, 1, 1]}, [plate, turned], x=[-1, 1], y=[-1, 1], z=[-1, 1]))
    assert isinstance(geometry, SpatialGeometry)
    assert [len(axes.theirs) for axes in geometry.axes] == [4, 1]
    q = geometry.random(np.random.default_rng(0), 300)
    R = rotations.matrices(q[:, 3:])
    pieces = [piece for body in geometry.fixed for piece in body.pieces]
    alone = [
        axes.overlap(R, q[:, :3]) for piece in pieces for axes in SeparatingAxes.of(geometry.moving.pieces[0], [piece])
    ]
    np.testing.assert_allclose(geometry.overlap(q), np.max(alone, axis=0), atol=1e-12)
    assert 0 < np.count_nonzero(geometry.overlap(q) > 0) < 300
