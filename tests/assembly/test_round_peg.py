"""Round pegs in round holes: the same graph at any resolution of the meshes, and what the true shapes say of it.

The plate's top is z = 0 and its hole about z, so that plain numpy on dense points of the true peg tells what is inside
of the plate, without any distance function of the package.
"""

from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, contacts_at, geometry_of, rotations, state_graph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.round_space import RIM_POINTS, RoundGeometry
from fixture_design.assembly.sampling import onto
from fixture_design.assembly.sorting import sort_configurations, states_of
from fixture_design.errors import UnsupportedError
from tests.assembly.followed import followed
from tests.assembly.rounds import peg, plate
from tests.assembly.test_not_convex import FLOOR, SHARED, spatial

PLAIN = [(0.0, 0.9), (3.0, 0.9)]
BEVELLED = [(0.0, 0.7), (0.2, 0.9), (3.0, 0.9)]
HOLE, THICK = 1.0, 1.0
REGION: dict = {"x": [-0.6, 0.6], "y": [-0.6, 0.6], "z": [-0.6, 0.4], "rotation": 0.3}


def graph_of(folder: Path, circles: list, facets: int, **region: object) -> ContactStateGraph:
    shape = peg(folder / f"peg{facets}.obj", circles, facets)
    around = plate(folder / f"plate{facets}.obj", 4, THICK, HOLE, facets)
    return state_graph(spatial(shape, around, **(REGION | region)), samples=4)


def states(graph: ContactStateGraph) -> set[tuple[str, ...]]:
    return {state.contacts for state in graph.states}


def transitions(graph: ContactStateGraph) -> set[tuple]:
    return {(graph.state(edge.tight).contacts, graph.state(edge.loose).contacts) for edge in graph.transitions}


def true_points(circles: list, around: int = 720, along: int = 40) -> np.ndarray:
    """Points of the true peg's circles and of the surfaces between them, in its frame, shape (rings, around, 3)."""
    heights, radii = np.array(circles).T
    lengths = np.arange(len(circles) - 1)
    t = np.concatenate([np.linspace(k, k + 1, along, endpoint=False) for k in lengths] + [[len(circles) - 1.0]])
    z, r = np.interp(t, np.arange(len(circles)), heights), np.interp(t, np.arange(len(circles)), radii)
    angles = np.linspace(0, 2 * np.pi, around, endpoint=False)
    x, y = r[:, None] * np.cos(angles), r[:, None] * np.sin(angles)
    return np.stack([x, y, np.broadcast_to(z[:, None], x.shape)], axis=-1)


def placed(points: np.ndarray, q: np.ndarray) -> np.ndarray:
    return points @ rotations.matrices(q[None, 3:])[0].T + q[:3]


def deepest(points: np.ndarray) -> float:
    """How deep the deepest of some points is in the plate, by its analytic shape; not positive where none is."""
    rho = np.hypot(points[..., 0], points[..., 1])
    inside = np.minimum(np.minimum(-points[..., 2], points[..., 2] + THICK), rho - HOLE)
    return float(inside.max())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("round")


@pytest.fixture(scope="module")
def upright(folder: Path) -> ContactStateGraph:
    """Nothing turns: a disk over a plate with a hole."""
    return graph_of(folder, PLAIN, 24, rotation="fixed")


def test_a_round_peg_has_a_handful_of_features(folder: Path) -> None:
    geometry = geometry_of(
        spatial(peg(folder / "p.obj", BEVELLED, 96), plate(folder / "h.obj", 4, THICK, HOLE, 96), **REGION)
    )
    assert isinstance(geometry, RoundGeometry)
    np.testing.assert_allclose(geometry.moving.radii, [0.7, 0.9, 0.9], atol=1e-9)
    np.testing.assert_allclose(geometry.fixed[0].holes[0].radius, HOLE, atol=1e-9)
    assert len(geometry.names) == 15


def test_the_factory_pegs() -> None:
    """The peg has four circles, of which the region leaves two; no edges are in reach."""
    folder = SHARED / "IsaacGymEnvs" / "assets" / "factory" / "mesh" / "factory_insertion"
    if not folder.is_dir():
        pytest.skip("needs the shared data")
    for size in (8, 16):
        shape, around = (
            {"mesh": str(folder / f"factory_round_{name}.obj"), "scale": 1}
            for name in (f"peg_{size}mm_loose", f"hole_{size}mm_subdiv_3x")
        )
        region: dict = {"x": [-1e-3, 1e-3], "y": [-1e-3, 1e-3], "z": [4e-3, 11e-3], "rotation": 0.1}
        geometry = geometry_of(spatial(shape, around, **region))
        assert isinstance(geometry, RoundGeometry)
        assert len(geometry.names) == 15
        assert len(geometry.moving.radii) == 4


