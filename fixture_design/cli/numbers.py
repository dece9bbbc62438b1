"""Numbers in one argument: 0,1,0.5."""

from __future__ import annotations

from math import isfinite

from fixture_design.errors import InputError


def numbers(text: str | None, option: str) -> list[float] | None:
    """The numbers of an option; None where it was not given.

    Raises:
        InputError: something that is no number.
    """
    if text is None:
        return None
    try:
        return [float(number) for number in text.strip("[] ").replace(",", " ").split()]
    except ValueError as cause:
        raise InputError(f"{option} takes numbers", found=text, expected=f"{option} 0,1,0.5") from cause


def at_least_zero(value: float, option: str) -> None:
    """Nothing, for a number that an option may be.

    Raises:
        InputError: one below zero, or not finite.
    """
    if not (isfinite(value) and value >= 0):
        raise InputError(f"{option} takes a number >= 0", found=repr(value))
