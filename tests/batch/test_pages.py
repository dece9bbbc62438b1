"""Comparisons, tables and pages about outputs."""

import csv
import json
import re
from collections.abc import Callable
from datetime import UTC, datetime
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import pytest

from fixture_design.batch.against import Comparison, _Waiting, compare, losses_in_words
from fixture_design.batch.report import MOST_ROWS, write_batch_report
from fixture_design.batch.summary import Summary
from fixture_design.batch.table import check_table, write_table
from fixture_design.errors import FileFormatError, InputError
from tests.batch.layouts import planar

SCHEMA = "fixture_design/verdict/1"


def record(name: str, satisfied: str | None = "yes", margin: float | None = 0.1, source: str | None = None) -> dict:
    finding = {"verdict": satisfied, "margin": margin}
    return {
        "schema": SCHEMA, "name": name, "source": source or f"{name}.yaml", "satisfied": satisfied,
        "groups": {"all": {"contacts": [], "form_closure": finding}},
        "requirements": [{"group": "all", "require": "form_closure", "verdict": satisfied}],
        "run": {"input": "f00", "time": 0.5},
    }  # fmt: skip


def failed(name: str, source: str | None = None) -> dict:
    error = {"kind": "ContentError", "message": "<b>no</b>, key"}
    return {"schema": SCHEMA, "name": name, "source": source or f"{name}.yaml", "error": error}


def output(path: Path, records: list[dict]) -> Path:
    path.write_text("".join(json.dumps(record) + "\n" for record in records))
    return path


def compared(tmp_path: Path, old: list[dict], new: list[dict]) -> Comparison:
    return compare(output(tmp_path / "new.jsonl", new), output(tmp_path / "old.jsonl", old))


def test_what_changed_what_was_lost_what_is_new_and_gone(tmp_path: Path) -> None:
    old = [record("a"), record("b", "no", -0.1), record("c"), record("d"), record("gone"), record("e")]
    new = [record("a", "no", -0.2), record("b"), record("c", margin=0.05), record("d", margin=0.0999), record("new")]
    found = compared(tmp_path, old, [*new, failed("e")])
    assert [(c.name, c.before, c.after) for c in found.changed] == [
        ("e", "yes", "bad input"), ("a", "yes", "no"), ("b", "no", "yes"),
    ]  # fmt: skip
    assert [(c.name, c.what, c.before, c.after) for c in found.lost] == [
        ("a", "all: form closure", 0.1, -0.2), ("c", "all: form closure", 0.1, 0.05),
    ]  # fmt: skip
    assert (found.new, found.gone, found.same) == (["new"], ["gone"], 5)


def test_layouts_are_found_again_where_the_library_moved_or_a_name_was_lost(tmp_path: Path) -> None:
    old = [record("a", source="old/lib.jsonl:1"), record("b", source="lib.jsonl:2")]
    new = [record("a", source="new/lib.jsonl:1"), failed("lib:2", source="lib.jsonl:2")]
    found = compared(tmp_path, old, new)
    assert (found.same, found.new, found.gone) == (2, [], [])
    assert [c.after for c in found.changed] == ["bad input"]


def test_noise_of_a_margin_of_nothing_is_no_loss(tmp_path: Path) -> None:
    assert compared(tmp_path, [record("a", "no", 1.5e-16)], [record("a", "no", 1e-17)]).lost == []


def test_variants_of_one_name_are_not_mixed_up(tmp_path: Path) -> None:
    old = [record("x", source="a.yaml"), record("x", "no", source="b.yaml")]
    assert compared(tmp_path, old, old[::-1]).changed == []


@pytest.mark.parametrize("turn", [lambda records: records, lambda records: records[::-1], lambda records: records[7:]])
def test_the_order_of_the_library_does_not_matter(tmp_path: Path, turn: Callable) -> None:
    old = [record(f"n{n}", margin=0.1 + n) for n in range(20)]
    new = [record(f"n{n}", "no" if n == 12 else "yes", margin=0.1 + n) for n in range(20)]
    found = compared(tmp_path, turn(old), [record("new"), *new])
    assert [(change.name, change.what) for change in found.changed] == [("n12", "verdict")]
    assert (found.same, len(found.new), found.gone, found.lost) == (len(turn(old)), 21 - len(turn(old)), [], [])


def test_little_waits_where_the_order_was_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    waiting, most = [0], [0]
    put, take = _Waiting.put, _Waiting.take

    def counted_put(self: _Waiting, known: object) -> None:
        waiting[0] += 1
        most[0] = max(most[0], waiting[0])
        put(self, known)  # type: ignore[arg-type]

    def counted_take(self: _Waiting, like: object) -> object:
        found = take(self, like)  # type: ignore[arg-type]
        waiting[0] -= found is not None
        return found

    monkeypatch.setattr(_Waiting, "put", counted_put)
    monkeypatch.setattr(_Waiting, "take", counted_take)
    records = [record(f"n{n}") for n in range(300)]
    assert compared(tmp_path, records, [record("new"), *records]).same == 300
    assert most[0] <= 3


def test_no_layout_in_common(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="no layout of this batch is among these"):
        compared(tmp_path, [record("a")], [record("b")])


@pytest.mark.parametrize(("content", "words"), [("{\n", "line 1: the line is no record"), ("{}\n", "no record"),
                                                ('{"schema": "x", "name": "a"}\n', "found 'x'")])  # fmt: skip
