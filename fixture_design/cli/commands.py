"""The subcommands, each imported when it is asked for: all of them would be a third of any start."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

#: In the order of the help. Each is a function of its name in the module of its name.
_NAMES = (
    "verify",
    "design",
    "batch",
    "preview",
    "interactive",
    "grasp",
    "states",
    "classifier",
    "recognize",
    "schema",
)


class _Commands(Mapping[str, TyperCommand]):
    def __getitem__(self, name: str) -> TyperCommand:
        if name not in _NAMES:
            raise KeyError(name)
        one = typer.Typer(add_completion=False)
        one.command(name)(getattr(import_module(f"fixture_design.cli.{name}"), name))
        return get_command(one)  # type: ignore[return-value]  # a Typer of one command is that command

    def __iter__(self) -> Iterator[str]:
        return iter(_NAMES)

    def __len__(self) -> int:
        return len(_NAMES)


class CommandGroup(TyperGroup):
    """The program: `fixture-design COMMAND`."""

    def __init__(self, **settings: object) -> None:
        super().__init__(**settings)  # type: ignore[arg-type]
        self.commands = _Commands()  # type: ignore[assignment]  # nothing is ever added
