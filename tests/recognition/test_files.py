"""Classifier files, logs, sensors, exported code, and the two commands."""

from __future__ import annotations

import ctypes
import json
import runpy
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fixture_design.assembly import ContactStateGraph
from fixture_design.errors import FileFormatError, InputError
from fixture_design.io import json_schema, read_classifier, read_log, write_classifier, write_graph
from fixture_design.layout import Pose
from fixture_design.recognition import (
    Classifier,
    Log,
    Noise,
    Sensor,
    build_classifier,
    c_source,
    numpy_source,
    recognize_log,
)
from fixture_design.recognition.tables import Tables, discriminated
from fixture_design.recognition.widened import Widened, widened_group
from tests.cli.conftest import command  # noqa: F401 - a fixture
from tests.recognition.graphs import FOUR, subgraph

WRENCHES = np.random.default_rng(3).normal(size=(300, 3)) * [3, 3, 5]


@pytest.fixture
def file(four: Classifier, tmp_path: Path) -> Path:
    write_classifier(four, tmp_path / "four.json")
    return tmp_path / "four.json"


def test_a_classifier_file_reads_back(four: Classifier, file: Path) -> None:
    again = read_classifier(file)
    assert (again.name, again.signals, again.noise, again.made) == (four.name, four.signals, four.noise, four.made)
    for one, other in zip(four.states, again.states, strict=True):
        assert (one.id, one.contacts, one.successors) == (other.id, other.contacts, other.successors)
        assert one.measured.widening == other.measured.widening
        for a, b in zip(one.measured.cones, other.measured.cones, strict=True):
            np.testing.assert_array_equal(a.faces, b.faces)
            np.testing.assert_array_equal(a.equalities, b.equalities)
    assert [(t.source, t.target, t.faces) for t in four.transitions] == [
        (t.source, t.target, t.faces) for t in again.transitions
    ]
    for wrench in WRENCHES[:50]:
        assert again.recognize(wrench).states == four.recognize(wrench).states


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"measure": "force"', '"measure": "sound"', "'measure' is none of|sound"),
        ('"successors": ["N1"', '"successors": ["N77"', "there is no state 'N77'"),
        ('"source": "N1"', '"source": "N77"', "there is no state 'N77'"),
        ('"faces": [[', '"faces": [[0.5, ', "a face vector has 4 numbers"),
        ('"length": 1.0', '"length": -1.0', "length"),
        ('"length": 1.0', '"length": 1e30', "length"),
        ('"interpolation": "neighbours"', '"interpolation": "nearest"', "'interpolation' is none of|nearest"),
        ("fixture_design/classifier/1", "fixture_design/graph/1", "it is a contact-state graph"),
        ("fixture_design/classifier/1", "fixture_design/classifier/2", "needs a newer"),
    ],
)
def test_files_that_are_no_classifier(file: Path, old: str, new: str, words: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(FileFormatError, match=words):
        read_classifier(file)


def test_a_face_that_is_not_there(file: Path) -> None:
    data = json.loads(file.read_text())
    at = next(k for k, some in enumerate(data["transitions"]) if some["faces"][0])
    data["transitions"][at]["faces"][0][0] = 99
    file.write_text(json.dumps(data))
    with pytest.raises(FileFormatError, match=rf"transitions\[{at}\].*face 99 of a cone"):
        read_classifier(file)


@pytest.mark.parametrize("factor", [0.0, 1e3, 1e-3, 1.0 + 1e-5])
def test_rows_that_are_no_unit_vectors(file: Path, factor: float) -> None:
    data = json.loads(file.read_text())
    cone = data["states"][1]["cones"][0]
    cone["faces"][1] = [factor * number for number in cone["faces"][1]]
    file.write_text(json.dumps(data))
    with pytest.raises(FileFormatError, match=r"states\[1\].cones\[0\].faces\[1\].*no unit vector"):
        read_classifier(file)


def _without_itself(data: dict) -> None:
    data["states"][1]["successors"].remove(data["states"][1]["id"])


def _to_a_stranger(data: dict) -> None:
    strangers = {state["id"] for state in data["states"]} - set(data["states"][1]["successors"])
    data["transitions"].append({"source": data["states"][1]["id"], "target": min(strangers), "faces": []})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda data: data["transitions"].pop(), "there is no transition from N4 to its successor"),
        (lambda data: data["transitions"].append(data["transitions"][0]), "there are two transitions from N1 to N1"),
        (lambda data: data["states"][0]["successors"].append("N1"), "N1 is there twice"),
        (_without_itself, "not among its own successors"),
        (_to_a_stranger, "is no successor of"),
    ],
)
def test_transitions_that_do_not_fit(file: Path, change: Callable, words: str) -> None:
    data = json.loads(file.read_text())
    for k, state in enumerate(data["states"]):  # names in the message
        file.write_text(file.read_text().replace(f'"{state["id"]}"', f'"N{k + 1}"'))
    data = json.loads(file.read_text())
    change(data)
    file.write_text(json.dumps(data))
    with pytest.raises(FileFormatError, match=words):
        read_classifier(file)


