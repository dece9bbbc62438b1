"""Names no file can have, half characters, terminals without Unicode, readers that leave, and Ctrl-C."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.layouts import HEAD, HOLDS, contact, on_part

PROGRAM = [sys.executable, "-c", "from fixture_design.cli import main; main()"]
ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ("{mesh: " + "a" * 5000 + ".stl}", "too long"),
        ('{mesh: "a\\0.stl"}', "null"),
        ("{mesh: folder.stl}", "this is a folder"),
        ("{mesh: loop.stl}", "cannot be read"),
        ("{urdf: " + "a" * 5000 + ".urdf}", "too long"),
        ("{urdf: encoding.urdf}", "not XML"),
    ],
)
def test_files_that_cannot_be_read(command: Callable, tmp_path: Path, part: str, words: str) -> None:
    (tmp_path / "folder.stl").mkdir()
    (tmp_path / "loop.stl").symlink_to("loop.stl")
    (tmp_path / "encoding.urdf").write_text("<?xml version='1.0' encoding='klingon'?><robot/>")
    path = tmp_path / "x.yaml"
    path.write_text(on_part(part))
    ran = command("verify", path)
    assert (ran.code, len(ran.err.splitlines())) == (2, 1)
    assert words in ran.err


@pytest.mark.parametrize("name", ["fifo.yaml", "fifo.json"])
def test_a_pipe_that_nobody_writes_to(command: Callable, tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    ran = command("verify", tmp_path / name)
    assert (ran.code, len(ran.err.splitlines())) == (2, 1)
    assert "this is no regular file" in ran.err


@pytest.mark.parametrize(
    ("content", "package", "words"),
    [
        ("<package>", "robot", "package.xml: not XML"),
        ("<?xml version='1.0' encoding='klingon'?><package/>", "robot", "package.xml: line 1: not XML"),
        ("<package/>", "robot", "there is no package 'robot'"),
        ("<package/>", "r" * 5000, "there is no package 'rrr"),
    ],
)
def test_packages(command: Callable, tmp_path: Path, content: str, package: str, words: str) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(on_part("{urdf: x.urdf}"))
    (tmp_path / "package.xml").write_text(content)
    mesh = f"<mesh filename='package://{package}/a.stl'/>"
    (tmp_path / "x.urdf").write_text(
        f"<robot name='r'><link name='l'><collision><geometry>{mesh}</geometry></collision></link></robot>"
    )
    ran = command("verify", path)
    assert (ran.code, len(ran.err.splitlines())) == (2, 1)
    assert words in ran.err
    assert "named at line 2, part.urdf" in ran.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
@pytest.mark.parametrize("name", ["x.yaml", "part.stl", "x.urdf", "package.xml"])
def test_files_that_may_not_be_read(command: Callable, tmp_path: Path, name: str) -> None:
    mesh = "<mesh filename='package://robot/part.stl'/>"
    link = f"<link name='l'><collision><geometry>{mesh}</geometry></collision></link>"
    (tmp_path / "x.urdf").write_text(f"<robot name='r'>{link}</robot>")
    (tmp_path / "package.xml").write_text("<package><name>robot</name></package>")
    (tmp_path / "part.stl").touch()
    (tmp_path / "x.yaml").write_text(on_part("{urdf: x.urdf}"))
    (tmp_path / name).chmod(0)
    ran = command("verify", tmp_path / "x.yaml")
    assert (ran.code, len(ran.err.splitlines())) == (2, 1)
    assert "ermission denied" in ran.err


@pytest.mark.parametrize("text", ['"name": "\\ud800"', '"\\ud800": 1', '"stages": [{"name": "\\udfff"}]'])
def test_half_characters(command: Callable, tmp_path: Path, text: str) -> None:
    path = tmp_path / "x.json"
    path.write_text('{"schema": "fixture_design/layout/1", ' + text + "}")
    ran = command("verify", "--json", path)
    assert (ran.code, len(ran.err.splitlines())) == (2, 1)
    assert "half a character" in ran.err


def test_control_characters_do_not_reach_the_terminal(command: Callable, tmp_path: Path) -> None:
    ran = command("verify", tmp_path / "a\x1b[31m.yaml")
    assert (ran.code, "\x1b" in ran.err, "\\x1b" in ran.err) == (2, False, True)


def test_a_terminal_without_unicode(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(HOLDS.replace(HEAD, HEAD + "name: Gehäuse\n"))
    ran = subprocess.run(
        [*PROGRAM, "verify", path], cwd=ROOT, env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True, timeout=60, check=False,
    )  # fmt: skip
    assert (ran.returncode, ran.stderr) == (0, b"")
    assert b"Geh\\xe4use" in ran.stdout


def test_a_reader_that_leaves(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(HOLDS)
    read, write = os.pipe()
    os.close(read)
    ran = subprocess.run(
        [*PROGRAM, "verify", path], cwd=ROOT, stdout=write, stderr=subprocess.PIPE, timeout=60, check=False
    )
    os.close(write)
    assert (ran.returncode, ran.stderr) == (141, b"")


@pytest.mark.parametrize("wait", [0.0, 0.15, 0.4])
def test_interrupted_while_importing(wait: float) -> None:
    code = "import sys; from fixture_design.cli import main; print('in', flush=True); main()"
    running = subprocess.Popen(
        [sys.executable, "-c", code, "verify", "urdf/bracket/bracket.layout.yaml"],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert running.stdout is not None
    running.stdout.readline()
    time.sleep(0.02 + wait)
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=60)
    assert (running.returncode, err) == (130, b"fixture-design: interrupted\n")


ONE = contact("point: [0, 0, 0], normal: [0, 0, 1]")
TRIANGLE = "space: planar\npart: {polygon: [[0, 0], [1e300, 0], [0, 1e300]]}\n"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("\ufeff" + ONE, None),
        (ONE.replace("\n", "\r\n"), None),
        (ONE.replace("[0, 0, 0]", "[0x10, -0, -0.0]"), None),
        (ONE.replace("[0, 0, 1]", "[1e300, 1e300, 0]"), None),
        (ONE.replace("[0, 0, 1]", "[1e-200, 1e-200, 0]"), None),
        (HEAD + "name: 2020-01-01\n" + ONE.removeprefix(HEAD), None),
        (ONE.encode("utf-16"), "UTF-16 text"),
        (ONE.encode("utf-32"), "UTF-32 text"),
        (HEAD + "name: " + "[" * 5000 + "]" * 5000, "line 2, column 107: lists and mappings are nested"),
        (HEAD + "".join(f"k{i}: &k{i} [{f'*k{i - 1}, ' * 9 if i else 1}]\n" for i in range(10)), "aliases written out"),
        (HEAD + "contacts: &a [*a]\n", "the alias *a contains itself"),
        (ONE.replace("[0, 0, 0]", "[1_000, 0, 0]"), "line 4, contacts[0].point[0]"),
        (ONE.replace("[0, 0, 0]", "[1e400, 0, 0]"), "line 4, contacts[0].point[0]"),
        (ONE.replace("[0, 0, 0]", "[2020-01-01, 0, 0]"), "found '2020-01-01'; expected a number"),
        (ONE.replace("[0, 0, 0]", "[true, 0, 0]"), "found true; expected a number"),
        (ONE.replace("Q1", "true"), "found true; expected text in quotes: 'true'"),
        (ONE.replace("Q1", "''"), "contacts[0].name"),
        (ONE.replace("Q1", "'\u202eQ1'"), "do not print"),
        (ONE.replace("[0, 0, 0]", "[1e300, 0, 0]"), "line 4, contacts[0]: contact 'Q1': the point must be"),
        (
            ONE.replace("[0, 0, 1]", "[0, 0, 1], friction: 1e300"),
            "line 4, contacts[0].friction: 'friction' is out of range; found 1e+300; expected a number <= 1000",
        ),
        (
            HEAD + TRIANGLE + "elements: [{name: L, role: locator, at: [1, 0]}]\n",
            "line 3, part.polygon: the polygon of",
        ),
        ("schema: fixture_design/layout/" + "9" * 5000, "line 1, schema"),
        (on_part("{mesh: 'C:\\parts\\a.stl'}"), "line 2, part.mesh"),
        (on_part('{mesh: "C:\\parts\\a.stl"}'), "an unknown escape in double quotes; use single quotes"),
    ],
)
def test_odd_texts(command: Callable, tmp_path: Path, content: str | bytes, words: str | None) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    for arguments in ([path], ["--json", path]):
        ran = command("verify", *arguments)
        assert ran.code == (0 if words is None else 2), ran.err
        assert len(ran.err.splitlines()) == (words is not None)
        assert len(ran.err) < 1000
        assert (words or "") in ran.err
        assert bool(ran.out) == (words is None or "--json" in arguments)


def test_a_title_that_would_steer_the_terminal(command: Callable, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(ONE.replace(HEAD, HEAD + 'name: "a\\e[31m\\nb"\n'))
    assert command("verify", path).out.startswith("a\\x1b[31m\\nb: spatial")


def test_the_same_layout_twice(command: Callable, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(HOLDS)
    once = command("verify", path)
    assert command("verify", path, path).out == 2 * once.out
    assert len(json.loads(command("verify", "--json", path, path).out)) == 2