@pytest.mark.slow
def test_an_upright_peg(upright: ContactStateGraph) -> None:
    """On the plate or over the rim, at the wall, at both where the peg is within the hole at its top, or nowhere."""
    on, wall = ("circle 1 - facet 4", "disk 1 - facet 4"), ("circle 1 - cylinder 2", "cylinder 1 - circle 3")
    crossing = ("circle 1 - circle 3", "circle 1 - circle 3 again")
    together = tuple(sorted(("circle 1 - cylinder 2", "cylinder 1 - circle 3", *on)))
    assert states(upright) == {(), wall, tuple(sorted((*crossing, *on))), together}


def test_a_peg_on_a_floor(folder: Path) -> None:
    """It stands on either end, leans on either circle, lies on both, or is in the air, whichever way it is turned."""
    shape = peg(folder / "lying.obj", [(-1.0, 0.5), (1.0, 0.5)], 24)
    found = state_graph(spatial(shape, FLOOR, x=[-1, 1], y=[-1, 1], z=[0, 2]), samples=4)
    floor = next(name for state in states(found) for contact in state for name in [contact.split(" - ")[1]])
    leaning = [(f"circle {k} - {floor}",) for k in (1, 2)]
    standing = [(f"circle {k} - {floor}", f"disk {k} - {floor}") for k in (1, 2)]
    lying = (f"circle 1 - {floor}", f"circle 2 - {floor}")
    assert states(found) == {(), *leaning, *standing, lying}
    expected = {(tight, (leaning[k],)[0]) for k, tight in enumerate(standing)}
    expected |= {(lying, one) for one in leaning} | {(tight, ()) for tight in states(found) - {()}}
    assert transitions(found) == expected


def test_gradients_are_those_of_the_distances(folder: Path) -> None:
    """Of gaps, of how far beyond ends, and of tilts, by differences."""
    geometry = geometry_of(
        spatial(peg(folder / "p.obj", BEVELLED, 48), plate(folder / "h.obj", 4, THICK, HOLE, 48), **REGION)
    )
    assert isinstance(geometry, RoundGeometry)
    q, every = geometry.random(np.random.default_rng(0), 400), np.arange(len(geometry.names))[None]
    found, step = geometry.equations(q, every), 1e-6
    values = np.stack([
        (geometry.equations(geometry.moved(q, step * d), every).values
         - geometry.equations(geometry.moved(q, -step * d), every).values) / (2 * step)
        for d in np.broadcast_to(np.eye(6)[:, None], (6, len(q), 6))
    ], axis=-1)  # fmt: skip
    off = np.abs(values - found.gradients).max(axis=-1)
    # a difference across a jump (a place that ends, or begins) is none
    exists = geometry.distances(q) < geometry.size
    assert np.quantile(off[exists][:, 0], 0.97) < 1e-6
    assert np.quantile(off[exists][:, 1], 0.95) < 1e-5
    assert off[..., 2:].max() < 1e-6


def test_overlap_is_that_of_the_true_shapes(folder: Path) -> None:
    """Random configurations against dense points of the peg, and of the rim, which may reach into it."""
    geometry = geometry_of(
        spatial(peg(folder / "p.obj", BEVELLED, 24), plate(folder / "h.obj", 4, THICK, HOLE, 24), **REGION)
    )
    assert isinstance(geometry, RoundGeometry)
    rng = np.random.default_rng(1)
    q = geometry.random(rng, 1500)
    depth, points = geometry.overlap(q), true_points(BEVELLED)
    by_points = np.array([deepest(placed(points, row)) for row in q])
    inside_out = np.array([rim_inside(BEVELLED, row) for row in q])
    truth = np.maximum(by_points, inside_out)
    clear = np.abs(truth) > 1e-3
    np.testing.assert_array_equal((depth > 1e-9)[clear], (truth > 0)[clear])
    assert 300 < (truth > 0).sum() < 1400