def test_the_schema() -> None:
    assert json_schema("classifier")["$id"] == "fixture_design/classifier/1"


LOG = "t [s], fx [N], fy, mz [N m], fz\n0, 0, -5, 1, 0\n\n# later\n0.1, 0, -5, 1.5, 0\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (LOG.replace("N m", "N mm"), r"line 1: the column 'mz' is in another unit; found N mm; expected N m"),
        (LOG.replace("fx [N]", "fx [lbf]"), r"'fx' is in another unit; found lbf; expected N"),
        (LOG.replace("mz [N m]", "mx"), r"the log has no column 'mz'"),
        (LOG.replace("1.5", "nan"), r"line 5, row 2, column mz: not a usable number; found 'nan'"),
        (LOG.replace("1.5", ""), r"line 5, row 2, column mz: a number is missing"),
        (LOG.replace("1.5, 0", "1.5"), r"line 5: row 2 has 4 cells for 5 columns"),
        (LOG.replace("1.5", "1e300"), r"row 2, column mz: not a usable number"),
        (LOG.replace(",", ";"), r"line 1: cells are parted by ';'; expected commas"),
        (LOG.replace("fz", "torque"), r"unknown column 'torque'"),
        (LOG.replace("fz", "fy"), r"the column 'fy' is there twice"),
        (LOG.replace("fz", "dx"), r"the log has no column 'dy', 'rz'"),
        (LOG.replace("\n0.1,", "\n-0.1,"), r"log.csv: row 2: time runs backwards; found -0.1 s after 0 s"),
        ("t,dx,dy,rz\n0,1,2,3\n", r"the log has no column 'fx', 'fy', 'mz'"),
        (LOG.splitlines()[0], r"a header and no rows"),
        ("", r"the log is empty"),
    ],
)
def test_logs_that_are_none(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text)
    with pytest.raises(FileFormatError, match=words):
        read_log(path, 2)


