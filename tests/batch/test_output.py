"""Records are appended, found again, and never mistaken for those of something else."""

import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from fixture_design.batch import job as job_module
from fixture_design.batch import run_batch
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.output import Output
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.records import Detail, entry_of
from fixture_design.errors import FileFormatError
from tests.batch.layouts import FAILS, HOLDS, lines, planar


class InThisProcess:
    """Workers without processes; ``most`` items only, as if killed then."""

    def __init__(self, detail: Detail = "brief", most: int | None = None) -> None:
        self.detail, self.most, self.seen = detail, most, 0

    def entries(self, items: Iterator[Item], stop: object = None) -> Iterator[list[tuple[Item, Entry]]]:
        for item in items:
            if self.seen == self.most:
                return
            self.seen += 1
            yield [(item, entry_of(item, PartCache(), self.detail))]

    def close(self) -> None:
        pass


@pytest.fixture
def library(tmp_path: Path) -> Path:
    layouts = [planar("a", require=HOLDS), planar("b", require=FAILS), planar("c", friction=-1), planar("d"), "{x"]
    return lines(tmp_path / "lib.jsonl", layouts)


def run(
    library: Path, output: Path, most: int | None = None, detail: Detail = "brief", **keys: Any
) -> tuple[int, list[dict]]:
    """How many layouts were looked at, and all records without their times."""
    workers = InThisProcess(detail, most)
    run_batch([library], output, workers, detail=detail, **keys)
    records = [json.loads(line) for line in output.read_text().splitlines()]
    for record in records:
        record.get("run", {}).pop("time", None)
    return workers.seen, records


def test_records_in_order_with_hash_version_and_tolerances(library: Path, tmp_path: Path) -> None:
    seen, records = run(library, tmp_path / "o.jsonl")
    assert seen == 5
    assert [record["name"] for record in records] == ["a", "b", "c", "d", "lib:5"]
    assert [record.get("satisfied", "error") for record in records] == ["yes", "no", "error", None, "error"]
    assert set(records[2]) == {"schema", "name", "source", "error", "run"}
    assert set(records[2]["run"]) == {"version", "input"}
    assert "lib.jsonl:5: column 2" in records[4]["error"]["message"]
    run_of = records[0]["run"]
    assert len(run_of["input"]) == 64
    assert run_of["input"] != records[1]["run"]["input"]
    assert {"version", "tolerances", "kernel"} <= set(run_of)


@pytest.mark.parametrize("most", range(6))
def test_a_run_that_was_stopped_goes_on(library: Path, tmp_path: Path, most: int) -> None:
    _, whole = run(library, tmp_path / "whole.jsonl")
    run(library, tmp_path / "o.jsonl", most)
    seen, records = run(library, tmp_path / "o.jsonl")
    assert seen == 5 - min(most, 5)
    assert records == whole


@pytest.mark.parametrize("cut", [1, 2, 30, 200, 700])
def test_a_last_line_that_is_cut_short_is_made_again(library: Path, tmp_path: Path, cut: int) -> None:
    output = tmp_path / "o.jsonl"
    _, whole = run(library, output)
    with output.open("r+b") as file:
        file.truncate(output.stat().st_size - cut)
    seen, records = run(library, output)
    assert seen >= 1
    assert records == whole


def test_every_cut_of_the_first_line(tmp_path: Path) -> None:
    library, output = lines(tmp_path / "one.jsonl", [planar("a")]), tmp_path / "o.jsonl"
    _, whole = run(library, output)
    raw = output.read_bytes()
    for size in range(0, len(raw), 29):
        output.write_bytes(raw[:size])
        assert run(library, output) == (1, whole)


