"""The V-block: its files are what the script makes, and its layout holds what it requires."""

import subprocess
import sys
from pathlib import Path

from fixture_design.io import read_layout
from fixture_design.verification import check, verify

FOLDER = Path(__file__).resolve().parents[2] / "urdf" / "vblock"


def test_the_files_are_what_the_script_makes() -> None:
    command = [sys.executable, FOLDER / "make_vblock.py", "--check"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("as made") == 6


def test_the_layout_holds() -> None:
    verdict = verify(read_layout(FOLDER / "vblock.layout.yaml"))
    assert verdict.satisfied == "yes"
    assert check(verdict) == []
    names = [contact.name for contact in verdict.contacts]
    assert [name for name in names if name.startswith("vblock#")] == [f"vblock#{k}" for k in range(1, 7)]
    assert sum(name.startswith("stop#") for name in names) >= 3
    assert verdict.groups["all"].findings["form_closure"].answer == "no"