def rim_inside(circles: list, q: np.ndarray) -> float:
    """How deep the hole's rim is in the peg."""
    angles = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    rim = np.column_stack([HOLE * np.cos(angles), HOLE * np.sin(angles), 0 * angles])
    own = (rim - q[:3]) @ rotations.matrices(q[None, 3:])[0]
    radius = np.interp(own[:, 2], *np.array(circles).T, left=-np.inf, right=-np.inf)
    inside = np.minimum(radius - np.hypot(own[:, 0], own[:, 1]), np.minimum(own[:, 2], 3 - own[:, 2]))
    return float(inside.max())


@pytest.mark.slow
def test_a_disk_on_the_plate_pushes_at_points_of_its_rim(upright: ContactStateGraph) -> None:
    state = next(state for state in upright.states if "circle 1 - circle 3" in state.contacts)
    contacts = contacts_at(upright.assembly, state.samples[0])
    rim = [contact for contact in contacts if "rim point" in contact.name]
    assert 3 <= len(rim) < RIM_POINTS
    for contact in contacts:
        point = contact.point + state.samples[0][:3]
        assert abs(point[2]) < 1e-9
        assert np.hypot(*point[:2]) > HOLE - 1e-9


def test_what_is_refused(folder: Path) -> None:
    """Edges in reach, holes that are too small, and a body that does not turn."""
    shape = peg(folder / "p.obj", PLAIN, 48)
    with pytest.raises(UnsupportedError, match="straight edge"):
        geometry_of(spatial(shape, FLOOR, x=[-8, 8], y=[-1, 1], z=[0, 3]))
    with pytest.raises(UnsupportedError, match="seat on its rim"):
        geometry_of(spatial(shape, plate(folder / "small.obj", 4, 1, 0.8, 48), **REGION))
    with pytest.raises(UnsupportedError, match=r"'plate' has round surfaces \(cylinder 1\)"):
        geometry_of(spatial({"box": [1, 1, 1]}, plate(folder / "plate.obj", 4, 1, 1, 48), **REGION))


@pytest.fixture(scope="module")
def graph(folder: Path) -> ContactStateGraph:
    return graph_of(folder, PLAIN, 24)


@pytest.fixture(scope="module")
def geometry(graph: ContactStateGraph) -> ContactGeometry:
    return geometry_of(graph.assembly)


@pytest.mark.slow
def test_the_graph_is_the_same_at_any_resolution(folder: Path, graph: ContactStateGraph) -> None:
    fine = graph_of(folder, PLAIN, 96)
    assert states(fine) == states(graph)
    assert transitions(fine) == transitions(graph)


@pytest.mark.slow
def test_every_sample_touches_exactly_so(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    """By the package; and by dense points of the true circles, which touch the wall or the top if a state says so."""
    assert len(graph.states) == 14
    points = true_points(PLAIN)
    ring = true_points([PLAIN[0], PLAIN[0]], around=4000)[0]
    for state in graph.states:
        found = sort_configurations(geometry, state.samples)
        assert found.clear.all()
        assert set(states_of(geometry, found.touching)) == {state.contacts}
        for q in state.samples:
            assert deepest(placed(points, q)) < 2e-5
            assert rim_inside(PLAIN, q) < 2e-5
            x = placed(ring, q)
            rho, low = np.hypot(x[:, 0], x[:, 1]), x[:, 2].min()
            wall = (HOLE - rho[x[:, 2] < 2e-5]).min(initial=1.0)
            assert ("circle 1 - cylinder 2" not in state.contacts) or wall < 2e-5
            assert ("circle 1 - facet 4" not in state.contacts) or abs(low) < 2e-5
            # a circle that goes over the rim has points near it; dense ones are 2e-3 apart
            across = np.hypot(rho - HOLE, x[:, 2]).min()
            assert ("circle 1 - circle 3" not in state.contacts) or across < 2e-3


@pytest.mark.slow
def test_every_transition_has_a_feasible_path(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    points = true_points(PLAIN, around=180, along=10)
    for edge in graph.transitions:
        q = followed(graph, geometry, edge)
        assert all(deepest(placed(points, row)) < 1e-8 for row in q)


@pytest.mark.slow
def test_a_search_by_other_sets_finds_nothing_new(graph: ContactStateGraph, geometry: ContactGeometry) -> None:
    """Random sets of one to four pairs from anywhere in the region, 12000 times."""
    rng = np.random.default_rng(7)
    seen: set[tuple[str, ...]] = set()
    for count in (1, 2, 3, 4):
        sets = rng.integers(len(geometry.names), size=(3000, count))
        seen.update(states_of(geometry, onto(geometry, geometry.random(rng, 3000), sets).touching))
    assert seen - states(graph) == set()
    assert len(seen) > 0.5 * len(graph.states)
