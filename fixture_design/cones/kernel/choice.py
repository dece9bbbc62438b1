"""Which implementation of the kernel runs: the compiled one (a Rust crate), or numpy.

The compiled one is used where it was built; everything works without it, slower. The variable FIXTURE_DESIGN_KERNEL,
set to `numpy` or `rust`, decides otherwise; `using` does so for a test.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Literal

from fixture_design.errors import KernelError

try:
    from fixture_design.cones.kernel import _native  # pyright: ignore[reportAttributeAccessIssue]
except ImportError:
    _native = None

Name = Literal["numpy", "rust"]

#: The environment variable that chooses.
VARIABLE = "FIXTURE_DESIGN_KERNEL"


def _at_start() -> ModuleType | None:
    wanted = os.environ.get(VARIABLE, "").strip().lower()
    if wanted not in {"", "numpy", "rust"}:
        raise KernelError(f"{VARIABLE} is {wanted!r}; there are: numpy, rust")
    if wanted == "rust" and _native is None:
        raise KernelError(
            f"{VARIABLE} asks for the compiled kernel, which was not built: install with Rust 1.85 or newer"
        )
    return None if wanted == "numpy" else _native


_chosen: ModuleType | None = _at_start()
#: The implementation chosen at the start: "rust" or "numpy".
NAME: Name = "numpy" if _chosen is None else "rust"


def available() -> tuple[Name, ...]:
    """The implementations that this installation has."""
    return ("numpy",) if _native is None else ("numpy", "rust")


def compiled(dimension: int, rows: int = 0) -> ModuleType | None:
    """The compiled kernel, if it is chosen and takes so many rows of R^dimension."""
    chosen = _chosen
    if chosen is None or not 0 < dimension <= chosen.MAX_DIMENSION or rows > chosen.MAX_ROWS:
        return None
    return chosen


@contextmanager
def using(name: Name) -> Iterator[None]:
    """Run with this implementation, whatever was chosen; for tests and comparisons, not for threads.

    Raises:
        KernelError: it was not built.
    """
    global _chosen  # noqa: PLW0603 - the choice is the program's, made once; only tests change it
    if name not in available():
        raise KernelError(f"there is no kernel {name!r} here; there are: {', '.join(available())}")
    before = _chosen
    _chosen = _native if name == "rust" else None
    try:
        yield
    finally:
        _chosen = before
