"""The same batch on a Dask cluster: same records, same order, whatever dies."""

import os
import signal
from collections.abc import Iterator, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fixture_design.batch import input_files, items_of, local_workers, run_batch
from fixture_design.batch.cluster import Cluster
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import Detail, record_of
from fixture_design.batch.worker import Known, Look
from fixture_design.errors import InputError
from tests.batch.layouts import FAILS, HOLDS, deadly, lines, planar

distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed (the extra `cluster`)")


@pytest.fixture(scope="module")
def scheduler() -> Iterator[Any]:
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster


def untimed(path: Path) -> list[dict]:
    records = [record_of(line) for line in path.read_bytes().splitlines()]
    for record in records:
        record.get("run", {}).pop("time", None)
    return records


def library(tmp_path: Path, count: int) -> list[Path]:
    layouts = [planar(f"n{n}", require=HOLDS if n % 3 else FAILS, friction=n / 1e4) for n in range(count)]
    return input_files([lines(tmp_path / "lib.jsonl", [*layouts, "{broken", planar("last")])])


def test_records_are_those_of_one_machine(tmp_path: Path, scheduler: Any) -> None:
    files = library(tmp_path, 300)
    run_batch(files, tmp_path / "here.jsonl", local_workers("full", jobs=1))
    summary = run_batch(files, tmp_path / "there.jsonl", Cluster(scheduler.scheduler_address, "full"))
    assert summary.count == 302
    assert untimed(tmp_path / "there.jsonl") == untimed(tmp_path / "here.jsonl")


def test_a_worker_killed_midway_loses_nothing(tmp_path: Path, scheduler: Any) -> None:
    layouts = [planar(f"n{n}", sweep={"at": 0.1, "samples": 300}, require=HOLDS) for n in range(2)]
    files = input_files([lines(tmp_path / "lib.jsonl", layouts)])
    run_batch(files, tmp_path / "here.jsonl", local_workers("brief", jobs=1), detail="brief")
    killed: list[int] = []

    def watch(some: list[tuple[Item, Entry]]) -> None:
        if not killed:
            killed.append(next(iter(scheduler.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    workers = Cluster(scheduler.scheduler_address, "brief")
    run_batch(files, tmp_path / "there.jsonl", workers, detail="brief", watch=watch)
    assert killed
    assert untimed(tmp_path / "there.jsonl") == untimed(tmp_path / "here.jsonl")


def _deadly(folder: str, detail: Detail) -> Look:
    return deadly(folder)


def test_an_item_on_which_workers_die(tmp_path: Path, scheduler: Any) -> None:
    texts = ["a", "b", "abort", "c", "once", "d"]
    items = [Item(f"{n}.yaml", text.encode()) for n, text in enumerate(texts)]
    with closing(Cluster(scheduler.scheduler_address, "full", partial(_deadly, str(tmp_path)))) as workers:
        found = [entry.line for some in workers.entries(iter(items)) for _, entry in some]
    assert record_of(found[2])["error"]["kind"] == "WorkerError"
    assert [found[n] for n in (0, 1, 3, 4, 5)] == [f"{n}.yaml {texts[n]}\n".encode() for n in (0, 1, 3, 4, 5)]


def _faulty(detail: Detail) -> Look:
    def look(items: Sequence[Item]) -> Iterator[Known]:
        if any(item.text == b"fault" for item in items):
            raise np.linalg.LinAlgError("SVD did not converge")
        yield [(place, Entry(item.text or b"", "yes")) for place, item in enumerate(items)]

    return look


def test_a_fault_costs_one_item_its_verdict(scheduler: Any) -> None:
    """Any error of a chunk, not only that its workers die."""
    items = [Item(f"{n}.yaml", b"fault" if n == 3 else b"%d\n" % n) for n in range(12)]
    with closing(Cluster(scheduler.scheduler_address, "full", _faulty)) as workers:
        found = [entry.line for some in workers.entries(iter(items)) for _, entry in some]
    assert len(found) == 12
    assert [line for n, line in enumerate(found) if n != 3] == [b"%d\n" % n for n in range(12) if n != 3]
    assert "LinAlgError: SVD did not converge" in record_of(found[3])["error"]["message"]


def test_stopping_leaves_what_is_known(tmp_path: Path, scheduler: Any) -> None:
    files = library(tmp_path, 200)
    known: list[object] = []
    with closing(Cluster(scheduler.scheduler_address, "brief")) as workers:
        for some in workers.entries(items_of(files), stop=lambda: bool(known)):  # noqa: B023
            known += some
    assert 0 < len(known) < 202


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense://x", "nonsense", ""])
def test_nobody_answers(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fixture_design.batch.cluster._ANSWER", 1.0)
    with pytest.raises(InputError, match="no Dask scheduler answers"):
        Cluster(address, "full")
