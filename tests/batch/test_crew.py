"""Workers that die or hang cost nobody else's record, and results keep their order."""

import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from fixture_design.batch import crew as crew_module
from fixture_design.batch.crew import Crew
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.output import _difference
from fixture_design.batch.records import Detail, TimeLimitError, WorkerError, given_up, record_of
from fixture_design.batch.starting import started
from fixture_design.batch.worker import Known, Look, LookAt
from tests.batch.layouts import deadly


def looked_at(folder: Path, texts: Sequence[str], limit: float | None = None) -> list[bytes]:
    items = [Item(f"{n}.yaml", text.encode()) for n, text in enumerate(texts)]
    with closing(Crew(LookAt(partial(_deadly, str(folder)), "full"), 2, limit)) as crew:
        return [entry.line for some in crew.entries(iter(items)) for _, entry in some]


def _deadly(folder: str, detail: Detail) -> Look:
    return deadly(folder)


def test_order_is_kept_and_nothing_is_lost(tmp_path: Path) -> None:
    texts = [f"t{n}" for n in range(500)]
    assert looked_at(tmp_path, texts) == [f"{n}.yaml t{n}\n".encode() for n in range(500)]


def test_a_worker_that_dies_once_or_always(tmp_path: Path) -> None:
    texts = ["a", "once", "b", "abort", "c", "once", "d", "e", "f", "abort"]
    found = looked_at(tmp_path, texts)
    assert len(found) == len(texts)
    for number, (text, line) in enumerate(zip(texts, found, strict=True)):
        if text == "abort":
            record = record_of(line)
            assert (record["source"], record["name"]) == (f"{number}.yaml", str(number))
            assert record["error"]["kind"] == "WorkerError"
            assert "died twice (signal SIGABRT)" in record["error"]["message"]
        else:
            assert line == f"{number}.yaml {text}\n".encode()


def test_what_takes_too_long_is_ended(tmp_path: Path) -> None:
    start = time.monotonic()
    found = looked_at(tmp_path, ["a", "hang", "b", "c"], limit=1.0)
    assert time.monotonic() - start < 30
    record = record_of(found[1])
    assert record["error"]["kind"] == "TimeLimitError"
    assert "longer than the 1 s" in record["error"]["message"]
    assert [found[n] for n in (0, 2, 3)] == [b"0.yaml a\n", b"2.yaml b\n", b"3.yaml c\n"]


def _stillborn(detail: Detail) -> Look:
    raise SystemExit(3)


def test_workers_that_never_begin_are_an_error() -> None:
    with (
        closing(Crew(LookAt(_stillborn, "full"), 1)) as crew,
        pytest.raises(WorkerError, match="before they begin to work"),
    ):
        list(crew.entries(iter([Item("x", b"")])))


def test_memory_does_not_grow_with_the_items(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew_module, "LARGEST_CHUNK", 8)
    ahead = drawn = given = 0

    def items():
        nonlocal drawn
        for n in range(5000):
            drawn += 1
            yield Item(f"{n}", b"t")

    with closing(Crew(LookAt(partial(_deadly, str(tmp_path)), "full"), 1)) as crew:
        for some in crew.entries(items()):
            given += len(some)
            ahead = max(ahead, drawn - given)
    assert given == 5000
    assert ahead <= (crew_module.WINDOW + 1) * 8


def _told_together(detail: Detail) -> Look:
    """Says nothing before it has looked at all items of a chunk, as where these are decided together."""

    def look(items: Sequence[Item]) -> Iterator[Known]:
        time.sleep(0.4 * len(items))
        yield [(place, Entry(item.text or b"", "yes")) for place, item in enumerate(items)]

    return look


def test_nobody_is_blamed_for_the_others_time() -> None:
    items = [Item(f"{n}", b"%d\n" % n) for n in range(4)]
    with closing(Crew(LookAt(_told_together, "full"), 1, limit=1.0)) as crew:
        found = [entry.line for some in crew.entries(iter(items)) for _, entry in some]
    assert found == [b"%d\n" % n for n in range(4)]


def test_no_more_processes_than_there_is_work_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[object] = []

    def counted(look_at: LookAt) -> object:
        begun.append(look_at)
        return started(look_at)

    monkeypatch.setattr(crew_module, "started", counted)
    with closing(Crew(LookAt(partial(_deadly, str(tmp_path)), "full"), 10**21)) as crew:
        found = [
            entry.line for some in crew.entries(iter([Item(f"{n}", b"t") for n in range(12)])) for _, entry in some
        ]
    assert len(found) == 12
    assert len(begun) <= 2


def test_what_was_heard_before_the_end_is_kept(tmp_path: Path) -> None:
    """A stop that is asked for while workers speak loses nothing that they said."""
    asked: list[object] = []
    with closing(Crew(LookAt(partial(_deadly, str(tmp_path)), "full"), 1)) as crew:
        heard = crew._hear

        def hear() -> None:
            heard()
            asked.extend(crew._known)

        crew._hear = hear  # type: ignore[method-assign]
        items = [Item(f"{n}", b"t") for n in range(3)]
        found = [entry for some in crew.entries(iter(items), stop=lambda: bool(asked)) for _, entry in some]
    assert len(found) == len(set(asked)) > 0


def test_given_up_layouts_are_not_read_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their text may take for ever to read: name and hash do without, and so does going on."""
    item = Item("x.yaml", b"name: y\npart: {mesh: z.stl}\n")
    monkeypatch.setattr("fixture_design.batch.digest.values_of", lambda item: pytest.fail("it was read"))
    monkeypatch.setattr("fixture_design.batch.records.values_of", lambda item: pytest.fail("it was read"))
    found = record_of(given_up(item, TimeLimitError("it took long")).line)
    assert (found["name"], found["error"]["kind"]) == ("x", "TimeLimitError")
    assert _difference(found, item, "full", mended=False) is None
    assert _difference(found, item._replace(text=b"path: other"), "full", mended=False) is not None
