"""`batch` as a command: exit codes, messages, Ctrl-C, and processes killed at random moments."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from fixture_design.batch import items_of
from fixture_design.batch.records import WorkerError, failure
from tests.batch.layouts import FAILS, HOLDS, LOCATORS, lines, planar

PROGRAM = [sys.executable, "-c", "from fixture_design.cli import main; main()", "batch"]
ROOT = Path(__file__).resolve().parents[2]


def start(*arguments: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [*PROGRAM, *map(str, arguments)], cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        start_new_session=True,
    )  # fmt: skip


def records(path: Path) -> list[dict]:
    """Without what differs from run to run."""
    found = [json.loads(line) for line in path.read_text().splitlines()]
    for record in found:
        record.get("run", {}).pop("time", None)
    return found


@pytest.mark.parametrize(
    ("layouts", "code"),
    [
        ([planar("a", require=HOLDS), planar("b")], 0),
        ([planar("a", require=HOLDS), planar("b", require={"locators": ["seated"]})], 3),
        ([planar("a", require={"locators": ["seated"]}), planar("b", require=FAILS)], 1),
        ([planar("a", require=FAILS), "{broken"], 2),
    ],
)
def test_exit_codes(command: Callable, tmp_path: Path, layouts: list, code: int) -> None:
    ran = command("batch", lines(tmp_path / "lib.jsonl", layouts), "-o", tmp_path / "o.jsonl", "--jobs", 1)
    assert ran.code == code
    assert ran.out.startswith("2 layouts\n")


def test_an_error_of_ours_has_its_own_code_until_it_is_looked_at_again(command: Callable, tmp_path: Path) -> None:
    library, output = lines(tmp_path / "lib.jsonl", [planar("a", require=HOLDS)]), tmp_path / "o.jsonl"
    (item,) = items_of([library])
    output.write_bytes(failure(item, WorkerError("it died")).line)
    ran = command("batch", library, "-o", output, "--jobs", 1)
    assert (ran.code, ran.out) == (4, "1 layout, 1 of them from before\n  internal error: 1\n")
    ran = command("batch", library, "-o", output, "--jobs", 1, "--retry")
    assert (ran.code, ran.out.splitlines()[1:]) == (0, ["  yes: 1"])
    assert ran.out.startswith("1 layout, 1 of them from before; 1 that were errors were looked at again\n")
    assert [record["satisfied"] for record in records(output)] == ["yes"]


def test_json_is_the_summary(command: Callable, tmp_path: Path) -> None:
    sweep = {"at": 0.2, "samples": 40, "seed": 1}
    layouts = [planar("s", require=HOLDS, sweep=sweep), planar("b", require=FAILS), "[]"]
    library, output = lines(tmp_path / "lib.jsonl", layouts), tmp_path / "o.jsonl"
    ran = command("batch", library, "-o", output, "--json", "--jobs", 1)
    summary = json.loads(ran.out)
    assert summary["count"] == len(records(output)) == 42
    assert summary["outcomes"]["no"] >= 1
    assert summary["outcomes"]["bad input"] == 1
    (robust,) = summary["sweeps"]
    assert (robust["source"], robust["count"]) == (f"{library}:1", 40)
    assert robust["interval"][0] <= robust["fraction"] <= robust["interval"][1]
    margins = [r["groups"]["locators"]["deterministic"]["margin"] for r in records(output)[:40]]
    assert robust["worst"]["margin"] <= min(margins)
    again = json.loads(command("batch", library, "-o", output, "--json", "--jobs", 1).out)
    assert again == {**summary, "resumed": 42}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere", "-o", "o.jsonl"], "nowhere: there is no such file or folder"),
        (["*.toml", "-o", "o.jsonl"], "no file matches this pattern"),
        (["lib.jsonl"], "Missing option '--output'"),
        (["lib.jsonl", "-o", "lib.jsonl"], "lib.jsonl: this file is an input and would be lost"),
        (["lib.jsonl", "-o", "no/o.jsonl"], "no/o.jsonl: the folder to write to is not there"),
        (["lib.jsonl", "-o", "notes.txt"], "the output exists and holds something else"),
        (["lib.jsonl", "-o", "o.jsonl", "--report", "lib.jsonl"], "this file is an input and would be lost"),
        (["lib.jsonl", "-o", "o.jsonl", "--report", "./o.jsonl"], "o.jsonl: two outputs would go to one file"),
        (["lib.jsonl", "-o", "o.jsonl", "--report", "r", "--table", "r"], "r: two outputs would go to one file"),
        (["lib.jsonl", "-o", "o.jsonl", "--against", "o.jsonl"], "o.jsonl: the file cannot be read"),
        (["lib.jsonl", "-o", "o.jsonl", "--table", "no/t.csv"], "no/t.csv: the folder to write to is not there"),
        (["lib.jsonl", "-o", "o.jsonl", "--table", "cutter.csv"], "cutter.csv: this file is no table of a batch"),
        (["lib.jsonl", "-o", "o.jsonl", "--table", "t.xlsx"], "ends in .csv or .parquet"),
        (["lib.jsonl", "-o", "o.jsonl", "--against", "old.jsonl"], "old.jsonl: the file cannot be read"),
        (["lib.jsonl", "-o", "o.jsonl", "--against", "notes.txt"], "notes.txt: line 1: the line is no record"),
        (["lib.jsonl", "-o", "o.jsonl", "--brief", "--sets"], "one of brief and sets"),
        (["lib.jsonl", "-o", "o.jsonl", "--jobs", "0"], "--jobs"),
        (["lib.jsonl", "-o", "o.jsonl", "--limit", "0"], "--limit"),
        (["lib.jsonl", "-o", "o.jsonl", "--limit", "1", "--cluster", "tcp://x:1"], "--limit are for this machine"),
        (["lib.jsonl", "-o", "o.jsonl", "--jobs", "1", "--cluster", "tcp://x:1"], "--jobs and --limit are for this"),
    ],
)
def test_bad_input(
    command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    library = lines(tmp_path / "lib.jsonl", [planar("a")])
    before = library.read_bytes()
    (tmp_path / "notes.txt").write_text("notes\n")
    (tmp_path / "cutter.csv").write_text("x,y,z,fx,fy,fz\n0,0,0,1,0,0\n")
    ran = command("batch", *arguments)
    assert (ran.code, ran.out) == (2, "")
    assert words in ran.err
    assert len(ran.err.splitlines()) == 1
    assert library.read_bytes() == before
    assert (tmp_path / "notes.txt").read_text() == "notes\n"
    assert (tmp_path / "cutter.csv").read_text().startswith("x,y,z")


def test_against_an_earlier_run_with_page_and_table(command: Callable, tmp_path: Path) -> None:
    library, old, new = tmp_path / "lib.jsonl", tmp_path / "old.jsonl", tmp_path / "new.jsonl"
    command("batch", lines(library, [planar("a", require=HOLDS), planar("b", require=HOLDS)]), "-o", old, "--jobs", 1)
    lines(library, [planar("a", require=FAILS), planar("b", require=HOLDS)])
    others = ("--report", tmp_path / "r.html", "--table", tmp_path / "t.csv")
    ran = command("batch", library, "-o", new, "--against", old, *others, "--jobs", 1)
    assert ran.code == 1
    assert "1 of 2 changed verdict" in ran.out
    assert "  a: verdict yes -> no\n" in ran.out
    assert "1 changed verdict" in (tmp_path / "r.html").read_text()
    assert len((tmp_path / "t.csv").read_text().splitlines()) == 3
    told = json.loads(command("batch", library, "-o", new, "--against", old, "--json", "--jobs", 1).out)
    assert [change["name"] for change in told["against"]["changed"]] == ["a"]


def test_a_reader_who_leaves_costs_no_page(tmp_path: Path) -> None:
    library, page = lines(tmp_path / "lib.jsonl", [planar("a", require=HOLDS)]), tmp_path / "r.html"
    process = start(library, "-o", tmp_path / "o.jsonl", "--report", page)
    assert process.stdout is not None
    process.stdout.close()
    assert process.wait() == 141
    assert "</html>" in page.read_text()


def test_malformed_files_cost_nobody_else(tmp_path: Path) -> None:
    for number in range(1000):
        content = json.dumps(planar(require=HOLDS))
        if number % 5 == 0:
            content = MALFORMED[number // 5 % len(MALFORMED)]
        (tmp_path / f"{number:03d}.json").write_text(content)
    process = start(tmp_path, "-o", tmp_path / "o.jsonl")
    assert process.wait() == 2
    found = records(tmp_path / "o.jsonl")
    assert ["error" in record for record in found] == [number % 5 == 0 for number in range(1000)]
    assert sum(record.get("satisfied") == "yes" for record in found) == 800


MALFORMED = (
    "", "{", "\0", "schema: x", '{"schema": "fixture_design/layout/1"}', "[1, 2]", "null", "\ufeff{}",
    '{"schema": 1e999}',
    json.dumps(planar(elements=[{"name": "E", "role": "locator", "at": [0, 0]}])),
    json.dumps(planar(part={"mesh": "nowhere.stl"})), json.dumps(planar(sweep={"part_pose": {"xy": [1, 1]}})),
    json.dumps(planar(friction=-1)), json.dumps(planar())[:-9], "[" * 20_000,
)  # fmt: skip


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_end_that_is_asked_for_saves_and_the_same_command_goes_on(tmp_path: Path, number: int, code: int) -> None:
    library = lines(tmp_path / "lib.jsonl", [planar(sweep={"at": 0.2, "samples": 20_000}, require=HOLDS)])
    output = tmp_path / "o.jsonl"
    process = start(library, "-o", output)
    wait_for(lambda: output.exists() and output.stat().st_size > 0, process)
    os.killpg(process.pid, number)  # as a terminal does: to all processes
    _, said = process.communicate(timeout=30)
    assert process.returncode == code
    assert "the same command goes on from there" in said
    assert "Traceback" not in said
    saved = len(records(output))
    assert 0 < saved < 20_000
    assert start(library, "-o", output).wait() in {0, 1}
    assert [record["name"] for record in records(output)] == [f"lib:1[{number}]" for number in range(20_000)]


def test_terminated_while_it_begins(tmp_path: Path) -> None:
    """Processes that end before they begin to work are no fault then."""
    library = lines(tmp_path / "lib.jsonl", [planar(sweep={"at": 0.2, "samples": 20_000}, require=HOLDS)])
    process = start(library, "-o", tmp_path / "o.jsonl")
    wait_for((tmp_path / "o.jsonl").exists, process)
    os.killpg(process.pid, signal.SIGTERM)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 143
    assert "internal error" not in said


def wait_for(condition: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    for _ in range(600):
        if condition() or process.poll() is not None:
            return
        time.sleep(0.05)


@pytest.mark.slow
def test_killed_at_random_moments(tmp_path: Path) -> None:
    # every other one has contacts of names of its own, and is looked at alone
    layouts = [planar(f"n{n}", require=HOLDS, friction=n / 1e5) for n in range(6000)]
    for n, layout in enumerate(layouts[::2]):
        layout["contacts"] = [contact | {"name": f"{contact['name']} {n}"} for contact in LOCATORS]
    library, output = lines(tmp_path / "lib.jsonl", layouts), tmp_path / "o.jsonl"
    assert start(library, "-o", tmp_path / "whole.jsonl").wait() == 0
    rng = random.Random(4)
    for turn in range(20):
        process = start(library, "-o", output)
        time.sleep(rng.uniform(0.5, 4.0))
        victims = [process.pid] if turn % 2 else children_of(process.pid)
        if victims and process.poll() is None:
            os.kill(rng.choice(victims), signal.SIGKILL)
        if turn % 2:
            process.wait()
        elif process.poll() is None:
            time.sleep(rng.uniform(0.0, 1.0))
            process.kill()
            process.wait()
    assert start(library, "-o", output).wait() == 0
    assert records(output) == records(tmp_path / "whole.jsonl")


def children_of(pid: int) -> list[int]:
    listed = Path(f"/proc/{pid}/task/{pid}/children")
    return [int(child) for child in listed.read_text().split()] if listed.exists() else []