def test_a_log(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(LOG)
    log = read_log(path, 2)
    np.testing.assert_array_equal(log.wrenches, [[0, -5, 1], [0, -5, 1.5]])
    assert log.twists is None
    path.write_text("rz,dx,dy,t,fx,fy,mz\n1,2,3,0,4,5,6\n")
    twists = read_log(path, 2).twists
    assert twists is not None
    np.testing.assert_array_equal(twists, [[2, 3, 1]])


def test_a_log_of_displacements_alone(graph: ContactStateGraph, tmp_path: Path, command: Callable) -> None:  # noqa: F811
    path = tmp_path / "log.csv"
    path.write_text("t,dx,dy,rz\n0,0,1,0\n1,0,-1,0\n")
    log = read_log(path, 2, "displacement")
    np.testing.assert_array_equal(log.wrenches, np.zeros((2, 3)))
    np.testing.assert_array_equal(log.twists, [[0, 1, 0], [0, -1, 0]])
    made = build_classifier(subgraph(graph, FOUR), measure="displacement", discriminants=False)
    write_classifier(made, tmp_path / "c.json")
    rows = json.loads(command("recognize", tmp_path / "c.json", path, "--json").out)["rows"]
    on_top = next(state.id for state in made.states if state.contacts == ("apex 3 - facet 5",))
    assert on_top in rows[0]["states"]
    assert on_top not in rows[1]["states"]
    path.write_text("t,fx,fy,mz\n0,1,2,3\n")
    assert "has no column 'dx', 'dy', 'rz'" in command("recognize", tmp_path / "c.json", path).err


@pytest.mark.parametrize("argument", ["abc", [[1.0], [2.0, 3.0]], ["x", 1.0, 2.0]])
def test_words_are_no_numbers(four: Classifier, argument: object) -> None:
    for call in (
        lambda: four.recognize(argument),  # type: ignore[arg-type]
        lambda: Log.of(argument, WRENCHES),  # type: ignore[arg-type]
        lambda: Log.of([0.0], argument),  # type: ignore[arg-type]
        lambda: Sensor.of(2, None, argument),  # type: ignore[arg-type]
    ):
        with pytest.raises(InputError, match="must be numbers"):
            call()


def test_a_sensor_in_space_for_a_planar_log(four: Classifier) -> None:
    with pytest.raises(InputError, match="a sensor of 6 numbers, a log of 3"):
        recognize_log(four, Log.of([0.0], WRENCHES[:1]), Sensor.of(3))
    with pytest.raises(InputError, match="planar or spatial"):
        Sensor.of(4)


def test_arrays_as_a_log(four: Classifier) -> None:
    times = np.arange(len(WRENCHES), dtype=float)
    answers = recognize_log(four, Log.of(times, WRENCHES))
    assert len(answers) == len(WRENCHES)
    bad = WRENCHES.copy()
    bad[6, 1] = np.inf
    with pytest.raises(InputError, match="row 7: the wrench is not usable"):
        Log.of(times, bad)
    with pytest.raises(InputError, match="the classifier is of planar parts"):
        recognize_log(four, Log.of(times, np.zeros((len(times), 6))))


def test_a_sensor_elsewhere() -> None:
    """A force at a point has its moment about the part's origin, whatever the sensor's pose; work is the same."""
    rng = np.random.default_rng(0)
    for plane in (2, 3):
        size = 3 * (plane - 1)
        x, tare = rng.normal(size=plane), rng.normal(size=size)
        pose = Pose.from_xy_theta(x, 0.7) if plane == 2 else Pose.from_xyz_rpy(x, [0.3, -0.4, 2.0])
        sensor = Sensor.of(plane, pose, tare)
        p_S, v_S = rng.normal(size=(5, size)), rng.normal(size=(5, size))
        p, v = sensor.wrenches(p_S + tare), sensor.twists(v_S)
        np.testing.assert_allclose((p * v).sum(axis=1), (p_S * v_S).sum(axis=1), atol=1e-12)
        np.testing.assert_allclose(p[:, :plane], p_S[:, :plane] @ pose.rotation.T)
    pure = Sensor.of(2, Pose.from_xy_theta([0.0, 2.0], 0.0)).wrenches(np.array([[1.0, 0.0, 0.0]]))
    np.testing.assert_allclose(pure, [[1.0, 0.0, -2.0]])


@pytest.mark.parametrize("joint", [False, True])
def test_exported_code_says_the_same(four: Classifier, four_jointly: Classifier, tmp_path: Path, joint: bool) -> None:
    classifier = four_jointly if joint else four
    (tmp_path / "next.py").write_text(numpy_source(classifier))
    functions = runpy.run_path(str(tmp_path / "next.py"))
    tables = Tables.of(classifier)
    twists = np.random.default_rng(9).normal(size=WRENCHES.shape) if joint else [None] * len(WRENCHES)
    compiled = _compiled(c_source(classifier), tmp_path)
    seen = set()
    for wrench, twist in zip([*WRENCHES, 1e-3 * WRENCHES[0], np.zeros(3)], [*twists, None, None], strict=True):
        for source in classifier.ids:
            here = discriminated(classifier, tables, source, wrench, twist)
            seen.add(here)
            assert tuple(functions["next_states"](source, wrench, twist)) == here
            if compiled is not None:
                assert compiled(classifier, source, wrench, twist) == here
    assert len(seen) > 5
    if joint:
        against = [-wrench * np.array([1.0, 1.0, classifier.signals.length**-2]) for wrench in WRENCHES]
        for wrench, twist in zip(WRENCHES, against, strict=True):
            assert functions["next_states"](classifier.ids[0], wrench, twist) == []
            assert compiled is None or compiled(classifier, classifier.ids[0], wrench, twist) == ()
    for bad in ([np.nan, 0.0, 1.0], [0.0, np.inf, 0.0]):
        wrench, twist = np.array(bad), np.ones(3) if joint else None
        for source in classifier.ids:
            assert functions["next_states"](source, wrench, twist) == []
            assert compiled is None or compiled(classifier, source, wrench, twist) == ()
            if joint:
                assert functions["next_states"](source, np.ones(3), wrench) == []
                assert compiled is None or compiled(classifier, source, np.ones(3), wrench) == ()
    if compiled is None:
        pytest.skip("there is no C compiler `cc`: only the numpy function was compared")


def _compiled(source: str, folder: Path) -> Callable | None:
    if shutil.which("cc") is None:
        return None
    (folder / "next.c").write_text(source)
    options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O2", "-shared", "-fPIC"]
    subprocess.run(["cc", *options, "-o", "next.so", "next.c", "-lm"], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "next.so"))

    def answer(classifier: Classifier, source: str, wrench: np.ndarray, twist: np.ndarray | None) -> tuple[str, ...]:
        possible = (ctypes.c_ubyte * len(classifier.ids))()
        numbers = [None if v is None else (ctypes.c_double * len(v))(*v) for v in (wrench, twist)]
        count = library.fd_next(classifier.ids.index(source), *numbers, possible)
        names = tuple(name for name, yes in zip(classifier.ids, possible, strict=True) if yes)
        assert count == len(names)
        return names

    return answer


