"""The layouts of urdf/ hold what they require: by rank and linear programs here, without any of the toolkit's own code.

Rows are [n; (x - reference) X n / length] with unit outward normals; a motion u is admissible if row . u <= 0. An OR
gives one matrix a branch.
"""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.optimize import linprog

URDF = Path(__file__).resolve().parents[2] / "urdf"
FIGURE_8 = {path.name.removesuffix(".layout.yaml"): path for path in (URDF / "figure8").glob("*.layout.yaml")}


def read(path: Path) -> dict:
    return yaml.safe_load(path.read_text())


def row(point, normal, reference, length) -> np.ndarray:
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    lever = (np.asarray(point, float) - reference) / length
    moment = np.cross(lever, n) if len(n) == 3 else [lever[0] * n[1] - lever[1] * n[0]]
    return np.r_[n, moment]


def closed(rows: np.ndarray) -> bool:
    """Only u = 0 has rows . u <= 0: full rank, and positive weights that balance all rows."""
    balance = linprog(np.zeros(len(rows)), A_eq=rows.T, b_eq=np.zeros(rows.shape[1]), bounds=[(1, None)] * len(rows))
    return bool(balance.status == 0 and np.linalg.matrix_rank(rows) == rows.shape[1])


def way_out(rows: np.ndarray) -> float:
    """The largest t with row . u <= -t for all rows and |u|_inf <= 1: above zero if and only if strongly accessible."""
    d = rows.shape[1]
    found = linprog(
        np.r_[np.zeros(d), -1],
        A_ub=np.c_[rows, np.ones(len(rows))],
        b_ub=np.zeros(len(rows)),
        bounds=[(-1, 1)] * (d + 1),
    )
    return -found.fun


def branches(layout: dict, reference=(0.0, 0.0), length=1.0) -> list[np.ndarray]:
    alternatives = [contact.get("any_of") or [contact["normal"]] for contact in layout["contacts"]]
    points = [contact["point"] for contact in layout["contacts"]]
    return [
        np.array([row(point, normal, reference, length) for point, normal in zip(points, choice, strict=True)])
        for choice in product(*alternatives)
    ]


# --- bracket ----------------------------------------------------------------------------------------------------------

#: Where each element must be: its face's outward normal, by name.
BRACKET_NORMALS = {
    **dict.fromkeys(("L1", "L2", "L3"), (0, 0, -1)),
    **dict.fromkeys(("L4", "L5"), (0, -1, 0)),
    "L6": (-1, 0, 0),
    "K2": (0, 1, 0),
    "K3": (1, 0, 0),
    "K1": (0, 0, 1),
}


@pytest.fixture(scope="module")
def bracket() -> dict:
    return read(URDF / "bracket" / "bracket.layout.yaml")


@pytest.fixture(scope="module")
def bracket_rows(bracket) -> dict[str, np.ndarray]:
    half = np.array([0.03, 0.02, 0.015])
    return {
        e["name"]: row(e["at"], BRACKET_NORMALS[e["name"]], half, np.linalg.norm(half)) for e in bracket["elements"]
    }


def test_bracket_elements_touch_the_faces_meant(bracket):
    import trimesh

    mesh = trimesh.load(URDF / "bracket" / "bracket.obj", process=False)
    assert [e["name"] for e in bracket["elements"]] == list(BRACKET_NORMALS)
    for element in bracket["elements"]:
        nearest, distance, triangle = trimesh.proximity.closest_point(mesh, [element["at"]])
        assert distance[0] < 1e-12, element["name"]
        assert np.allclose(mesh.face_normals[triangle[0]], BRACKET_NORMALS[element["name"]], atol=1e-12), element[
            "name"
        ]
        # Two millimetres around the point still belong to the face: away from edges and from the hole.
        across = np.flatnonzero(np.array(BRACKET_NORMALS[element["name"]]) == 0)
        for axis, sign in product(across, (-1, 1)):
            beside = nearest[0] + 0.002 * sign * np.eye(3)[axis]
            assert trimesh.proximity.closest_point(mesh, [beside])[1][0] < 1e-12, element["name"]


def test_bracket_locators_are_deterministic_and_strongly_accessible(bracket, bracket_rows):
    rows = np.array([bracket_rows[e["name"]] for e in bracket["elements"] if e["role"] == "locator"])
    assert rows.shape == (6, 6)
    assert np.linalg.svd(rows, compute_uv=False).min() > 0.4
    assert way_out(rows) > 0.5


def test_bracket_is_form_closed_with_a_margin(bracket_rows):
    rows = np.array(list(bracket_rows.values()))
    assert closed(rows)
    assert np.allclose(np.array([1, 1, 2, 1, 1, 1, 2, 1, 4]) @ rows, 0, atol=1e-12)  # as the file's comment says
    # The margin s = min over |u| = 1 of max row . u is at least the radius of the largest ball about 0 in the rows'
    # convex hull; in fact they are the same.
    from scipy.spatial import ConvexHull

    margin = -ConvexHull(rows).equations[:, -1].max()
    assert margin > 0.07


