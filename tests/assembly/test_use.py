"""What is done with a graph: files, a path, the sets of a state, pictures, the command."""

import json
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import networkx
import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph, contacts_at, state_at, state_control, state_graph, state_path
from fixture_design.cones import union_element
from fixture_design.contacts import face_vectors
from fixture_design.errors import AssemblyError, FileFormatError, InputError, UnknownNameError, UnsupportedError
from fixture_design.io import json_schema, read_assembly, read_graph, write_graph, write_graphml
from fixture_design.viewing import graph_picture, preview, write_graph_picture
from fixture_design.viewing.graph_drawing import _HEIGHT, _WIDTH
from fixture_design.viewing.graph_outlines import outlines_of
from fixture_design.viewing.graph_page import graph_page
from tests.assembly.parts import FIGURE_14, box, planar
from tests.cli.conftest import command  # noqa: F401 - a fixture
from tests.problems import FIGURE_14_TABLE_5


@pytest.fixture(scope="module")
def graph() -> ContactStateGraph:
    return state_graph(read_assembly(FIGURE_14), samples=6)


def test_a_graph_file_reads_back(graph: ContactStateGraph, tmp_path: Path) -> None:
    path = tmp_path / "graph.json"
    write_graph(graph, path)
    again = read_graph(path)
    for one, other in zip(graph.states, again.states, strict=True):
        assert (one.id, one.contacts, one.coincident) == (other.id, other.contacts, other.coincident)
        np.testing.assert_array_equal(one.samples, other.samples)
    for one, other in zip(graph.transitions, again.transitions, strict=True):
        assert (one.tight, one.loose) == (other.tight, other.loose)
        np.testing.assert_array_equal(one.configuration, other.configuration)
        np.testing.assert_array_equal(one.displacement, other.displacement)
    assert again.unseen == graph.unseen
    assert len(again.assembly.fixed) == 2
    loaded = networkx.node_link_graph(json.loads(path.read_text()), edges="edges")
    assert (len(loaded), loaded.number_of_edges()) == (len(graph.states), len(graph.transitions))
    assert loaded.nodes["N2"]["contacts"] == ["apex 3 - facet 5"]


def test_graphml(graph: ContactStateGraph, tmp_path: Path) -> None:
    write_graphml(graph, tmp_path / "graph.graphml")
    loaded = networkx.read_graphml(tmp_path / "graph.graphml")
    assert len(loaded) == len(graph.states)
    assert loaded.nodes["N2"]["contacts"] == "apex 3 - facet 5"


def test_a_graph_that_is_none(graph: ContactStateGraph, tmp_path: Path) -> None:
    path = tmp_path / "graph.json"
    write_graph(graph, path)
    path.write_text(path.read_text().replace('"source": "N1"', '"source": "N99"', 1))
    with pytest.raises(FileFormatError, match="there is no node 'N99'"):
        read_graph(path)


def test_into_the_hole(graph: ContactStateGraph) -> None:
    """From two points on the left top to two-point contact in the hole, every motion looked at again."""
    start = graph.with_contacts(["apex 3 - facet 5", "apex 4 - facet 5"])
    goal = graph.with_contacts(["apex 4 - facet 7", "facet 2 - apex 1"])
    assert start is not None
    assert goal is not None
    path = state_path(graph, start.id, goal.id)
    assert path is not None
    assert path.states[0] == start.id
    assert path.states[-1] == goal.id
    edges = {frozenset((edge.tight, edge.loose)) for edge in graph.transitions}
    assert all(frozenset(pair) in edges for pair in zip(path.states, path.states[1:], strict=False))
    for waypoint in path.waypoints:
        found = state_at(graph.assembly, waypoint.configuration)
        assert found.admissible
        assert found.contacts == graph.state(waypoint.state).contacts


def test_a_path_from_nowhere(graph: ContactStateGraph) -> None:
    with pytest.raises(UnknownNameError, match="no state is called 'N99'"):
        state_path(graph, "N99", "N1")


