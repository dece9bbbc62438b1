"""`fixture-design interactive` from its start to its end: nothing is lost, whatever ends it."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import fixture_design as fd
from tests.cli.conftest import Ran
from tests.viewing.meshcat_client import Client

URDF = Path(__file__).resolve().parents[3] / "urdf"
POLYGON = URDF / "figure8" / "polygon_p12345.layout.yaml"
PROGRAM = [sys.executable, "-c", "from fixture_design.cli.main import main; main()", "interactive"]


@contextmanager
def running(*arguments: object) -> Iterator[tuple[subprocess.Popen[str], Client]]:
    process = subprocess.Popen(
        [*PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split(" ")[0]
        assert address.startswith("http://localhost:"), process.communicate(timeout=30)
        client = Client(address)
        client.wait_for(lambda c: "u [mm]" in c.sliders and c.buttons[-1].startswith("file: "))
        yield process, client
        client.close()
    finally:
        process.kill()
        process.communicate()


def unsaved(client: Client) -> bool:
    return client.buttons[-1].startswith("not saved yet: ")


@pytest.mark.parametrize(("sent", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_signals_leave_a_recovery_file(tmp_path: Path, sent: signal.Signals, code: int) -> None:
    with running(POLYGON, "-o", tmp_path / "p.yaml") as (process, client):
        client.slide("u [mm]", 200.0)
        client.wait_for(unsaved)
        process.send_signal(sent)
        _, err = process.communicate(timeout=30)
    assert process.returncode == code
    path = tmp_path / "p.recovered.yaml"
    assert str(path) in err
    assert "Traceback" not in err
    moved = np.linalg.norm(fd.read_layout(path).elements[0].at - fd.read_layout(POLYGON).elements[0].at)
    assert moved == pytest.approx(0.2)
    assert not (tmp_path / "p.yaml").exists()


def test_what_is_saved_needs_no_recovery(tmp_path: Path) -> None:
    with running(POLYGON, "-o", tmp_path / "p.yaml") as (process, client):
        client.click("remove")
        client.wait_for(unsaved)
        client.click("save")
        client.wait_for(lambda c: not unsaved(c))
        client.click("quit")
        _, err = process.communicate(timeout=30)
    assert process.returncode == 0
    assert "recovered" not in err
    assert len(fd.read_layout(tmp_path / "p.yaml").elements) == 4
    assert [each.name for each in tmp_path.iterdir()] == ["p.yaml"]


def test_clicks_on_lines_settle(tmp_path: Path) -> None:
    """On one that is about no answer, and on an answer: each is taken once, and then nothing more is sent."""
    with running(POLYGON, "-o", tmp_path / "p.yaml") as (_, client):
        line = next(name for name in client.buttons if "all: form_closure" in name)
        plain = next(name for name in client.buttons if name.startswith("P1: locator"))
        for name in (plain, line):
            client.click(name)
            while client.receive(0.5) is not None:
                pass
        client.click(line)
        assert client.receive(10) is not None
        count = 1
        while client.receive(0.5) is not None:
            count += 1
        assert count < 60


def test_it_listens_on_this_machine_only(tmp_path: Path) -> None:
    sockets = Path("/proc/net/tcp")
    if not sockets.is_file():
        pytest.skip("no /proc/net/tcp to look into")
    with running(POLYGON, "-o", tmp_path / "p.yaml", "--port", "7456"):
        rows = [row.split()[1] for row in sockets.read_text().splitlines()[1:] if row.split()[3] == "0A"]
        assert {row.split(":")[0] for row in rows if row.endswith(f":{7456:04X}")} == {"0100007F"}


def test_wrong_use_is_one_message(command: Callable[..., Ran], tmp_path: Path) -> None:
    for arguments, words in (
        ((POLYGON, "--port", 80), "no port"),
        ((POLYGON, "--scale", 2), "scale"),
        ((tmp_path / "none.yaml",), "none.yaml"),
        ((URDF / "figure8" / "p1234.layout.yaml",), "without a part"),
        ((POLYGON, "-o", tmp_path / "x.stl"), "YAML or JSON"),
    ):
        ran = command("interactive", *arguments)
        assert ran.code == 2, ran
        assert words in ran.err
        assert len(ran.err.splitlines()) == 1
