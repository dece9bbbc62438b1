"""`verify` warm, in one process, and as a process of its own."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fixture_design.io import read_layout
from fixture_design.layout import Layout
from fixture_design.verification import verify
from tests.benchmarks.conftest import SIZES, ellipsoid_contacts

Benchmark = Callable[..., Any]
URDF = Path(__file__).resolve().parents[2] / "urdf"
FILES = {"bracket": URDF / "bracket" / "bracket.layout.yaml", "figure 8": URDF / "figure8" / "p12345.layout.yaml"}


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.benchmark(group="verify, contacts given, warm")
def test_contacts_warm(benchmark: Benchmark, count: int) -> None:
    layout = Layout("ellipsoid", contacts=ellipsoid_contacts(count, "spatial"))
    assert benchmark(verify, layout).groups["all"].contacts


@pytest.mark.parametrize("name", FILES)
@pytest.mark.benchmark(group="read and verify a file, warm")
def test_file_warm(benchmark: Benchmark, name: str) -> None:
    assert benchmark(lambda: verify(read_layout(FILES[name]))).satisfied == "yes"


@pytest.mark.parametrize("name", FILES)
@pytest.mark.benchmark(group="verify as a process", min_rounds=5)
def test_process(benchmark: Benchmark, name: str) -> None:
    command = [
        sys.executable,
        "-c",
        "from fixture_design.cli import main; main()",
        "verify",
        "--json",
        str(FILES[name]),
    ]
    done = benchmark(subprocess.run, command, check=False, capture_output=True)
    assert done.returncode == 0