@pytest.mark.parametrize("noise", [Noise(), Noise(0.02), Noise(0.1)])
def test_discriminants_tell_what_the_sets_tell(four: Classifier, noise: Noise) -> None:
    """Among forces that some successor may have made, all sets widened."""
    noisy = four.with_noise(noise)
    tables = Tables.of(noisy)
    told = 0
    for wrench in WRENCHES:
        for source in noisy.ids:
            answer = noisy.recognize(wrench, previous=source)
            if answer.expected:
                told += len(answer.states)
                assert answer.states == discriminated(noisy, tables, source, wrench)
    assert told > 100


@pytest.mark.parametrize(("group", "bounds", "wanted"), [
    ((0,), (1e-3, 1e-3), (0, 1)),  # face 1 is implied by the other's, but only sqrt(2) as far out
    ((0,), (1e-3, 5e-4), (0,)),
    ((0,), (0.0, 0.0), (0,)),
])  # fmt: skip
def test_a_face_is_left_out_only_if_the_bounds_allow_it(
    group: tuple[int, ...], bounds: tuple[float, float], wanted: tuple[int, ...]
) -> None:
    """{x <= 0, y <= 0} against {x <= y <= -x}, whose faces (1, 1) and (1, -1) imply x <= 0 by halves times sqrt(2)."""
    ours, theirs = (np.array(rows, dtype=float) for rows in ([[0, 1], [1, 0]], [[1, 1], [1, -1]]))
    cone = Widened(ours, np.full(2, bounds[0]))
    other = Widened(theirs / np.sqrt(2), np.full(2, bounds[1]))
    assert widened_group(cone, group, [other]) == wanted