CHANGES = {
    "another order": (lambda layouts: layouts[::-1], "has changed since"),
    "a text that changed": (lambda layouts: [planar("a", friction=0.1), *layouts[1:]], "'.*:1', or a file it names"),
    "a layout less": (lambda layouts: layouts[:2], "more records than layouts"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_an_output_of_another_input(tmp_path: Path, name: str) -> None:
    change, words = CHANGES[name]
    layouts: Sequence[object] = [planar("a"), planar("b"), planar("c")]
    library, output = lines(tmp_path / "lib.jsonl", layouts), tmp_path / "o.jsonl"
    run(library, output)
    before = output.read_bytes()
    lines(library, change(layouts))
    with pytest.raises(FileFormatError, match=f"results of something else: .*{words}"):
        run(library, output)
    assert output.read_bytes() == before


def test_more_layouts_at_the_end_are_added(tmp_path: Path) -> None:
    library, output = lines(tmp_path / "lib.jsonl", [planar("a")]), tmp_path / "o.jsonl"
    run(library, output)
    lines(library, [planar("a"), planar("b")])
    assert run(library, output)[0] == 1


def test_brief_and_full_are_not_mixed(library: Path, tmp_path: Path) -> None:
    run(library, tmp_path / "o.jsonl", 1)
    with pytest.raises(FileFormatError, match="records are brief, and those wanted are full"):
        run(library, tmp_path / "o.jsonl", detail="full")


def test_another_version_is_not_gone_on_with(library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run(library, tmp_path / "o.jsonl", 1)
    monkeypatch.setattr("fixture_design.batch.output.VERSION", "9.9")
    with pytest.raises(FileFormatError, match=r"of version .*; this is 9\.9"):
        run(library, tmp_path / "o.jsonl")


def test_a_part_that_changed_is_noticed(tmp_path: Path) -> None:
    mesh = tmp_path / "a.stl"
    mesh.write_text("one")
    library, output = (
        lines(tmp_path / "lib.jsonl", [planar("a", loads=[{"name": "cut", "path": "a.stl"}])]),
        tmp_path / "o",
    )
    run(library, output)
    assert run(library, output)[0] == 0
    mesh.write_text("another")
    with pytest.raises(FileFormatError, match="or a file it names, has changed"):
        run(library, output)


@pytest.mark.parametrize("content", ["hello", "hello\n", '{"schema": "fixture_design/layout/1"}\n', "{}\n"])
def test_a_file_of_something_else_is_left_alone(library: Path, tmp_path: Path, content: str) -> None:
    output = tmp_path / "notes.txt"
    output.write_text(content)
    with pytest.raises(FileFormatError, match="exists and holds something else"):
        run(library, output)
    assert output.read_text() == content


def test_a_line_in_the_middle_that_is_no_record(library: Path, tmp_path: Path) -> None:
    output = tmp_path / "o.jsonl"
    run(library, output)
    first, *others = output.read_text().splitlines(keepends=True)
    output.write_text(first + "oh\n" + "".join(others))
    with pytest.raises(FileFormatError, match=r"line 2: the output has a line that is no record"):
        run(library, output)


def test_outputs_that_cannot_be(library: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.jsonl"
    link.symlink_to(library)
    for output, words in (
        (library, "is one of the inputs"),
        (link, "is one of the inputs"),
        (tmp_path, "no regular file"),
        (tmp_path / "no" / "o.jsonl", "cannot be written"),
    ):
        with pytest.raises(FileFormatError, match=words):
            run(library, output)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everything")
def test_an_output_that_may_not_be_written(library: Path, tmp_path: Path) -> None:
    (tmp_path / "o.jsonl").touch(mode=0o400)
    with pytest.raises(FileFormatError, match="cannot be written: Permission denied"):
        run(library, tmp_path / "o.jsonl")


def test_two_batches_do_not_share_an_output(library: Path, tmp_path: Path) -> None:
    first = Output(tmp_path / "o.jsonl", [library])
    with pytest.raises(FileFormatError, match="another batch is writing"):
        Output(tmp_path / "o.jsonl", [library])
    first.close()
    Output(tmp_path / "o.jsonl", [library]).close()


def test_workers_are_closed_when_the_output_is_refused(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    closed = []
    workers = InThisProcess()
    monkeypatch.setattr(workers, "close", lambda: closed.append(True))
    with pytest.raises(FileFormatError):
        job_module.run_batch([library], library, workers)
    assert closed


@pytest.mark.parametrize("detail", ["brief", "full", "sets"])
def test_records_follow_the_schema_of_verdicts(library: Path, tmp_path: Path, detail: Detail) -> None:
    from pydantic import TypeAdapter  # noqa: PLC0415

    from fixture_design.io.verdict_schema import FailureRecord, VerdictRecord  # noqa: PLC0415

    run(library, tmp_path / "o.jsonl", detail=detail)
    adapter = TypeAdapter(VerdictRecord | FailureRecord)
    for line in (tmp_path / "o.jsonl").read_text().splitlines():
        adapter.validate_json(line, strict=True)
    first = json.loads((tmp_path / "o.jsonl").read_text().splitlines()[0])["groups"]["all"]
    assert bool(first.get("admissible_forces")) == (detail == "sets")
    assert ("bidirectional" in first) == (detail == "sets")