def test_bracket_needs_each_clamp(bracket_rows):
    for clamp in ("K1", "K2", "K3"):
        assert not closed(np.array([r for name, r in bracket_rows.items() if name != clamp])), clamp


# --- Figure 8 ---------------------------------------------------------------------------------------------------------


def test_all_layouts_of_figure_8_are_there():
    assert set(FIGURE_8) == {"p1234", "p12345", "p234", "p1345", "p134_friction", "polygon_p12345"}
    for path in FIGURE_8.values():
        layout = read(path)
        assert layout["schema"] == "fixture_design/layout/1"
        assert layout["space"] == "planar"
        assert all(item["role"] == "locator" for item in layout.get("contacts", []) + layout.get("elements", []))


def test_names_differ():
    names = [read(path)["name"] for path in URDF.rglob("*.layout.yaml")]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("name", ["p1234", "p12345", "p234", "p1345", "p134_friction"])
def test_the_contacts_give_the_vectors_of_equation_2_64(name):
    vectors = {
        "P1": [[0, 1, 1]],
        "P2": [[-1, 1, -2], [-1, -1, 2]],
        "P3": [[0, -1, 0]],
        "P4": [[0, -1, -2]],
        "P5": [[1, 0, 0]],
    }
    contacts = read(FIGURE_8[name])["contacts"]
    digits = name.removesuffix("_friction")[1:]
    assert [contact["name"] for contact in contacts] == [f"P{digit}" for digit in digits]
    for contact in contacts:
        x, y = contact["point"]
        normals = contact.get("any_of") or [contact["normal"]]
        assert [[nx, ny, x * ny - y * nx] for nx, ny in normals] == vectors[contact["name"]]


def test_figure_8_p1234():
    layout = read(FIGURE_8["p1234"])
    assert layout["require"] == {"all": ["accessible"]}
    both = branches(layout)
    assert len(both) == 2
    assert any(np.all(rows @ [1, 0, 0] <= 0) for rows in both)  # accessible, so not form closed
    assert all(way_out(rows) < 1e-9 for rows in both)  # not strongly


def test_figure_8_p12345():
    layout = read(FIGURE_8["p12345"])
    assert layout["require"] == {"all": ["form_closure"]}
    assert [closed(rows) for rows in branches(layout)] == [True, True]


def test_figure_8_p234():
    layout = read(FIGURE_8["p234"])
    assert layout["require"] == {"all": ["accessible", "strongly_accessible"]}
    assert any(np.all(rows @ [2, 1, 0] < 0) for rows in branches(layout))


def test_figure_8_p1345():
    layout = read(FIGURE_8["p1345"])
    assert "require" not in layout
    (rows,) = branches(layout)
    assert np.allclose(np.array([2, 1, 1, 0]) @ rows, 0)  # bidirectional
    assert np.all(rows @ [-1, 0, 0] <= 0)


def test_figure_8_p134_with_friction():
    layout = read(FIGURE_8["p134_friction"])
    assert layout["require"] == {"all": ["force_closure"]}
    edges = []
    for contact in layout["contacts"]:
        normal = np.array(contact["normal"], float)
        tangent = np.array([-normal[1], normal[0]])
        for side in (-layout["friction"], layout["friction"]):
            x, n = contact["point"], normal + side * tangent
            edges.append([*n, x[0] * n[1] - x[1] * n[0]])
    assert closed(np.array(edges))
    assert not closed(branches(layout)[0])


def test_the_polygon_has_the_contacts_that_are_given_outright():
    polygon_layout, given = read(FIGURE_8["polygon_p12345"]), read(FIGURE_8["p12345"])
    assert polygon_layout["require"] == {"all": ["form_closure"]}
    vertices = np.array(polygon_layout["part"]["polygon"], float)
    after = np.roll(vertices, -1, axis=0)
    assert (vertices[:, 0] @ after[:, 1] - vertices[:, 1] @ after[:, 0]) > 0  # counter-clockwise
    outward = np.c_[after[:, 1] - vertices[:, 1], vertices[:, 0] - after[:, 0]]
    for element, contact in zip(polygon_layout["elements"], given["contacts"], strict=True):
        assert element["name"] == contact["name"]
        assert element["at"] == contact["point"]
        at = np.array(element["at"], float)
        touched = [
            normal / np.linalg.norm(normal)
            for a, b, normal in zip(vertices, after, outward, strict=True)
            if normal @ (at - a) == 0 and 0 <= (at - a) @ (b - a) <= (b - a) @ (b - a)
        ]
        expected = [np.array(n) / np.linalg.norm(n) for n in contact.get("any_of") or [contact["normal"]]]
        assert np.allclose(sorted(map(tuple, touched)), sorted(map(tuple, expected)), atol=1e-15)
