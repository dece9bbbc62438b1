"""From a slider's event in the browser to the last message that answers it, on a printed part of 14,700 triangles.

The session is a process of its own, the browser is replaced by a client that takes its messages. `--benchmark-enable`
measures; a benchmark that is not measured holds a few slides to the same limit by their processor time, with which
other work on the machine does not interfere.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.viewing.meshcat_client import Client

LAYOUT = Path(__file__).resolve().parents[1] / "layouts" / "robotiq_adapter.layout.yaml"
PROGRAM = [sys.executable, "-c", "from fixture_design.cli.main import main; main()", "interactive"]
#: Silence after which nothing more comes [s].
SILENCE = 0.25
#: Slides of one benchmark.
SLIDES = 40
#: Slides whose processor time is asked for.
FEW = 10
#: Median that is asked for [s].
MEDIAN = 0.05


@pytest.fixture
def client(shared: Path, tmp_path: Path) -> Iterator[Client]:
    if not (shared / "data" / "airo-models").is_dir():
        pytest.skip("the adapter's mesh is not there")
    arguments = [*PROGRAM, str(LAYOUT), "-o", str(tmp_path / "x.yaml")]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        assert process.stdout is not None
        client = Client(process.stdout.readline().split(" ")[0])
        client.wait_for(lambda c: bool(c.buttons) and c.buttons[-1].startswith("file: "))
        silent(client)
        client.process = process.pid
        yield client
        client.close()
        process.terminate()


def processor_time(process: int) -> float:
    """What a process has used so far [s]."""
    stat = Path(f"/proc/{process}/stat")
    if not stat.is_file():
        pytest.skip("no /proc to ask for processor time")
    fields = stat.read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def silent(client: Client) -> float | None:
    """Takes messages until no more come; when the last one came."""
    last = None
    while (came := client.receive(SILENCE)) is not None:
        last = came
    return last


@pytest.mark.parametrize(("element", "which"), [(1, "locator"), (7, "clamp")])
@pytest.mark.benchmark(group="from a slider's event to the last message")
def test_a_slide(benchmark: Any, client: Client, element: int, which: str) -> None:
    client.slide("element", element)
    silent(client)
    taken: list[float] = []

    def slide(number: int) -> None:
        start = time.perf_counter()
        client.slide("u [mm]", 0.1 * (number % 10 + 1))
        last = silent(client)
        assert last is not None
        taken.append(last - start)

    if benchmark.disabled:
        spent = processor_time(client.process)
        for number in range(FEW):
            slide(number)
        assert (processor_time(client.process) - spent) / FEW < MEDIAN
        return
    for number in range(SLIDES):
        slide(number)
    median = sorted(taken)[len(taken) // 2]
    benchmark.extra_info["median_ms"] = 1e3 * median
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"{which}: median {1e3 * median:.1f} ms, slowest of ten {1e3 * sorted(taken)[-SLIDES // 10]:.1f} ms")
    assert median < MEDIAN
