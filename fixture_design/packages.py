"""Packages whose names are loaded when they are first asked for, and packages that are called like a function."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any


def loaded_later(package: str, homes: Mapping[str, str]) -> Callable[[str], object]:
    """The `__getattr__` of a package: for each name the module, below the package, that has it.

    Example:
        >>> load = loaded_later("fixture_design", {"VERSION": "version"})
        >>> load("VERSION")
        '0.1.0'
    """

    def load(name: str) -> object:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(import_module(f"{package}.{homes[name]}"), name)

    return load


def called_as(package: str, function: Callable[..., Any]) -> None:
    """Lets a package, which hides a function of its own name once anything has imported it, be called like this one."""
    sys.modules[package].__class__ = type("CallablePackage", (ModuleType,), {"__call__": staticmethod(function)})