def test_face_vectors_are_those_of_the_thesis() -> None:
    """(3-35) for facet 2 - apex 1, whose outward normal is (-1, 0) in the moving frame."""
    x, y, theta = FIGURE_14_TABLE_5["N3"][0]
    c, s = np.cos(theta), np.sin(theta)
    # put exactly on the contact: the table is rounded
    x += (c * (-1.5 - x) + s * (0 - y) + 1) / c
    (contact,) = contacts_at(read_assembly(FIGURE_14), [x, y, theta])
    d = face_vectors(contact.point[None], np.array(contact.normals))[0]
    nx, ny = -1, 0
    third = (c * (-1.5 - x) + s * (0 - y)) * ny + (s * (-1.5 - x) - c * (0 - y)) * nx
    np.testing.assert_allclose(d, [c * nx - s * ny, s * nx + c * ny, third], atol=1e-12)


def test_sets_of_a_controller(graph: ContactStateGraph) -> None:
    free = state_control(graph.assembly, graph.states[0].samples[0])
    assert len(free.position_controlled) == 3
    two = graph.with_contacts(["apex 4 - facet 7", "facet 2 - apex 1"])
    assert two is not None
    control = state_control(graph.assembly, two.samples[0])
    assert len(control.position_controlled) == 1
    assert len(control.forces.spans) == 2


def test_transitions_are_admissible_to_first_order(graph: ContactStateGraph) -> None:
    """Displacements of transitions, made short, are in A of their configuration but for what bends (second order)."""
    for edge in graph.transitions:
        control = state_control(graph.assembly, edge.configuration)
        lengths = np.linalg.norm(edge.displacement)
        if lengths > 1e-2:  # longer ones bend
            continue
        near = [
            edge.displacement / lengths + noise for noise in np.vstack([np.zeros(3), 0.1 * np.eye(3), -0.1 * np.eye(3)])
        ]
        assert any(union_element(u, control.displacements) for u in near), (edge.tight, edge.loose)


def test_no_contacts_where_the_parts_overlap() -> None:
    with pytest.raises(AssemblyError, match="overlap"):
        contacts_at(read_assembly(FIGURE_14), [1.0, -2.0, 0.0])


def test_two_corners_are_one_contact_with_alternatives() -> None:
    assembly = planar(box(-0.5, -0.5, 1, 1), box(-1, -1, 1, 1))
    (contact,) = contacts_at(assembly, [0.5, 0.5, 0.0])
    assert len(contact.clauses) == 1
    assert len(contact.clauses[0]) == 2


def test_the_picture(graph: ContactStateGraph) -> None:
    picture = graph_picture(graph)
    assert picture.count("<title>") == len(graph.states)
    assert picture.count("<line ") == len(graph.transitions)
    assert "apex 4 - facet 7; facet 2 - apex 1" in picture


def test_what_moves_is_seen_whole_in_every_drawing(graph: ContactStateGraph) -> None:
    for state in graph.states:
        *_, outline = outlines_of(graph, _WIDTH, _HEIGHT)(state)
        (moving,) = outline.rings
        assert moving.min() >= 0
        assert (moving <= [_WIDTH, _HEIGHT]).all()


def test_the_page_explains_its_frames_and_does_not_scroll_sideways(graph: ContactStateGraph) -> None:
    page = graph_page(graph)
    assert ("Orange frame" in page) == any(state.coincident for state in graph.states)
    assert "max-width: 100%" in page
    with pytest.raises(UnknownNameError, match="nonsense"):
        preview(graph, show="all:nonsense")


