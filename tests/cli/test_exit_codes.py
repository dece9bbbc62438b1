"""Exit codes tell yes from no from undecided from bad input from our own faults."""

import json
from collections.abc import Callable
from itertools import pairwise, permutations
from pathlib import Path

import pytest

import fixture_design.verification
from fixture_design.cli.exit_codes import ExitCode, worst
from fixture_design.layout import Layout
from tests.cli.layouts import BAD, FAILS, HOLDS, NOTHING_REQUIRED, UNDECIDED

OUTCOMES = {
    "nothing": (NOTHING_REQUIRED, 0, ""),
    "holds": (HOLDS, 0, "all requirements hold"),
    "fails": (FAILS, 1, "requirements fail"),
    "undecided": (UNDECIDED, 3, "requirements undecided"),
}


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", OUTCOMES)
def test_one_layout(command: Callable, tmp_path: Path, name: str) -> None:
    text, code, words = OUTCOMES[name]
    ran = command("verify", written(tmp_path, name, text))
    assert (ran.code, ran.err) == (code, "")
    assert words in ran.out
    assert ("requirements" in ran.out) == bool(words)
    assert command("verify", "--json", tmp_path / f"{name}.yaml").code == code


def test_why_it_is_undecided_is_said(command: Callable, tmp_path: Path) -> None:
    ran = command("verify", written(tmp_path, "x", UNDECIDED))
    assert "required of locators: accurate: undecided" in ran.out
    assert "key_features" in ran.out


@pytest.mark.parametrize(
    ("names", "code"),
    [
        (("nothing", "holds"), 0),
        (("holds", "undecided"), 3),
        (("undecided", "fails"), 1),
        (("fails", "bad"), 2),
        (("nothing", "holds", "undecided", "fails"), 1),
        (("holds", "undecided", "bad"), 2),
    ],
)
def test_several_layouts(command: Callable, tmp_path: Path, names: tuple[str, ...], code: int) -> None:
    texts = {name: text for name, (text, _, _) in OUTCOMES.items()} | {"bad": BAD}
    paths = [written(tmp_path, name, texts[name]) for name in names]
    for order in (paths, paths[::-1]):
        ran = command("verify", *order)
        assert ran.code == code
        assert [ran.out.count(f"{path.stem}: planar") for path in paths] == [int(path.stem != "bad") for path in paths]


def test_order_of_severity() -> None:
    severity = [ExitCode.INTERNAL_ERROR, ExitCode.BAD_INPUT, ExitCode.FAILS, ExitCode.UNDECIDED, ExitCode.HOLDS]
    for more, less in pairwise(severity):
        assert all(worst(codes) is more for codes in permutations((more, less)))
    assert worst([]) is ExitCode.HOLDS


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["verify"], "Missing argument 'LAYOUT'"),
        (["verify", "--jsn", "x.yaml"], "--jsn"),
        (["verfy", "x.yaml"], "No such command 'verfy'"),
        (["--frobnicate"], "--frobnicate"),
        (["schema"], "Missing argument 'NAME'"),
        (["schema", "layuot"], "did you mean 'layout'"),
    ],
)
def test_usage_errors(command: Callable, arguments: list[str], words: str) -> None:
    ran = command(*arguments)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("fixture-design: ")
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err


def test_no_arguments_print_the_help_and_nothing_else(command: Callable) -> None:
    ran = command()
    assert (ran.code, ran.err) == (2, "")
    assert "Usage: fixture-design" in ran.out


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    """A verification that breaks on layouts called `broken`."""
    intact = fixture_design.verification.verify

    def verify(layout: Layout) -> object:
        if layout.name == "broken":
            raise RuntimeError("a pivot was lost")
        return intact(layout)

    monkeypatch.setattr(fixture_design.verification, "verify", verify)


@pytest.mark.usefixtures("broken")
def test_a_fault_of_ours(command: Callable, tmp_path: Path) -> None:
    path = written(tmp_path, "broken", HOLDS)
    ran = command("verify", path)
    assert (ran.code, ran.out) == (4, "")
    last = ran.err.splitlines()[-1]
    assert last == (f"fixture-design: {path}: internal error (RuntimeError); this is a fault of ours")
    assert "RuntimeError: a pivot was lost" in ran.err  # the traceback which we need, to find it


@pytest.mark.usefixtures("broken")
def test_a_fault_of_ours_costs_no_other_verdict(command: Callable, tmp_path: Path) -> None:
    texts = {"broken": HOLDS, "bad": BAD, "fails": FAILS}
    ran = command("verify", "--json", *(written(tmp_path, name, text) for name, text in texts.items()))
    assert ran.code == 4
    broken, bad, fails = json.loads(ran.out)
    assert broken["error"] == {"kind": "RuntimeError", "message": "a pivot was lost"}
    assert bad["error"]["kind"] == "ContentError"
    assert fails["satisfied"] == "no"


def test_an_error_outside_of_any_layout(command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def dumps(_: object) -> str:
        raise ZeroDivisionError("in the writer")

    monkeypatch.setattr("fixture_design.cli.verify.dumps", dumps)
    ran = command("verify", "--json", written(tmp_path, "x", HOLDS))
    assert (ran.code, ran.out) == (4, "")
    assert ran.err.endswith("internal error (ZeroDivisionError); this is a fault of ours\n")


def test_interrupted(command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def verify(_: Layout) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr(fixture_design.verification, "verify", verify)
    ran = command("verify", written(tmp_path, "x", HOLDS))
    assert (ran.code, ran.out, ran.err.strip()) == (130, "", "fixture-design: interrupted")