def test_an_earlier_output_that_is_none(tmp_path: Path, content: str, words: str) -> None:
    (tmp_path / "old.jsonl").write_text(content)
    with pytest.raises(FileFormatError, match=words):
        compare(output(tmp_path / "new.jsonl", [record("a")]), tmp_path / "old.jsonl")


def test_csv_has_a_row_each_and_all_columns(tmp_path: Path) -> None:
    stages = record("b", "no", -0.5)
    stages["groups"]["stage, 2"] = {"contacts": [], "seated": {"verdict": "yes"}}
    write_table(output(tmp_path / "o.jsonl", [record("a"), stages, failed("c")]), tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == ["a", "b", "c"]
    assert [row["outcome"] for row in rows] == ["yes", "no", "bad input"]
    assert [row["all.form_closure.margin"] for row in rows] == ["0.1", "-0.5", ""]
    assert [row["stage, 2.seated"] for row in rows] == ["", "yes", ""]
    assert rows[2]["error_message"] == "<b>no</b>, key"


@pytest.mark.skipif(not find_spec("polars"), reason="polars is not installed")
def test_parquet(tmp_path: Path) -> None:
    import polars  # noqa: PLC0415

    write_table(output(tmp_path / "o.jsonl", [record("a"), failed("c")]), tmp_path / "t.parquet")
    found = polars.read_parquet(tmp_path / "t.parquet")
    assert found["smallest_margin"].to_list() == [0.1, None]
    assert found["outcome"].to_list() == ["yes", "bad input"]


def test_tables_of_other_kinds(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"ends in \.csv or \.parquet"):
        check_table(tmp_path / "t.xlsx")


@pytest.mark.skipif(bool(find_spec("polars") or find_spec("pandas")), reason="Parquet can be written here")
def test_parquet_needs_a_package(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="pip install polars"):
        check_table(tmp_path / "t.parquet")


class Tags(HTMLParser):
    """Checks that tags are closed, and counts them."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.count: dict[str, int] = {}

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def page(tmp_path: Path, records: list[dict], comparison: Comparison | None = None) -> str:
    from fixture_design.batch.item import Entry, Item  # noqa: PLC0415
    from fixture_design.batch.outcome import outcome_of, smallest_margin  # noqa: PLC0415

    summary = Summary()
    for number, each in enumerate(records):
        text = json.dumps(planar(sweep={"at": 0.1, "samples": 9})).encode()
        item = Item(each["source"], text, 1, number if "[" in each["name"] else None, sampled=True)
        summary.add(item, Entry(json.dumps(each).encode(), outcome_of(each), smallest_margin(each)))
    path = tmp_path / "page.html"
    when = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)
    write_batch_report(output(tmp_path / "o.jsonl", records), path, summary, comparison, when)
    return path.read_text()


def test_the_page_is_whole_self_contained_and_escaped(tmp_path: Path) -> None:
    records = [record("a<script>"), record("s[0]", source="s"), record("s[1]", "no", -0.2, source="s"), failed("c")]
    text = page(tmp_path, records, compared(tmp_path, records[:1], [record("a<script>", "no", -1.0)]))
    tags = Tags()
    tags.feed(text)
    assert tags.open == []
    assert tags.count["script"] == 1
    assert not re.search(r"(src|href)=|https?://", text)
    for words in (
        "2026-01-02 03:04 UTC",
        "a&lt;script&gt;",
        "&lt;b&gt;no&lt;/b&gt;",
        "all: form closure",
        "s[1]",
        "P2 by (",
    ):
        assert words in text
    assert tags.count["rect"] == 40


def test_the_worst_come_first_and_many_are_cut(tmp_path: Path) -> None:
    records = [record(f"n{k}", margin=k / 1e5) for k in range(MOST_ROWS + 10)]
    text = page(tmp_path, [*records, failed("bad"), record("fails", "no", -1.0)])
    names = re.findall(r"<td>(bad|fails|n\d+)</td>", text)
    assert names[:3] == ["bad", "fails", "n0"]
    assert len(names) == MOST_ROWS
    assert f"The {MOST_ROWS} worst of {MOST_ROWS + 12}." in text


def test_pages_of_brief_records_and_of_one_margin(tmp_path: Path) -> None:
    assert "<svg" not in page(tmp_path, [record("a", margin=None)])
    assert "<svg" in page(tmp_path, [record("a", margin=0.0)])
    assert "<h1>" in page(tmp_path, [])


def test_margins_that_differ_by_rounding_are_one_bar(tmp_path: Path) -> None:
    for margins in ([0.1, 0.1 + 2e-17, 0.1 + 3e-17], [0.3, 0.30000000000000004], [0.0, 5e-324], [-1e-3, -1e-3 - 1e-18]):
        records = [record(f"n{k}", margin=margin) for k, margin in enumerate(margins)]
        assert "<svg" in page(tmp_path, records)


def test_a_name_as_long_as_a_file_is_cut(tmp_path: Path) -> None:
    assert len(page(tmp_path, [record("n" * 1_000_000), failed("e" * 1_000_000)])) < 20_000


def test_brief_and_full_records_cannot_be_compared(tmp_path: Path) -> None:
    full = {**record("a"), "contacts": []}
    found = compared(tmp_path, [full], [record("a", margin=None)])
    assert found.unlike == 1
    assert "not compared for all" in losses_in_words(found)
    assert losses_in_words(compared(tmp_path, [full], [full])) == "0 margins were lost"