def test_pictures_are_files(graph: ContactStateGraph, tmp_path: Path) -> None:
    write_graph_picture(graph, tmp_path / "graph.png")
    assert (tmp_path / "graph.png").read_bytes().startswith(b"\x89PNG")
    write_graph_picture(graph, tmp_path / "graph.svg")
    assert (tmp_path / "graph.svg").read_text() == graph_picture(graph) + "\n"
    with pytest.raises(UnsupportedError, match="SVG or PNG"):
        write_graph_picture(graph, tmp_path / "graph.jpg")
    with pytest.raises(FileFormatError, match="cannot be written"):
        write_graph_picture(graph, tmp_path / "nowhere" / "graph.png")


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_searches_keep_what_they_found(
    monkeypatch: pytest.MonkeyPatch,
    command: Callable,  # noqa: F811
    tmp_path: Path,
    number: int,
    code: int,
) -> None:
    def interrupt(*_: object) -> None:
        signal.raise_signal(number)

    monkeypatch.setattr("fixture_design.assembly.generate.complete", interrupt)
    ran = command("states", FIGURE_14, "-o", tmp_path / "part.json")
    assert ran.code == code
    assert ran.err.count("what was found is kept") == 1
    assert "interrupted: the graph is not complete" in ran.out
    assert "apex 3 - facet 5" in ran.out
    monkeypatch.undo()
    assert command("states", tmp_path / "part.json").code == 0


def test_inputs_are_not_written_over(command: Callable, tmp_path: Path) -> None:  # noqa: F811
    assembly, graph = tmp_path / "a.yaml", tmp_path / "g.json"
    assembly.write_bytes(FIGURE_14.read_bytes())
    before = assembly.read_bytes()
    for arguments in (["-o", assembly], ["--graphml", assembly], ["-o", graph, "--png", graph], ["-o", tmp_path]):
        assert command("states", assembly, *arguments).code == 2
    assert command("states", assembly, "-o", graph).code == 0
    for arguments in (["-o", graph], ["--c", graph], ["-o", tmp_path / "no" / "c.json"]):
        assert command("classifier", graph, *arguments).code == 2
    assert assembly.read_bytes() == before
    assert read_graph(graph).complete


def test_the_command(command: Callable, tmp_path: Path) -> None:  # noqa: F811 - the fixture
    out = tmp_path / "graph.json"
    ran = command("states", FIGURE_14, "-o", out, "--samples", 4)
    assert (ran.code, ran.err) == (0, "")
    assert "29 contact states (8 with two apices in one point)" in ran.out
    assert len(read_graph(out).states) == 29
    ran = command("states", FIGURE_14, "--at", "-2.77709,0.633807,0.686465", "--within", "1e-5")
    assert (ran.code, ran.out) == (0, "apex 3 - facet 5\n")
    ran = command("states", FIGURE_14, "--at", "1,-2,0", "--json")
    assert json.loads(ran.out)["admissible"] is False
    ran = command("states", FIGURE_14, "--at", "1,-2")
    assert (ran.code, ran.out) == (2, "")
    assert "a configuration is 3 finite numbers" in ran.err


def test_a_path_by_the_command(graph: ContactStateGraph, command: Callable, tmp_path: Path) -> None:  # noqa: F811
    """From a graph that was found before: in words, as JSON, and to a state that there is not."""
    file = tmp_path / "graph.json"
    write_graph(graph, file)
    expected = state_path(read_graph(file), "N1", "N20")
    assert expected is not None
    ran = command("states", file, "--path", "N1", "N20")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.splitlines()[0] == " - ".join(expected.states)
    assert "; ".join(graph.state("N20").contacts) in ran.out
    assert ran.out.count(" at ") + ran.out.count(" to ") == len(expected.waypoints)
    data = json.loads(command("states", file, "--path", "N1", "N20", "--json").out)
    assert data["states"] == list(expected.states)
    assert [place["state"] for place in data["waypoints"]] == [place.state for place in expected.waypoints]
    ran = command("states", file, "--path", "N1", "N99")
    assert (ran.code, ran.out) == (2, "")
    assert "no state is called 'N99'" in ran.err