def test_commands(graph: ContactStateGraph, tmp_path: Path, command: Callable) -> None:  # noqa: F811
    write_graph(subgraph(graph, FOUR), tmp_path / "graph.json")
    made = command(
        "classifier", tmp_path / "graph.json", "-o", tmp_path / "c.json", "--friction", "0.1", "--noise", "0.02",
        "--c", tmp_path / "c.c", "--python", tmp_path / "c.py",
    )  # fmt: skip
    assert made.code == 0, made.err
    assert "4 states" in made.out
    assert {path.suffix for path in tmp_path.iterdir()} == {".json", ".c", ".py"}
    log = tmp_path / "log.csv"
    log.write_text("t,fx,fy,mz\n0,0,0,0\n1,0,-5,1\n2,0,-5,1\n")
    found = command("recognize", tmp_path / "c.json", log, "--json", "--start", "N1")
    data = json.loads(found.out)
    assert found.code == 0
    assert [row["t"] for row in data["rows"]] == [0, 1, 2]
    assert "N2" in data["rows"][1]["states"]
    assert not data["rows"][0]["told"]
    words = command("recognize", tmp_path / "c.json", log, "--sensor", "0,0,0", "--tare-rows", "1")
    assert "rows 2 to 3" in words.out
    log.write_text("t,fx,fy,mz\n0,1,100,500\n")
    assert command("recognize", tmp_path / "c.json", log).code == 3
    log.write_text("t,fx,fy,mz\n0,1,x,500\n")
    bad = command("recognize", tmp_path / "c.json", log)
    assert bad.code == 2
    assert "row 1, column fy" in bad.err
    log.write_text("t,fx,fy,mz\n0,1,100,500\n")
    assert command("recognize", tmp_path / "graph.json", log).code == 2
    assert command("classifier", tmp_path / "c.json").code == 2
    assert "set --floor" in made.err
    for option, value in (
        ("--friction", "-1"), ("--noise", "nan"), ("--floor", "-1"), ("--seed", "-1"), ("--twist-noise", "0.1")
    ):  # fmt: skip
        bad = command("classifier", tmp_path / "graph.json", option, value)
        assert bad.code == 2
        assert option in bad.err
        assert "graph.json" not in bad.err
    bad = command("recognize", tmp_path / "c.json", log, "--start", "N99")
    assert bad.code == 2
    assert "--start: no state is called 'N99'" in bad.err
    assert "(force) is relative; found 10.0" in command("classifier", tmp_path / "graph.json", "--noise", "10").err
    assert command("classifier", tmp_path / "graph.json", "--floor", "1", "--mass", "1").code == 2
    assert "in radians; found 90" in command("recognize", tmp_path / "c.json", log, "--sensor", "0,0,90").err
    for option in ("--sensor", "--tare"):
        bad = command("recognize", tmp_path / "c.json", log, option, "1,2")
        assert bad.code == 2
        assert f"{option} takes 3 numbers" in bad.err
        assert "log.csv" not in bad.err
    shown = command("classifier", tmp_path / "graph.json", "--json", "--interpolation", "hull")
    assert json.loads(shown.out)["schema"] == "fixture_design/classifier/1"


def test_columns_that_nothing_is_made_of_are_named(graph: ContactStateGraph, tmp_path: Path, command: Callable) -> None:  # noqa: F811
    write_graph(subgraph(graph, FOUR), tmp_path / "graph.json")
    assert command("classifier", tmp_path / "graph.json", "-o", tmp_path / "c.json", "--no-discriminants").code == 0
    log = tmp_path / "log.csv"
    log.write_text(LOG)
    assert "fz: not used, " in command("recognize", tmp_path / "c.json", log).err
    log.write_text("t,fx,fy,mz,truth\n0,0,-5,1,\n")
    assert "not used" not in command("recognize", tmp_path / "c.json", log).err


def test_discriminants_may_be_left_out(graph: ContactStateGraph, tmp_path: Path, command: Callable) -> None:  # noqa: F811
    write_graph(subgraph(graph, FOUR), tmp_path / "graph.json")
    assert command("classifier", tmp_path / "graph.json", "-o", tmp_path / "c.json", "--no-discriminants").code == 0
    made = read_classifier(tmp_path / "c.json")
    assert not made.transitions
    assert all(state.successors for state in made.states)
    for option in (["--c", tmp_path / "c.c"], ["--python", tmp_path / "c.py"], ["--fewest"]):
        bad = command("classifier", tmp_path / "graph.json", "--no-discriminants", *option)
        assert bad.code == 2
        assert "--no-discriminants leaves them out" in bad.err
