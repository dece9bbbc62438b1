"""Errors are looked at again where that is asked for; what had a verdict keeps its record, byte by byte."""

import os
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from fixture_design.batch import run_batch
from fixture_design.batch.crew import Crew
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.output import Output
from fixture_design.batch.records import Detail, WorkerError, failure
from fixture_design.batch.summary import Summary
from fixture_design.batch.worker import Look, LookAt, verifying
from fixture_design.errors import FileFormatError
from tests.batch.layouts import FAILS, HOLDS, lines, planar
from tests.batch.test_output import InThisProcess, run


class Deadly(InThisProcess):
    """Workers on which every third item dies."""

    def entries(self, items: Iterator[Item], stop: object = None) -> Iterator[list[tuple[Item, Entry]]]:
        for number, some in enumerate(super().entries(items)):
            ((item, entry),) = some
            yield [(item, failure(item, WorkerError("died")) if number % 3 == 1 else entry)]


@pytest.fixture
def library(tmp_path: Path) -> Path:
    layouts = [planar(f"n{n}", require=HOLDS if n % 2 else FAILS) for n in range(10)]
    return lines(tmp_path / "lib.jsonl", [*layouts, "{broken"])


def outcomes(summary: Summary) -> dict[str, int]:
    return {word: count for word, count in summary.outcomes.items() if count}


def test_deaths_stay_records_until_they_are_looked_at_again(library: Path, tmp_path: Path) -> None:
    output = tmp_path / "o.jsonl"
    died = run_batch([library], output, Deadly(), detail="brief")
    assert outcomes(died) == {"internal error": 4, "no": 4, "yes": 3}
    before = output.read_bytes().splitlines()
    seen, _ = run(library, output)
    assert seen == 0
    assert output.read_bytes().splitlines() == before
    summary = run_batch([library], output, InThisProcess(), detail="brief", retry=True)
    assert (summary.retried, summary.resumed) == (4, 11)
    assert outcomes(summary) == {"no": 5, "yes": 5, "bad input": 1}
    after = output.read_bytes().splitlines()
    kept = [n for n, line in enumerate(before) if b"WorkerError" not in line]
    assert len(kept) == 7
    assert [after[n] for n in kept] == [before[n] for n in kept]
    assert run(library, output)[1] == run(library, tmp_path / "whole.jsonl")[1]


def test_files_that_were_mended(library: Path, tmp_path: Path) -> None:
    output = tmp_path / "o.jsonl"
    run(library, output, most=11)
    lines(library, [*library.read_text().splitlines()[:-1], planar("mended", require=HOLDS), planar("new")])
    with pytest.raises(FileFormatError, match=r"lib.jsonl:11', .* has changed since it was an error, and --retry"):
        run(library, output)
    seen, records = run(library, output, retry=True)
    assert seen == 2
    assert [record["name"] for record in records[-2:]] == ["mended", "new"]
    assert records[-2]["satisfied"] == "yes"


def test_a_verdict_whose_layout_changed_is_refused_also_then(library: Path, tmp_path: Path) -> None:
    output = tmp_path / "o.jsonl"
    run(library, output)
    before = output.read_bytes()
    lines(library, [planar("n0", friction=0.5), *library.read_text().splitlines()[1:]])
    with pytest.raises(FileFormatError, match="has changed since"):
        run(library, output, retry=True)
    assert output.read_bytes() == before


def test_what_is_stopped_or_cut_short_loses_nothing(library: Path, tmp_path: Path) -> None:
    output = tmp_path / "o.jsonl"
    run_batch([library], output, Deadly(), detail="brief")
    with output.open("r+b") as file:
        file.truncate(output.stat().st_size - 20)
    run(library, output, most=2, retry=True)  # killed after two of the errors
    assert sum(b"WorkerError" in line for line in output.read_bytes().splitlines()) == 1
    assert run(library, output, retry=True)[1] == run(library, tmp_path / "whole.jsonl")[1]
    assert sorted(os.listdir(tmp_path)) == ["lib.jsonl", "o.jsonl", "whole.jsonl"]


def test_a_file_that_took_the_place_is_locked_and_keeps_its_mode(library: Path, tmp_path: Path) -> None:
    output, link = tmp_path / "o.jsonl", tmp_path / "link.jsonl"
    link.symlink_to(output)
    run(library, output)
    output.chmod(0o640)
    out = Output(link, [library])
    first, *others = output.read_bytes().splitlines(keepends=True)
    out.replace({0: first.upper()})
    with pytest.raises(FileFormatError, match="another batch is writing"):
        Output(output, [library])
    out.append([b"last\n"])
    out.close()
    assert output.read_bytes() == b"".join([first.upper(), *others, b"last\n"])
    assert link.is_symlink()
    assert output.stat().st_mode & 0o777 == 0o640


def _verifying_but(folder: str, detail: Detail) -> Look:
    """Looks as workers do; of the items whose text says so it dies as long as a file is not there."""
    look = verifying(detail)

    def deadly(items: list[Item]) -> Iterator[list[tuple[int, Entry]]]:
        if any(b"deadly" in (item.text or b"") for item in items) and not Path(folder, "well").exists():
            os.abort()
        return look(items)

    return deadly  # type: ignore[return-value]


def test_worker_processes_that_died(tmp_path: Path) -> None:
    library = lines(tmp_path / "lib.jsonl", [planar(f"{'deadly' if n == 5 else 'n'}{n}") for n in range(12)])
    look = LookAt(partial(_verifying_but, str(tmp_path)), "brief")
    summary = run_batch([library], tmp_path / "o.jsonl", Crew(look, 1), detail="brief")
    assert outcomes(summary) == {"nothing required": 11, "internal error": 1}
    (tmp_path / "well").touch()
    summary = run_batch([library], tmp_path / "o.jsonl", Crew(look, 1), detail="brief", retry=True)
    assert (summary.retried, outcomes(summary)) == (1, {"nothing required": 12})
