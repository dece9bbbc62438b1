"""`verify_batch` from scripts of every kind."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import fixture_design as fd
from fixture_design.batch.job import check_numbers
from fixture_design.errors import FileFormatError, InputError
from tests.batch.layouts import HOLDS, lines, planar

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = "import fixture_design as fd\nprint([r['satisfied'] for r in fd.verify_batch('lib.jsonl', jobs=1)])\n"


@pytest.mark.parametrize("piped", [True, False])
def test_scripts_need_no_guard(tmp_path: Path, piped: bool) -> None:
    lines(tmp_path / "lib.jsonl", [planar("a", require=HOLDS), "{", planar("b")][::2])
    (tmp_path / "script.py").write_text(SCRIPT)
    ran = subprocess.run(
        [sys.executable, "-" if piped else "script.py"], input=SCRIPT if piped else None, capture_output=True,
        text=True, cwd=tmp_path, env={"PYTHONPATH": str(ROOT)}, check=False,
    )  # fmt: skip
    assert (ran.stdout, ran.stderr) == ("['yes', None]\n", "")


def test_wrong_paths_are_told_before_anything_is_read() -> None:
    with pytest.raises(FileFormatError, match="no such file"):
        fd.verify_batch("nowhere.yaml")
    with pytest.raises(InputError, match="one of brief and sets"):
        fd.verify_batch(__file__, brief=True, sets=True)


def test_leaving_early_ends_the_workers(tmp_path: Path) -> None:
    records = fd.verify_batch(lines(tmp_path / "lib.jsonl", [planar(str(n)) for n in range(100)]), jobs=1)
    assert next(records)["name"] == "0"
    records.close()


@pytest.mark.parametrize("jobs", [0, -1, 1.5, True, "2"])
def test_numbers_of_processes_that_cannot_be(jobs: Any) -> None:
    with pytest.raises(InputError, match="worker processes cannot be"):
        check_numbers(jobs, None)


@pytest.mark.parametrize("limit", [0, -1, float("nan"), float("inf"), "1"])
def test_limits_that_cannot_be(limit: Any) -> None:
    with pytest.raises(InputError, match="limit of time cannot be"):
        check_numbers(None, limit)


def test_numbers_are_looked_at_before_anything_begins(tmp_path: Path) -> None:
    library = lines(tmp_path / "lib.jsonl", [planar("a")])
    with pytest.raises(InputError, match="worker processes cannot be"):
        fd.verify_batch(library, jobs=-1)
    with pytest.raises(InputError, match="limit of time cannot be"):
        fd.verify_batch(library, limit=float("nan"))
