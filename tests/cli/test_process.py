"""The command as a process of its own: the installed script, and what it does not load."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.layouts import contact

ROOT = Path(__file__).resolve().parents[2]
LAYOUT = "urdf/figure8/p12345.layout.yaml"
SCRIPT = Path(sys.executable).with_name("fixture-design")

#: Runs the command, then tells on stderr which of the packages were loaded.
PROBE = """
import sys
from fixture_design.cli.main import main
sys.argv = ["fixture-design", *sys.argv[1:]]
try:
    main()
finally:
    heavy = "scipy scipy.optimize pydrake trimesh yourdfpy meshcat networkx shapely rich.table".split()
    print([name for name in heavy if name in sys.modules], file=sys.stderr)
"""


def process(*command: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*map(str, command)], cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)


@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [
        (["verify", LAYOUT, "--json"], []),
        (["verify", LAYOUT], ["rich.table"]),
        (["verify", "nothing.yaml"], []),
        (["--version"], []),
        (["schema", "layout"], []),
        (["--help"], ["rich.table"]),  # of Typer, not ours
    ],
)
def test_what_is_loaded(arguments: list[str], loaded: list[str]) -> None:
    ran = process(sys.executable, "-c", PROBE, *arguments)
    assert ran.stderr.splitlines()[-1] == str(loaded)
    assert ran.returncode == (2 if "nothing.yaml" in arguments else 0)


@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [(["verify", "urdf/bracket/bracket.layout.yaml", "--json"], ["pydrake", "trimesh"])],
)
def test_the_probe_sees_what_geometry_loads(arguments: list[str], loaded: list[str]) -> None:
    said = process(sys.executable, "-c", PROBE, *arguments).stderr.splitlines()[-1]
    assert all(repr(name) in said for name in loaded)


def test_a_part_that_nothing_touches_must_be_there_but_is_not_read(tmp_path: Path) -> None:
    path, mesh = tmp_path / "x.yaml", tmp_path / "part.stl"
    path.write_text(contact("point: [0, 0, 0], normal: [0, 0, 1]").replace("space: spatial", "part: {mesh: part.stl}"))
    ran = process(sys.executable, "-c", PROBE, "verify", "--json", path)
    assert ran.returncode == 2
    assert "line 2, part.mesh: there is no mesh file" in ran.stderr
    mesh.touch()
    ran = process(sys.executable, "-c", PROBE, "verify", "--json", path)
    assert (ran.returncode, ran.stderr) == (0, "[]\n")


@pytest.mark.skipif(not SCRIPT.is_file(), reason="the script is not installed next to this Python")
def test_the_script() -> None:
    ran = process(SCRIPT, "verify", LAYOUT, "--json")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert json.loads(ran.stdout)["satisfied"] == "yes"
    ran = process(SCRIPT, "verify", LAYOUT)
    assert (ran.returncode, ran.stderr) == (0, "")
    assert "all requirements hold" in ran.stdout
    assert max(map(len, ran.stdout.splitlines())) <= 120
    ran = process(SCRIPT, "verify", "nothing.yaml")
    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr == "fixture-design: nothing.yaml: there is no such file\n"