def test_no_path_to_a_state_that_nothing_leads_to(graph: ContactStateGraph, command: Callable, tmp_path: Path) -> None:  # noqa: F811
    write_graph(replace(graph, transitions=()), tmp_path / "graph.json")
    ran = command("states", tmp_path / "graph.json", "--path", "N1", "N20")
    assert (ran.code, ran.out) == (1, "no path from N1 to N20 was found\n")


def test_control_sets_by_the_command(graph: ContactStateGraph, command: Callable, tmp_path: Path) -> None:  # noqa: F811
    """Every state has them: free motion has no forces, and each further contact that presses takes a direction."""
    write_graph(graph, tmp_path / "graph.json")
    ran = command("states", tmp_path / "graph.json", "--json")
    data = json.loads(ran.out)
    assert data["nodes"][0]["control"]["position_controlled"] == np.eye(3).tolist()
    for node, state in zip(data["nodes"], graph.states, strict=True):
        control = state_control(graph.assembly, state.samples[0])
        assert len(node["control"]["admissible_displacements"]["cones"]) == len(list(control.displacements))
        assert len(node["control"]["position_controlled"]) == len(control.position_controlled)


CASES = {
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]]}\n": "the key 'fixed' is missing",
    "moving: {box: [1, 1, 1]}\nfixed: {polygon: [[0, 0], [1, 0], [0, 1]]}\n": "'box' does not fit 'space: planar'",
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]], apices: {a: 3}}\nfixed: {polygon: [[0, 0], [1, 0], [0, 1]]}\n": (
        "there is no vertex 3"
    ),
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]], apices: {a: 0}}\n"
    "fixed: {polygon: [[0, 0], [1, 0], [0, 1]], facets: {a: 0}}\n": "the name 'a' is given twice",
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]], apices: {a: x}}\nfixed: {polygon: [[0, 0], [1, 0], [0, 1]]}\n": (
        "'a' is of the wrong kind"
    ),
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]], apices: 3}\nfixed: {polygon: [[0, 0], [1, 0], [0, 1]]}\n": (
        "'apices' is of the wrong kind"
    ),
    "moving: {polygon: [[0, 0], [1, 0], [0, 1]]}\nfixed: {polygon: [[0, 0], [1, 0], [0, 1]]}\n"
    "region: {x: [1, 0], y: [0, 1]}\n": "'x' is out of order",
}


@pytest.mark.parametrize("text", CASES)
def test_bad_assemblies(tmp_path: Path, text: str) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(f"schema: fixture_design/assembly/1\nspace: planar\n{text}")
    with pytest.raises(FileFormatError) as caught:
        read_assembly(path)
    assert CASES[text] in str(caught.value)
    assert "line " in str(caught.value)


@pytest.mark.parametrize(
    ("polygon", "words"),
    [
        ([[0, 0], [0, 1], [1, 0]], "clockwise"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "no simple one"),
        ([[0, 0], [1, 0], [2, 0]], "no simple one"),
    ],
)
def test_bad_polygons(polygon: list, words: str) -> None:
    with pytest.raises(InputError, match=words):
        state_graph(planar(polygon, box(0, 0, 1, 1)))


def test_millimetres() -> None:
    assembly = planar(box(0, 0, 10, 10), box(0, -20, 100, 20), region={"x": [0, 50], "y": [-10, 50]}, units="mm")
    assert assembly.moving.polygon is not None
    assert assembly.moving.polygon.max() == 0.01
    assert assembly.region is not None
    assert assembly.region.high.tolist() == [0.05, 0.05]


@pytest.mark.parametrize("kind", ["assembly", "graph"])
def test_schemas(kind: str) -> None:
    schema = json_schema(kind)
    assert schema["title"] == f"fixture_design/{kind}/1"
    assert schema["additionalProperties"] is False
    assert '"null"' not in json.dumps(schema)


def test_too_many_features_are_refused() -> None:
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    round_ones = np.column_stack([np.cos(angles), np.sin(angles)]).tolist()
    with pytest.raises(UnsupportedError, match="7200 contact pairs are too many; expected at most 4000"):
        state_graph(planar(round_ones, round_ones))
