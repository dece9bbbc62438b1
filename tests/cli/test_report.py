"""The report for people: nothing of it is lost, motions are described where the part is, reasons are given once."""

import re
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from fixture_design.cli.verdict_table import print_verdict
from fixture_design.contacts import velocity
from fixture_design.io import read_layout
from fixture_design.verification import verify
from fixture_design.viewing.motion_words import motion_in_words, place_in_words
from tests.cli.layouts import HEAD, HOLDS, LOCATORS

LONG = "Z" + "long" * 60 + "Z"
NUMBER = r"-?[0-9.]+(?:e[-+][0-9]+)?"
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}

coordinates = st.floats(-1, 1)
vectors = st.tuples(coordinates, coordinates, coordinates).map(np.array)


def squeezed(text: str) -> str:
    """Without blanks, line ends and rules, which is all that wrapping may add; row by row of each column."""
    rows = [line.strip("│").split("│") for line in text.splitlines() if line.startswith("│")]
    columns = ["".join(cells) for cells in zip(*rows, strict=True)]
    return re.sub(r"\s", "", "".join(columns))


@pytest.mark.parametrize("width", [None, 60])
def test_long_names_are_folded_and_not_cut(command: Callable, tmp_path: Path, width: int | None) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(HOLDS.replace("P2", LONG) + f"stages: [{{name: stage{LONG}, active: [locator]}}]\n")
    if width is None:
        out = command("verify", path).out
    else:
        console = Console(file=StringIO(), width=width)
        print_verdict(verify(read_layout(path)), console)
        out = console.file.getvalue()  # type: ignore[attr-defined]
    assert max(map(len, out.splitlines())) <= (width or 120)
    assert "…" not in out
    found = squeezed(out)
    assert f"{LONG},P3,P4" in found
    assert f"stage{LONG}" in found


def test_names_are_printed_as_they_are(command: Callable, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(HOLDS.replace("P2", "':key: [bold]b[/] \\'").replace(HEAD, HEAD + "name: ':key: [red]\\'\n"))
    out = command("verify", path).out
    assert out.startswith(":key: [red]\\: planar, 3 contacts\n")
    assert ":key: [bold]b[/] \\, P3, P4" in out


def test_a_reason_is_given_once(command: Callable, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    tilted = "  - {name: P5, role: locator, point: [2, 0.5], normal: [1, 1.0e-9]}\n"
    path.write_text(LOCATORS + tilted + "require: {locators: [strongly_accessible]}\n")
    verdict = verify(read_layout(path))
    finding = verdict.groups["all"].findings["strongly_accessible"]
    assert (finding.answer, finding.reason is None) == ("undecided", False)
    assert not any(finding.reason in note for note in verdict.notes)
    ran = command("verify", path)
    assert ran.code == 3
    assert squeezed(ran.out).count(re.sub(r"\s", "", finding.reason)) == 1


@given(turn=vectors.filter(lambda w: np.linalg.norm(w) > 0.1), at=vectors, reference=vectors, pitch=coordinates,
       size=st.sampled_from([1e-4, 0.03, 0.5, 20.0]))  # fmt: skip
def test_a_screw_goes_through_the_point_of_its_axis_nearest_to_the_part(
    turn: np.ndarray, at: np.ndarray, reference: np.ndarray, pitch: float, size: float
) -> None:
    far = reference * 1000 * size
    point = far + at * size
    motion = np.concatenate([pitch * size * turn - np.cross(turn, point), turn])
    text = motion_in_words(motion, far, size)
    found = re.search(rf"through \(({NUMBER}), ({NUMBER}), ({NUMBER})\) (\w+)", text)
    assert found, text
    axis = np.array([float(number) for number in found.groups()[:3]]) * UNITS[found[4]]
    # on the axis points move along it; the nearest one is square to it
    across = np.cross(turn, velocity(motion, axis)) / (turn @ turn)
    assert np.linalg.norm(across) <= 2e-4 * size
    assert abs((axis - far) @ turn) / np.linalg.norm(turn) <= 2e-4 * size
    assert "advancing" in text or abs(pitch) < 1e-8


def test_a_turn_in_the_plane() -> None:
    centre, far = np.array([0.0125, -0.003]), np.array([5.0, 5.0])
    motion = np.array([2 * -0.003, -2 * 0.0125, 2.0])
    assert motion_in_words(motion, centre, 0.05) == "turns counter-clockwise about (12.5, -3) mm"
    assert motion_in_words(-motion, far, 0.05) == "turns clockwise about (12.5, -3) mm"
    # seen from W's origin this were a translation
    turning = np.array([-1e10, 0.0, 1.0])
    assert motion_in_words(turning, np.array([0.0, -1e10]), 1.0) == "turns counter-clockwise about (0, -10000000000) m"
    assert motion_in_words(np.array([2.0, -1.0, 0.0]), far, 0.05) == "along [1, -0.5]"


@pytest.mark.parametrize(
    ("size", "text"),
    [(2.0, "(1.2346, 0, -0.00012) m"), (0.5, "(1234.57, 0, -0.12) mm"), (2e-5, "(1234567.89, 0, -123.457) um")],
)
def test_places_have_the_unit_and_digits_of_the_part(size: float, text: str) -> None:
    found = place_in_words(np.array([1.23456789, -1e-12, -0.000123456789]), size)
    values = [float(number) for number in re.findall(NUMBER, found)]
    wanted = [float(number) for number in re.findall(NUMBER, text)]
    unit = UNITS[text.rsplit(maxsplit=1)[-1]]
    assert found.split()[-1] == text.rsplit(maxsplit=1)[-1]
    np.testing.assert_allclose(np.array(values) * unit, np.array(wanted) * unit, atol=1e-4 * size)
    assert "-0," not in found
