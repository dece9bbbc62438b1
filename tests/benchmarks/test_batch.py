"""Batches of layouts of contacts, next to parsing their texts alone and to loops over solvers.

    pytest tests/benchmarks/test_batch.py --benchmark-enable

Each has the ratio to parsing alone in its `extra_info`; that needs no idle machine. Whole runs with processes are
`end to end`; they do.
"""

import json
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from fixture_design.batch import items_of, local_workers
from fixture_design.batch.alike import Alike
from fixture_design.batch.item import Item
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.records import entry_of
from tests.benchmarks.conftest import ellipsoid_contacts

Benchmark = Callable[..., Any]
COUNT = 500
WHOLE = 20_000
REQUIRE = {"locators": ["deterministic", "strongly_accessible"], "all": ["form_closure"]}


def text(seed: int, count: int = 8) -> str:
    contacts = [
        {"name": c.name, "role": "locator" if k < 6 else "clamp", "point": np.round(c.point, 6).tolist(),
         "normal": np.round(c.normals[0], 4).tolist()}
        for k, c in enumerate(ellipsoid_contacts(count, "spatial", seed))
    ]  # fmt: skip
    layout = {"schema": "fixture_design/layout/1", "name": f"n{seed}", "contacts": contacts, "require": REQUIRE}
    return json.dumps(layout)


@pytest.fixture(scope="module")
def items() -> list[Item]:
    return [Item(f"lib.jsonl:{k}", text(k).encode(), k) for k in range(1, COUNT + 1)]


def seconds(work: Callable[[], object], rounds: int = 5) -> float:
    """The shortest of some times of this process."""
    times = []
    for _ in range(rounds):
        start = process_time()
        work()
        times.append(process_time() - start)
    return min(times)


def told(benchmark: Benchmark, items: list[Item], work: Callable[[], object]) -> None:
    """Measures, and adds the ratio to parsing alone where measuring is on."""
    benchmark(work)
    if benchmark.enabled:  # type: ignore[attr-defined]
        parsing = seconds(lambda: [json.loads(item.text or b"") for item in items])
        benchmark.extra_info["ratio to parsing"] = round(seconds(work) / parsing, 1)  # type: ignore[attr-defined]


@pytest.mark.benchmark(group=f"{COUNT} layouts of contacts")
def test_parsing_alone(benchmark: Benchmark, items: list[Item]) -> None:
    assert len(benchmark(lambda: [json.loads(item.text or b"") for item in items])) == COUNT


@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.benchmark(group=f"{COUNT} layouts of contacts")
def test_alike(benchmark: Benchmark, items: list[Item], detail: Any) -> None:
    alike = Alike(detail)
    assert len(alike.entries(items)) == COUNT
    told(benchmark, items, lambda: alike.entries(items))


@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.benchmark(group="20 layouts of contacts, one by one")
def test_one_by_one(benchmark: Benchmark, items: list[Item], detail: Any) -> None:
    parts, some = PartCache(), items[:20]
    told(benchmark, some, lambda: [entry_of(item, parts, detail) for item in some])


def face_vectors(item: Item) -> np.ndarray:
    contacts = json.loads(item.text or b"")["contacts"]
    points, normals = (np.array([contact[key] for contact in contacts]) for key in ("point", "normal"))
    levers = (points - points.mean(axis=0)) / 0.04
    rows = np.hstack([normals, np.cross(levers, normals)])
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def closed_by_linprog(rows: np.ndarray) -> bool:
    """Positive weights that balance, by HiGHS, and the rank."""
    found = linprog(np.ones(len(rows)), A_eq=rows.T, b_eq=np.zeros(6), bounds=[(1, None)] * len(rows))
    return found.status == 0 and np.linalg.matrix_rank(rows) == 6


def closed_as_dexnet(rows: np.ndarray) -> bool:
    """The smallest wrench in the hull, asked of cvxopt's QP with the numbers that dex-net gives it."""
    cvxopt = pytest.importorskip("cvxopt", reason="cvxopt, which dex-net uses, is not installed")
    count, matrix = len(rows), cvxopt.matrix
    cvxopt.solvers.options["show_progress"] = False
    found = cvxopt.solvers.qp(
        matrix(2 * (rows @ rows.T + 1e-10 * np.eye(count))), matrix(0.0, (count, 1)), matrix(-np.eye(count)),
        matrix(0.0, (count, 1)), matrix(1.0, (1, count)), matrix(1.0),
    )  # fmt: skip
    return found["primal objective"] < 1e-6


def closed_by_qp(rows: np.ndarray) -> bool:
    """The same of scipy's SLSQP."""
    gram, count = rows @ rows.T, len(rows)
    found = minimize(
        lambda w: w @ gram @ w, np.full(count, 1 / count), jac=lambda w: 2 * gram @ w, bounds=[(0, None)] * count,
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1, "jac": lambda w: np.ones(count)}, method="SLSQP",
    )  # fmt: skip
    return bool(found.fun < 1e-6)


@pytest.mark.parametrize("solve", [closed_by_linprog, closed_as_dexnet, closed_by_qp])
@pytest.mark.benchmark(group="20 layouts of contacts, form closure alone")
def test_loops_over_solvers(benchmark: Benchmark, items: list[Item], solve: Callable[[np.ndarray], bool]) -> None:
    some = items[:20]
    told(benchmark, some, lambda: [solve(face_vectors(item)) for item in some])


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("batch") / "lib.jsonl"
    path.write_text("".join(text(k) + "\n" for k in range(WHOLE)))
    yield path
    path.unlink()


@pytest.mark.slow
@pytest.mark.parametrize("detail", ["brief", "full"])
@pytest.mark.benchmark(group=f"{WHOLE} layouts of contacts, end to end", min_rounds=2)
def test_end_to_end(benchmark: Benchmark, library: Path, detail: Any) -> None:
    def run() -> int:
        with closing(local_workers(detail)) as workers:
            return sum(len(some) for some in workers.entries(items_of([library])))

    assert benchmark(run) == WHOLE


def test_together_costs_little_more_than_parsing(items: list[Item]) -> None:
    """Far from the ratios that are measured (2 to 3, 6 to 9): this must only notice that something is lost."""
    parsing = seconds(lambda: [json.loads(item.text or b"") for item in items])
    for detail, most in (("brief", 40), ("full", 100)):
        alike = Alike(detail)  # type: ignore[arg-type]
        alike.entries(items)
        assert seconds(lambda alike=alike: alike.entries(items)) < most * parsing
