"""The command run in this process: fast, and with everything it says caught."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from fixture_design.cli.main import main


@dataclass(frozen=True)
class Ran:
    code: int
    out: str
    err: str


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Ran]:
    """`command("verify", path)` runs `fixture-design verify path`."""

    def run(*arguments: object) -> Ran:
        monkeypatch.setattr("sys.argv", ["fixture-design", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            main()
        said = capsys.readouterr()
        return Ran(left.value.code, said.out, said.err)

    return run
